// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/obstacle/obstacle.h"

namespace arris {

/// What of an obstacle a resting triangle of the cloth touches; each ascending.
struct ObstacleTouch {
    std::vector<int> faces;
    std::vector<int> segments;     ///< of wires, edges of the topology
    std::vector<int> lone_points;  ///< of the mesh

    bool is_any() const { return !faces.empty() || !segments.empty() || !lone_points.empty(); }
};

/// By exact predicates; `found` is overwritten. A triangle that has no area is the segment or point it
/// covers. One whose box is clear of the obstacle's costs next to nothing. Corners must be finite.
void find_touches(const Obstacle& obstacle, const std::array<Vec3, 3>& triangle, ObstacleTouch& found);

/// Whether a triangle touches a segment, by exact predicates; either may be degenerate.
bool is_touching(const std::array<Vec3, 3>& triangle, const std::array<Vec3, 2>& segment);

/// About where two triangles meet that touch: the middle of the points where sides of the one pass through
/// the other, to rounding. Either may be without area.
Vec3 middle_of_touch(const std::array<Vec3, 3>& first, const std::array<Vec3, 3>& second);

}  // namespace arris
