// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
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
    std::vector<std::array<int, 2>> joined;  ///< a corner, and the one near it that triangles name instead
};

/// What happens where a polygon nearly touches itself, within the rounding of its file (rounding_of).
enum class NearTouch {
    Keep,  ///< sides stay where they are, unless they cross: thin plates are shapes
    Join,  ///< a side runs through the corner that it touches: cloth has no gaps and slivers this thin
};

/// Constrained Delaunay triangulation of a polygon's inside; exact. Triangles have the orientation of the
/// polygon. The cut depends neither on the starting corner nor on the orientation. Repeated corners, corners
/// on a line, corners on another side, and holes that a side run through twice joins to the outline are
/// allowed. Sides that cross only within the rounding of a file touch: they are bent to run through the
/// corner in question. Coordinates must be finite. At least three corners.
PolygonTriangles triangulate_polygon(const std::vector<Vec2>& corners, NearTouch touch = NearTouch::Keep);

/// Triangulates a polygon that is flat, or nearly so, as seen along its normal.
PolygonTriangles triangulate_polygon(const std::vector<Vec3>& corners, NearTouch touch = NearTouch::Keep);

/// Triangles from one corner of a polygon with a defect to all its sides. The corner does not depend on where
/// the polygon starts.
std::vector<Face> fan_polygon(const std::vector<Vec3>& corners);

/// The greatest distance of a corner from the plane through the corners' middle along the polygon's normal,
/// and that corner. 0 for a triangle.
struct PolygonBend {
    double distance = 0.0;
    double size = 0.0;  ///< greatest distance of a corner from the middle
    int corner = 0;
};
PolygonBend find_bend(const std::vector<Vec3>& corners);

}  // namespace arris
