// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/box_tree.h"
#include "geometry/cloth/material_box.h"

namespace arris {

/// Position of a material point: a face and barycentric coordinates in it.
struct MaterialLocation {
    int face = -1;  ///< -1: the point meets no cloth
    Vec3 weights = Vec3::Zero();
};

/// Finds the face that contains `point`. If none does, the nearest face within 1e-9 of `material_size` is
/// taken, with the lowest index on ties.
MaterialLocation locate(const ClothMesh& mesh, const Vec2& point);

/// Finds many material points in one mesh, each in logarithmic time. Keeps references to its arguments.
class MaterialLocator {
  public:
    /// `faces`: of points.
    MaterialLocator(const std::vector<Vec2>& material, const std::vector<Face>& faces);

    /// As the free function `locate`; a point outside the cloth goes to the nearest face within `tolerance`
    /// (m).
    MaterialLocation locate(const Vec2& point, double tolerance) const;

    /// For a point on a border, where charts may touch: takes the face 1e-6 of the way from `point` to
    /// `inside`, and the point of that face nearest to `point`, at most that far away.
    MaterialLocation locate_on_border(const Vec2& point, const Vec2& inside, double tolerance) const;

  private:
    const std::vector<Vec2>& material_;
    const std::vector<Face>& faces_;
    BoxTree tree_;
};

}  // namespace arris
