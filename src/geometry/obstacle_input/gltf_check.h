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
///  - positions without data, morph targets whose weights are not zero, and unknown kinds of primitives.
///
/// Returns warnings about skins, which are not applied, and about unknown extensions of the geometry.
std::vector<std::string> check_gltf(const nlohmann::json& json);

}  // namespace arris
