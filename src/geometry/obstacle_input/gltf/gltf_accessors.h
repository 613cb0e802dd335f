// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace arris {

struct GltfDocument;

/// Reads a file beside the mesh by its name; throws InputError.
using SiblingReader = std::function<std::string(const std::string&)>;

// Component types of accessors.
inline constexpr int kGltfByte = 5120;
inline constexpr int kGltfUnsignedByte = 5121;
inline constexpr int kGltfShort = 5122;
inline constexpr int kGltfUnsignedShort = 5123;
inline constexpr int kGltfUnsignedInt = 5125;
inline constexpr int kGltfSingle = 5126;

/// What the numbers of an accessor must be.
struct GltfForm {
    std::string_view type;  ///< "SCALAR", "VEC3", "VEC4" or "MAT4"
    std::vector<int> components;
};

/// The numbers of a document's accessors, from its binary chunk, from data URIs and from files beside it. The
/// document must outlive the object. All functions throw InputError, without the file's name.
class GltfAccessors {
  public:
    GltfAccessors(const GltfDocument& document, SiblingReader read_sibling);

    /// The elements of an accessor, one after the other. Integers are scaled to [-1, 1] or [0, 1] where they
    /// are normalised; sparse elements are applied; elements without data are zero. Errors begin with `what`:
    /// an accessor that is not there or has another form, data beyond their buffer's end, numbers that are
    /// not finite.
    std::vector<double> read(const nlohmann::json& index, const GltfForm& form, const std::string& what);

  private:
    struct Layout;

    const std::string& buffer(const nlohmann::json& index);
    void read_dense(const nlohmann::json& view, std::uint64_t offset, const Layout& layout,
                    std::vector<double>& numbers, const std::string& what);
    void apply_sparse(const nlohmann::json& sparse, const Layout& layout, std::vector<double>& numbers,
                      const std::string& what);

    const GltfDocument& document_;
    SiblingReader read_sibling_;
    std::map<std::size_t, std::string> buffers_;  // by index
};

}  // namespace arris
