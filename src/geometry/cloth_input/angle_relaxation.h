// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// How a vertex of a flat triangulation may move while its angles are improved.
struct Freedom {
    bool is_fixed = false;
    bool is_on_line = false;
    Vec2 along = Vec2::Zero();  ///< unit length; a vertex on a line moves only along it
};

/// Rounds of relaxing and triangulating anew. Raising it costs time, and lets sides grow longer.
inline constexpr int kRelaxRounds = 3;

/// Moves the vertices of faces with an angle below 30 degrees so that the least angle around each vertex
/// grows; no move reduces it. `length` is the scale of the moves. Deterministic, with a bounded number of
/// sweeps. Faces that are counter-clockwise stay so.
void relax_angles(const std::vector<Face>& faces, const std::vector<Freedom>& freedom, double length,
                  std::vector<Vec2>& places);

/// Sine of the least angle of a counter-clockwise triangle; not positive where it is degenerate or clockwise.
double least_sine(const Vec2& a, const Vec2& b, const Vec2& c);

}  // namespace arris
