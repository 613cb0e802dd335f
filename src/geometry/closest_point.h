// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "geometry/vectors.h"

namespace arris {

/// The point of a triangle nearest to a given point.
struct PointOnTriangle {
    Vec3 point;
    std::array<double, 3> weights;  ///< barycentric; >= 0, sum 1
    int edge = -1;                  ///< the point is inside the edge from corner `edge` to the next; else -1
    int corner = -1;                ///< the point is this corner; else -1 (both -1: in the interior)
};

/// `normal` is the triangle's unit normal, with the corners counter-clockwise. It is zero for a triangle
/// without area: the nearest point is then sought on the edges. For a sliver the error is that of `normal`.
PointOnTriangle closest_on_triangle(const Vec3& place, const std::array<Vec3, 3>& triangle,
                                    const Vec3& normal);

/// Parameter in [0, 1] of the point of the segment a-b nearest to `place`; 0 if the segment has no length.
double closest_on_segment(const Vec3& place, const Vec3& a, const Vec3& b);

/// Nearest points of two segments and their parameters in [0, 1], exactly 0 or 1 at ends. Parallel segments
/// have many nearest pairs: one that contains an end is returned.
struct SegmentPair {
    double s, t;
    Vec3 first, second;
};
SegmentPair closest_between_segments(const std::array<Vec3, 2>& first, const std::array<Vec3, 2>& second);

}  // namespace arris
