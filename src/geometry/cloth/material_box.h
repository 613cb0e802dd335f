// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/cloth/cloth_mesh.h"

namespace arris {

/// An axis-aligned box in material space, m, inclusive; lines and points are legitimate boxes.
struct MaterialBox {
    Vec2 min = Vec2::Zero();
    Vec2 max = Vec2::Zero();
};

/// Largest side of the box around the material coordinates, m: the scale of material tolerances.
double material_size(const std::vector<Vec2>& material);

/// Vertices inside `box`, ascending, each side widened by 1e-9 of `material_size`.
std::vector<int> vertices_in_box(const ClothMesh& mesh, const MaterialBox& box);

/// A share of a load spread over a box: `weight` of it acts on `vertex`. Weights sum to 1.
struct LoadShare {
    int vertex;
    double weight;
};

/// Spreads a unit load evenly over the part of the cloth inside `box`: by area where that part has one, by
/// length where the box is a line, onto the nearest vertex where it is a point. Exact for linear elements
/// (the box is clipped against each face and the shape functions integrated). Ascending by vertex; empty
/// where the box meets no cloth.
std::vector<LoadShare> spread_over_box(const ClothMesh& mesh, const MaterialBox& box);

/// A share of a load on the corners of one face.
struct FaceShare {
    int face;
    Vec3 weights;
};

/// The same load by faces: what `spread_over_box` gives a vertex is the sum of what its corners have here.
std::vector<FaceShare> spread_over_faces(const ClothMesh& mesh, const MaterialBox& box);

/// Where a material point lies: `face` and its barycentric coordinates there.
struct MaterialLocation {
    int face = -1;  ///< -1: the point meets no cloth
    Vec3 weights = Vec3::Zero();
};

/// The face that contains `point` (tolerance 1e-9 of `material_size`; the nearest such face, lowest index on
/// ties).
MaterialLocation locate(const ClothMesh& mesh, const Vec2& point);

}  // namespace arris
