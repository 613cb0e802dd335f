// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/vectors.h"

namespace arris {

enum class PolygonDefect {
    None,
    CrossesItself,  ///< two sides cross, or the polygon covers a place twice
    NoArea,         ///< all corners lie on one line, or each side is run through in both directions
};

/// The triangles of a polygon, as indices of its corners. Empty where the polygon has a defect.
struct PolygonTriangles {
    std::vector<Face> faces;
    PolygonDefect defect = PolygonDefect::None;
};

/// Constrained Delaunay triangulation of a polygon's inside; exact. Triangles have the orientation of the
/// polygon. The cut depends neither on the starting corner nor on the orientation. Repeated corners, corners
/// on a line, corners on another side, and holes that a side run through twice joins to the outline are
/// allowed. Coordinates must be finite. At least three corners.
PolygonTriangles triangulate_polygon(const std::vector<Vec2>& corners);

/// Triangulates a polygon that is flat, or nearly so, as seen along its normal.
PolygonTriangles triangulate_polygon(const std::vector<Vec3>& corners);

}  // namespace arris
