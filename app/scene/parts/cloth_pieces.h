// SPDX-License-Identifier: GPL-3.0-or-later
// The pieces of cloth of a scene file: its [cloth], or its [[cloth]].
#pragma once

#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "geometry/cloth/material_box.h"
#include "geometry/cloth/piece_place.h"
#include "solver/model/scene.h"

namespace arris {

/// A piece of cloth.
struct ClothPiece : PiecePlace {
    std::string key;           ///< "cloth", or "cloth.1"
    std::string material_key;  ///< the table that its material is written in: "cloth.material", or "fabric.0"
    double end = std::numeric_limits<double>::infinity();  ///< m, where its part of the plane ends
    int vertices = 0, faces = 0;                           ///< of its first mesh
    /// Vertex of that mesh for each one of `cloth.file`, -1 where no face uses it; empty without a file.
    std::vector<int> file_vertices;

    using PiecePlace::to_plane;
    MaterialBox to_plane(const MaterialBox& own) const;
};

/// "[0.1, 0.2]", or "[0.1, 0.2] of shirt": a place of the material, with this many digits.
std::string material_in_words(const Scene& scene, const Vec2& X, int digits);

/// The tables of the pieces in `scene`, which may be as_run. One for [cloth].
std::vector<nlohmann::ordered_json*> piece_tables(nlohmann::ordered_json& scene);
std::vector<const nlohmann::ordered_json*> piece_tables(const nlohmann::ordered_json& scene);

/// Key of piece i of `scene`: "cloth", or "cloth.i".
std::string piece_key(const nlohmann::ordered_json& scene, std::size_t i);

/// The pieces of a completed scene. Where they are in the plane follows with their meshes.
std::vector<ClothPiece> list_pieces(const nlohmann::ordered_json& scene);

}  // namespace arris
