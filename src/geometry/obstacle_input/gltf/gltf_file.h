// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/obstacle_input/gltf/gltf_animation.h"
#include "geometry/obstacle_input/gltf/gltf_figure.h"
#include "geometry/vectors.h"

namespace arris {

struct GltfFile {
    std::string bytes;
    bool is_binary = false;             ///< whether the bytes are those of a .glb file
    std::vector<std::string> warnings;  ///< see check_gltf
    std::vector<Vec3> vertices;         ///< where skins or morph targets move them, else empty
};

/// Checks a glTF 2 file (check_gltf), and gives the import library the floats that it needs for positions
/// (write_positions_as_floats) and nothing of skins, morph targets and animations: `vertices` are the places
/// of all vertices at rest. Buffers beside the file are read from `folder`. Throws InputError, without the
/// file's name.
GltfFile prepare_gltf(bool is_binary, std::string bytes, const std::filesystem::path& folder);

struct GltfMotion {
    GltfFigure figure;
    GltfAnimation animation;
};

/// The vertices of a file, in the order in which prepare_gltf's are imported, and the animation that moves
/// them, by default the only one. Throws InputError, without the file's name.
GltfMotion read_gltf_motion(bool is_binary, std::string_view bytes, const std::filesystem::path& folder,
                            const std::optional<std::string>& animation);

}  // namespace arris
