// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// A closed run through corners of a polygon, which may come to a corner more than once.
struct PolygonLoop {
    std::vector<int> corners;
    std::vector<std::array<int, 2>> joined;  ///< a corner, and the corner near it that stands for both
};

/// Distance, in the unit of the corners, by which rounding of a file may move a corner of this polygon: 1e-6
/// of the polygon's size, as files in single precision are exact to 6e-8 and exporters lose another digit.
/// More where the polygon is far from the origin.
double rounding_of(const std::vector<Vec2>& corners);

/// The polygon's sides with touches made exact. Where two corners are within `tolerance`, unless a side joins
/// them, the first of `order` stands for both. A side within `tolerance` of a corner runs through it. `order`
/// has all corners as they follow each other. For polygons of at most 10 000 corners; others are returned as
/// they are, as the search may compare each corner with each side.
PolygonLoop join_touches(const std::vector<Vec2>& corners, const std::vector<int>& order, double tolerance);

}  // namespace arris
