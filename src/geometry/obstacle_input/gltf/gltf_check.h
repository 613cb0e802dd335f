// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace arris {

/// Refuses a glTF 2 file whose shape an importer would read wrongly without a word. Throws InputError,
/// without the file's name, for:
///  - required extensions that are not read, unless they change the appearance only;
///  - instances (EXT_mesh_gpu_instancing), hidden nodes (KHR_node_visibility), and data that are there in
///    compressed form only (EXT_meshopt_compression);
///  - positions and indices without data, or of another type than theirs, or with a stride shorter than an
///    element; unknown kinds of primitives;
///  - shown nodes whose placement is not well formed (see check_gltf_placement); in a file with compressed
///    meshes those whose morph targets have weights that are not zero.
///
/// Returns warnings about unknown extensions that may change shapes, and about skins that are not applied.
std::vector<std::string> check_gltf(const nlohmann::json& json);

}  // namespace arris
