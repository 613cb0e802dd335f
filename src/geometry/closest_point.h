// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include "geometry/vectors.h"

namespace arris {

/// The point of a triangle nearest to another.
struct PointOnTriangle {
    Vec3 point;
    std::array<double, 3> weights;  ///< of the corners; >= 0, sum 1
    int edge = -1;                  ///< it is inside the edge from corner `edge` to the next, or
    int corner = -1;                ///< at this corner, or, where both are -1, in the interior
};

/// `normal` is the triangle's unit normal, counter-clockwise; zero for one without area, whose nearest point
/// is then taken on its edges. Slivers are no worse than their normal.
PointOnTriangle closest_on_triangle(const Vec3& place, const std::array<Vec3, 3>& triangle,
                                    const Vec3& normal);

/// The parameter in [0, 1] of the point of the segment nearest to `place`; 0 on one without length.
double closest_on_segment(const Vec3& place, const Vec3& a, const Vec3& b);

/// Nearest points of two segments by their parameters in [0, 1]: exactly 0 or 1 at ends. Parallel ones have
/// many: one at an end of either is returned.
struct SegmentPair {
    double s, t;
    Vec3 first, second;
};
SegmentPair closest_between_segments(const std::array<Vec3, 2>& first, const std::array<Vec3, 2>& second);

}  // namespace arris
