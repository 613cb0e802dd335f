// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/cloth/cloth_mesh.h"
#include "geometry/obstacle/obstacle.h"

namespace arris {

/// Depth of a cloth inside an obstacle's solids, and the cloth faces that intersect the obstacle.
struct Penetration {
    /// m, of the deepest point of the cloth's surface inside a solid: its distance to the nearest face of a
    /// solid (of overlapping solids, to either's faces). Exactly 0 where nothing is inside, also where the
    /// cloth merely touches.
    ///
    /// At most 1 % below the true depth, with two exceptions. An edge of the obstacle may cut into a cloth
    /// face along more than about 1e4 times the depth. More cloth may be inside than a bounded search covers.
    /// In both cases this is the depth of the deepest point found.
    double depth = 0.0;
    int faces = 0;  ///< number of cloth faces that touch the obstacle's triangles, wires or lone points,
                    ///< exact
    int face = -1;  ///< cloth face of the deepest point, or the first that touches; -1 where none
    Vec3 place = Vec3::Zero();  ///< location of that point or touch, in the obstacle's frame
    bool is_any() const { return face >= 0; }
};

/// `positions` (one per vertex, finite) are in the obstacle's frame. Surface intersection is decided by exact
/// predicates; whether a connected piece of cloth is inside, by its winding number (not 0). Parallel;
/// independent of the number of threads.
Penetration find_penetration(const Obstacle& obstacle, const std::vector<Vec3>& positions,
                             const std::vector<Face>& faces);

/// Winding number of the obstacle's solids around `place` (in the obstacle's frame, finite); 0 outside and in
/// a cavity. Uses exact predicates; points on a solid's surface have 0.
int winding_number(const Obstacle& obstacle, const Vec3& place);

}  // namespace arris
