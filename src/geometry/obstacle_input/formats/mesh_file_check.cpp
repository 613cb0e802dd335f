// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/formats/mesh_file_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"

namespace arris {
namespace {

// All binary formats checked here are little endian, as are the machines that this program supports.
template <class Number>
Number number_at(std::string_view bytes, std::size_t offset)
{
    Number number;
    std::memcpy(&number, bytes.data() + offset, sizeof number);
    return number;
}

constexpr std::size_t k3dsChunkHeader = 6;

void check_3ds(std::string_view bytes)
{
    if (bytes.size() < k3dsChunkHeader || number_at<std::uint16_t>(bytes, 0) != 0x4d4d)
        throw InputError("not a 3DS file");
    const auto length = number_at<std::uint32_t>(bytes, 2);
    if (length > bytes.size())
        throw InputError(fmt::format("truncated: its main chunk says {} bytes, but the file has {}", length,
                                     bytes.size()));
}

void require_start(std::string_view bytes, std::string_view start, const char* what)
{
    bytes.remove_prefix(std::min(bytes.find_first_not_of(" \t\r\n\v\f"), bytes.size()));
    if (!bytes.starts_with(start)) throw InputError(fmt::format("not {} file", what));
}

}  // namespace

const std::vector<std::string>& mesh_extensions()
{
    static const std::vector<std::string> kExtensions = {"obj", "stl", "ply", "gltf", "glb",
                                                         "dae", "fbx", "3mf", "3ds"};
    return kExtensions;
}

std::string without_marks(const std::string& extension, std::string bytes)
{
    const bool is_text = extension == "gltf" || extension == "dae" || extension == "fbx";
    if (is_text) return std::string(skip_byte_order_mark(bytes));
    return bytes;
}

void check_mesh_bytes(const std::string& extension, std::string_view bytes)
{
    if (bytes.empty()) throw InputError("empty");
    if (extension == "3ds") check_3ds(bytes);
    if (extension == "gltf") require_start(bytes, "{", "a glTF");
    if (extension == "dae") require_start(bytes, "<", "a COLLADA");
    if (extension == "3mf") require_start(bytes, "PK\x03\x04", "a 3MF");
}

}  // namespace arris
