// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/obstacle/obstacle_topology.h"

namespace arris {

/// The normals by which faces are compared. A thin face borrows the normal of the first face that is not
/// thin, found across longest sides. So a cap that rounding bent out of its plane counts as part of its
/// neighbour's plane, as intended.
struct FacePlanes {
    std::vector<Vec3> normals;
    std::vector<char> is_borrowed;
};

/// The planes of a mesh that passes `validate`, or of a pose of one. `diagonal`: of the mesh's box, m.
FacePlanes find_planes(const ObstacleMesh& mesh, const ObstacleTopology& topology, double diagonal);

/// Length of the diagonal of the mesh's box, m; 0 without points.
double diagonal_of(const ObstacleMesh& mesh);

}  // namespace arris
