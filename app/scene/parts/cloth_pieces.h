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

/// A piece of cloth: of one material, and flat. A cloth that is sewn from panels has one for each of them.
struct ClothPiece : PiecePlace {
    std::string key;           ///< "cloth", or "cloth.1"
    int table = 0;             ///< number of that table
    std::string panel;         ///< name of the panel; empty where the cloth has none
    std::string material_key;  ///< the table that its material is written in: "cloth.material", or "fabric.0"
    double end = std::numeric_limits<double>::infinity();  ///< m, where its part of the plane ends
    /// Vertex for each one of `cloth.file`, counted in the piece, -1 where no face uses it; empty without a
    /// file.
    std::vector<int> file_vertices;

    /// Whether a place in the plane of all pieces is in its part.
    bool holds(const Vec2& X) const { return X.x() >= begin && X.x() < end; }

    using PiecePlace::to_plane;
    MaterialBox to_plane(const MaterialBox& own) const;
};

/// "[0.1, 0.2]", or "[0.1, 0.2] of shirt": a place of the material, with this many digits.
std::string material_in_words(const Scene& scene, const Vec2& X, int digits);

/// The tables of the cloths in `scene`, which may be as_run. One for [cloth].
std::vector<nlohmann::ordered_json*> cloth_tables(nlohmann::ordered_json& scene);
std::vector<const nlohmann::ordered_json*> cloth_tables(const nlohmann::ordered_json& scene);

/// Key of table i of `scene`: "cloth", or "cloth.i".
std::string cloth_key(const nlohmann::ordered_json& scene, std::size_t i);

/// Whether a cloth is sewn from panels.
bool has_panels(const nlohmann::ordered_json& cloth);

/// A piece for each table of a completed scene. Panels, and where pieces are in the plane, follow with their
/// meshes.
std::vector<ClothPiece> list_pieces(const nlohmann::ordered_json& scene);

/// Sets the keys of a piece by its table and panel, which the scene must have.
void find_keys(const nlohmann::ordered_json& scene, ClothPiece& piece);

/// The table of the cloth that a piece belongs to, and the one of its material.
const nlohmann::ordered_json& table_of(const nlohmann::ordered_json& scene, const ClothPiece& piece);
const nlohmann::ordered_json& material_of(const nlohmann::ordered_json& scene, const ClothPiece& piece);

/// All tables of materials that the cloth of a completed scene may have.
std::vector<const nlohmann::ordered_json*> material_tables(const nlohmann::ordered_json& scene);

}  // namespace arris
