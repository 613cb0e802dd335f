// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "geometry/closest_point.h"
#include "geometry/untangle/collision_mesh.h"

namespace arris {

/// The place of a sheet nearest to a point, as far as found by walking over the sheet.
struct SheetPlace {
    int face = -1;
    std::array<double, 3> weights;
    Vec3 point;
    Vec3 normal;  ///< unit; on an edge or a corner the mean of the faces'
    double distance = 0.0;
    bool is_on_border = false;  ///< the point lies beyond the sheet's border
};

/// Unit normal of a face; zero where it has no area.
Vec3 normal_of(const CollisionMesh& mesh, int face);

PointOnTriangle nearest_on(const CollisionMesh& mesh, const Vec3& place, int face);

/// Walks from a face to neighbours that are nearer to `place`, to a local minimum of the distance. So the
/// place stays on the sheet of the first face, where other layers are nearer.
SheetPlace walk_to_nearest(const CollisionMesh& mesh, const Vec3& place, int face);

}  // namespace arris
