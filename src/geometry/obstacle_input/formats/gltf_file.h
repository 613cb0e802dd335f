// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace arris {

struct GltfFile {
    std::string bytes;
    bool is_binary;                     ///< whether the bytes are those of a .glb file
    std::vector<std::string> warnings;  ///< see check_gltf
};

/// Checks a glTF 2 file (check_gltf), and gives the import library the floats that it needs for positions
/// (write_positions_as_floats). Buffers beside the file are read from `folder`. Throws InputError, without
/// the file's name.
GltfFile prepare_gltf(bool is_binary, std::string bytes, const std::filesystem::path& folder);

}  // namespace arris
