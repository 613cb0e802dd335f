// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "app/scene/keys/scene_document.h"
#include "app/scene/parts/run_config.h"
#include "app/scene/parts/scene_estimate.h"

namespace arris {

/// The key that names what the cloth is made of: cloth.file, cloth.outline or cloth.size.
std::string cloth_shape_key(const SceneDocument& document);

/// The key that says how fine the cloth's mesh is: cloth.file, cloth.edge_length or cloth.resolution.
std::string cloth_fineness_key(const SceneDocument& document);

/// Estimates the mesh of `as_run["cloth"]`, a rectangle or outline, without making it; none for a file.
/// Throws InputError for a border with a defect or a fold that misses the cloth.
std::optional<SceneEstimate> estimate_scene_cloth(const SceneDocument& document,
                                                  const nlohmann::ordered_json& as_run);

/// Makes or reads the cloth of `config.as_run`, folds it and places it in the world. Adds warnings and notes
/// to `config`. Throws InputError, also where the run would take more vertices or memory than is allowed.
ClothMesh make_scene_cloth(const SceneDocument& document, RunConfig& config);

}  // namespace arris
