// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/text/version.h"

namespace arris {

static_assert(std::endian::native == std::endian::little, "arrays are written as they lie in memory");

// Numbers of glTF 2.0: component types, modes of primitives, targets of buffer views.
inline constexpr int kGltfFloat = 5126, kGltfUnsigned = 5125;              // component types
inline constexpr int kGltfPoints = 0, kGltfLines = 1, kGltfTriangles = 4;  // primitive modes
inline constexpr int kGltfVertexArray = 34962, kGltfIndexArray = 34963;    // targets of buffer views

using Float3 = std::array<float, 3>;

struct GltfBounds {
    Float3 min, max;
};

/// `positions` must not be empty.
inline GltfBounds find_gltf_bounds(const std::vector<Float3>& positions)
{
    GltfBounds bounds{positions.front(), positions.front()};
    for (const Float3& x : positions)
        for (int k = 0; k < 3; ++k) {
            bounds.min[k] = std::min(bounds.min[k], x[k]);
            bounds.max[k] = std::max(bounds.max[k], x[k]);
        }
    return bounds;
}

/// A glTF file as it is put together: its JSON, and the arrays that are known before frames are streamed.
struct GltfAsset {
    nlohmann::ordered_json json = {
        {"asset", {{"version", "2.0"}, {"generator", std::string("arris ") + kVersion}}}};
    std::string fixed;
    std::uint64_t streamed = 0;  ///< bytes after the fixed arrays

    /// Adds bytes of the fixed arrays; returns the view's index.
    template <class Value>
    std::size_t add_view(const std::vector<Value>& values, int target)
    {
        nlohmann::ordered_json view = {
            {"buffer", 0}, {"byteOffset", fixed.size()}, {"byteLength", values.size() * sizeof(Value)}};
        if (target != 0) view["target"] = target;
        fixed.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
        return append("bufferViews", std::move(view));
    }

    /// Adds an array of values of `type` ("SCALAR", "VEC3", ...); returns the accessor's index.
    template <class Value>
    std::size_t add(const char* type, int component, const std::vector<Value>& values, int target = 0)
    {
        return append("accessors", {{"bufferView", add_view(values, target)},
                                    {"componentType", component},
                                    {"count", values.size()},
                                    {"type", type}});
    }

    /// As add, with the bounds that glTF requires of positions.
    std::size_t add_positions(const std::vector<Float3>& positions)
    {
        const std::size_t index = add("VEC3", kGltfFloat, positions, kGltfVertexArray);
        set_bounds(index, find_gltf_bounds(positions));
        return index;
    }

    void set_bounds(std::size_t accessor, const GltfBounds& bounds)
    {
        json["accessors"][accessor]["min"] = bounds.min;
        json["accessors"][accessor]["max"] = bounds.max;
    }

    /// Adds to a list of the JSON; returns the item's index.
    std::size_t append(const char* list, nlohmann::ordered_json item)
    {
        json[list].push_back(std::move(item));
        return json[list].size() - 1;
    }

    /// Moves `path` of a node: accessors of times (s) and of values.
    void add_channel(std::size_t times, std::size_t output, std::size_t node, const char* path)
    {
        nlohmann::ordered_json& animation = json["animations"][0];
        animation["name"] = "run";
        animation["samplers"].push_back({{"input", times}, {"output", output}, {"interpolation", "LINEAR"}});
        animation["channels"].push_back(
            {{"sampler", animation["samplers"].size() - 1}, {"target", {{"node", node}, {"path", path}}}});
    }
};

}  // namespace arris
