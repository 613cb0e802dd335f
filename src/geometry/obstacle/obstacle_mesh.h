// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// A rigid obstacle's geometry in its own frame, m: triangles, wires and lone points on shared points.
/// Connected triangles without a border form a solid. They are counter-clockwise seen from outside the solid;
/// the shell of a cavity is so seen from within the cavity. Connected triangles with a border form a sheet
/// with two sides.
struct ObstacleMesh {
    std::vector<Vec3> points;
    std::vector<Face> faces;
    std::vector<std::array<int, 2>> segments;  ///< segments of wires
    std::vector<int> lone_points;              ///< nails
};

}  // namespace arris
