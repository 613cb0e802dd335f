// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/cloth/cloth_mesh.h"
#include "geometry/obstacle/obstacle.h"

namespace arris {

/// How deep a cloth is inside an obstacle's solids, or where it cuts its sheets and wires.
struct Penetration {
    /// m, of the deepest point of the cloth's surface inside a solid: its distance to the nearest face of a
    /// solid (of overlapping solids to either's). Exactly 0 where nothing is inside, also where the cloth
    /// merely touches. To 1 % below the true one, but where an edge of the obstacle cuts into a cloth face
    /// along more than about 1e4 times the depth, or with more of the cloth inside than can be searched in
    /// bounded time: then it is that of the deepest point found.
    double depth = 0.0;
    int faces = 0;  ///< cloth faces that touch the obstacle's triangles, wires or lone points, exact
    int face = -1;  ///< the deepest's, or the first that touches; -1 where none
    Vec3 place = Vec3::Zero();  ///< there, in the obstacle's frame
    bool is_any() const { return face >= 0; }
};

/// `positions` (one a vertex, finite) are the cloth's in the obstacle's frame. Surface intersection by exact
/// predicates, and for each connected piece of cloth whether it is inside (winding number not 0). Parallel;
/// the same at any thread count.
Penetration find_penetration(const Obstacle& obstacle, const std::vector<Vec3>& positions,
                             const std::vector<Face>& faces);

/// The winding number of the obstacle's solids around `place` (frame, finite); 0 outside, and in a cavity. By
/// exact predicates; points on a solid's surface have 0.
int winding_number(const Obstacle& obstacle, const Vec3& place);

}  // namespace arris
