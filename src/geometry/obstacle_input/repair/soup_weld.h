// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/obstacle/obstacle_mesh.h"

namespace arris {

/// Counts of elements that `weld` joined and dropped.
struct WeldCounts {
    std::vector<int> names;      ///< index that each point has afterwards; -1 where no element names it
    int equal_points = 0;        ///< joined with a point at the same place
    int near_points = 0;         ///< joined with a point within the tolerance
    double tolerance = 0.0;      ///< m
    int collapsed_faces = 0;     ///< naming a point twice
    int duplicate_faces = 0;     ///< with the same three points, in either orientation
    int zero_segments = 0;       ///< naming a point twice
    int duplicate_segments = 0;  ///< with the same two points
    int duplicate_lone_points = 0;
};

struct JoinedPoints {
    int count = 0;           ///< points joined with another one
    std::vector<int> names;  ///< index that each point has afterwards; -1 where no element names it
};

/// Joins points that are bitwise equal, and drops points that no element names. Coordinates must not be NaN,
/// and indices must be in range. O(n log n).
JoinedPoints join_equal_points(ObstacleMesh& soup);

/// Joins points of a soup that are bitwise equal. Among points of borders, wires and lone points, it also
/// joins points within 1e-6 of the bounding box's diagonal. Points inside a closed surface are left where
/// they are, so that a plate a million times as wide as it is thick survives. Each point joins the first, by
/// number, of the points near it, so chains of near points do not collapse.
///
/// Drops faces and segments that name a point twice, duplicates except the first, and then points that no
/// element names. Coordinates must be finite and indices in range. Linear, apart from a sort.
WeldCounts weld(ObstacleMesh& soup);

}  // namespace arris
