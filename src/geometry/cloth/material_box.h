// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/cloth/cloth_mesh.h"

namespace arris {

/// An axis-aligned box in material space, m, inclusive; lines and points are legitimate boxes.
struct MaterialBox {
    Vec2 min = Vec2::Zero();
    Vec2 max = Vec2::Zero();

    /// Whether `X` is in the box widened by `tolerance` (m) on each side.
    bool contains(const Vec2& X, double tolerance) const
    {
        return (X.array() >= min.array() - tolerance).all() && (X.array() <= max.array() + tolerance).all();
    }
};

/// Material coordinates this close, relative to `material_size`, count as equal.
inline constexpr double kMaterialTolerance = 1e-9;

/// Largest side of the box around the material coordinates, m: the scale of material tolerances.
double material_size(const std::vector<Vec2>& material);

/// Share of a box's load on one vertex: the fraction `weight`. Weights sum to 1.
struct LoadShare {
    int vertex;
    double weight;
};

/// Spreads a unit load evenly over the part of the cloth inside `box`: by area, or by length if the box is a
/// line. If the box is a point, the nearest vertex gets the load. Exact for linear elements: the box is
/// clipped against each face and the shape functions are integrated. Ascending by vertex; empty if the box
/// meets no cloth.
std::vector<LoadShare> spread_over_box(const ClothMesh& mesh, const MaterialBox& box);

/// Share of a box's load on the three corners of one face.
struct FaceShare {
    int face;
    Vec3 weights;
};

/// The load of `spread_over_box` listed by faces: a vertex's share there is the sum of its corners' weights
/// here.
std::vector<FaceShare> spread_over_faces(const ClothMesh& mesh, const MaterialBox& box);

}  // namespace arris
