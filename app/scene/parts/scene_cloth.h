// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "app/scene/keys/scene_document.h"
#include "app/scene/parts/run_config.h"
#include "app/scene/parts/scene_estimate.h"

namespace arris {

/// The key that names what a piece ("cloth", or "cloth.1") is made of: its file, outline or size.
std::string cloth_shape_key(const SceneDocument& document, const std::string& piece);

/// The key that says how fine a piece's mesh is: its file, edge_length or resolution.
std::string cloth_fineness_key(const SceneDocument& document, const std::string& piece);

/// Estimates the mesh of piece i of `as_run`, a rectangle or outline, without making it; none for a file.
/// Throws InputError for a border with a defect or a fold that misses the cloth.
std::optional<SceneEstimate> estimate_piece(const SceneDocument& document,
                                            const nlohmann::ordered_json& as_run, std::size_t i);

/// Makes or reads the pieces of cloth of `config.as_run`, folds them, places them in the world and lays their
/// material out: `config.cloth`, and the rest of `config.pieces`. Adds warnings and notes to `config`. Throws
/// InputError, also where the run would take more vertices or memory than is allowed.
void make_scene_cloth(const SceneDocument& document, RunConfig& config);

/// The cloth and the pieces' places of a resumed run. Throws InputError where they are not those of the
/// scene.
void take_scene_cloth(const LoadOptions& options, RunConfig& config);

/// Mean edge length of each piece, m.
std::vector<double> mean_edges(const RunConfig& config);

}  // namespace arris
