// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/cloth/cloth_mesh.h"
#include "geometry/cloth/material_box.h"

namespace arris {

/// A part of the material: a box, or what lies between picked vertices of a mesh. It stays the same material
/// whatever becomes of the mesh.
class MaterialRegion {
  public:
    MaterialRegion(const MaterialBox& box = {}) : parts_{box} {}
    MaterialRegion(const Vec2& min, const Vec2& max) : MaterialRegion(MaterialBox{min, max}) {}

    /// The picked vertices of `mesh` (indices; in any order, none twice), the edges between two of them, and
    /// the faces between three.
    static MaterialRegion between(const ClothMesh& mesh, const std::vector<int>& vertices);

    /// Lines of the material, each from one point (m) to another.
    static MaterialRegion along(const std::vector<std::array<Vec2, 2>>& lines);

    /// Whether `X` is at most `tolerance` (m) away; for a box, on each of its sides.
    bool contains(const Vec2& X, double tolerance) const;

    /// Distance (m) of `X`; 0 inside.
    double distance(const Vec2& X) const;

    /// Boxes around its connected parts, m.
    const std::vector<MaterialBox>& parts() const { return parts_; }

  private:
    /// A face; an edge or a vertex has its last corner several times.
    using Simplex = std::array<Vec2, 3>;

    void sort_simplices();

    std::vector<MaterialBox> parts_;
    std::vector<Simplex> simplices_;  ///< ascending by least u; none in a box
    double widest_ = 0.0;             ///< m, greatest extent of a simplex along u
};

/// Vertices with a point inside `region`, ascending; a point within 1e-9 of `material_size` counts as inside.
std::vector<int> vertices_inside(const ClothMesh& mesh, const MaterialRegion& region);

}  // namespace arris
