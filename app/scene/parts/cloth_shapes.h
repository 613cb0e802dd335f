// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/scene/parts/piece_source.h"
#include "app/scene/parts/run_config.h"
#include "app/scene/parts/scene_estimate.h"
#include "geometry/cloth_input/cloth_file.h"

namespace arris {

/// The key that names what a piece ("cloth", or "cloth.1") is made of: its file, outline, panels or size.
std::string cloth_shape_key(const SceneDocument& document, const std::string& piece);

/// The key that says how fine a piece's mesh is: its file, edge_length or resolution.
std::string cloth_fineness_key(const SceneDocument& document, const std::string& piece);

/// Estimates the mesh of table i of `as_run` without making it; none for a file.
std::optional<SceneEstimate> estimate_piece(const SceneDocument& document,
                                            const nlohmann::ordered_json& as_run, std::size_t i);

/// Refuses a piece whose mesh is too large beside those already in `config.pieces`.
void check_size(const PieceSource& piece, const RunConfig& config, SceneEstimate estimate);

/// The cloth of a table, folded, not yet placed. Adds warnings and notes. Throws InputError.
ClothMesh make_rectangle(const PieceSource& piece, const RunConfig& config);
ClothMesh make_outlined(const PieceSource& piece, RunConfig& config);
/// With the vertices of the mesh for each `v` of the file, and its ties.
ClothFile read_cloth(const PieceSource& piece, RunConfig& config);

}  // namespace arris
