// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// A rigid obstacle's geometry in its own frame, m: triangles, wires and lone points on shared points.
/// Connected triangles without a border are a solid, counter-clockwise seen from outside (a cavity's shell
/// is seen from within it); those with a border are a sheet with two sides.
struct ObstacleMesh {
    std::vector<Vec3> points;
    std::vector<Face> faces;
    std::vector<std::array<int, 2>> segments;  ///< of wires
    std::vector<int> lone_points;              ///< nails
};

}  // namespace arris
