// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// What a vertex of a flat triangulation may do while its angles are improved.
struct Freedom {
    bool is_fixed = false;
    bool is_on_line = false;
    Vec2 along = Vec2::Zero();  ///< unit length; a vertex on a line moves along it only
};

/// Moves vertices of faces whose least angle is below the aim so that the least angle around each grows;
/// never lets one shrink. `length` is the scale of the moves. Deterministic, a bounded number of sweeps.
/// Faces stay counter-clockwise if they are.
void relax_angles(const std::vector<Face>& faces, const std::vector<Freedom>& freedom, double length,
                  std::vector<Vec2>& places);

/// Sine of the least angle of a counter-clockwise triangle; not positive where it is degenerate or clockwise.
double least_sine(const Vec2& a, const Vec2& b, const Vec2& c);

}  // namespace arris
