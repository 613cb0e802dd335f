// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/obstacle/obstacle.h"

namespace arris {

/// The obstacle's elements that a triangle of the cloth at rest touches; each list ascending.
struct ObstacleTouch {
    std::vector<int> faces;
    std::vector<int> segments;     ///< wire segments, as topology edges
    std::vector<int> lone_points;  ///< points of the mesh

    bool is_any() const { return !faces.empty() || !segments.empty() || !lone_points.empty(); }
};

/// Finds touched elements by exact predicates; overwrites `found`. A triangle without area is treated as the
/// segment or point that it covers. A triangle whose box misses the obstacle's box costs next to nothing.
/// Corners must be finite.
void find_touches(const Obstacle& obstacle, const std::array<Vec3, 3>& triangle, ObstacleTouch& found);

/// Whether a triangle touches a segment, by exact predicates; either may be degenerate.
bool is_touching(const std::array<Vec3, 3>& triangle, const std::array<Vec3, 2>& segment);

/// Approximate location at which two touching triangles meet: the mean of the points where the sides of one
/// cross the other, to rounding. Either triangle may have no area.
Vec3 middle_of_touch(const std::array<Vec3, 3>& first, const std::array<Vec3, 3>& second);

}  // namespace arris
