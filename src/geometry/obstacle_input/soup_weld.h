// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/obstacle/obstacle_mesh.h"

namespace arris {

/// What `weld` joined and dropped.
struct WeldCounts {
    int equal_points = 0;        ///< joined with one at the same place
    int near_points = 0;         ///< joined with one within the tolerance
    double tolerance = 0.0;      ///< m
    int collapsed_faces = 0;     ///< named a point twice
    int duplicate_faces = 0;     ///< same three points, in whichever direction
    int zero_segments = 0;       ///< named a point twice
    int duplicate_segments = 0;  ///< same two points
    int duplicate_lone_points = 0;
};

/// Joins points that are equal to the last bit, and drops those that nothing names. Coordinates must not be
/// NaN and indices be in range. Returns how many were joined. O(n log n).
int join_equal_points(ObstacleMesh& soup);

/// Joins points of a soup: all that are equal to the last bit, and then, among points of borders, wires and
/// lone points, those within 1e-6 of the bounding box's diagonal. Inside a closed surface points are where
/// they were meant to be: a plate a million times as wide as it is thick stays one. Each point joins the
/// first, by number, of those near it, so chains of near points do not run away. Faces and segments that
/// named a point twice, and duplicates (the first stays), are dropped, then points that nothing names.
/// Coordinates must be finite and indices in range. Linear, but for a sort.
WeldCounts weld(ObstacleMesh& soup);

}  // namespace arris
