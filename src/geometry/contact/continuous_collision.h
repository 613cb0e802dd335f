// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>

#include "geometry/vectors.h"

namespace arris {

/// Where a moving element of the cloth meets a resting element of an obstacle.
struct SweepHit {
    double time;                    ///< of first touch, fraction of the step in [0, 1]
    std::array<double, 3> weights;  ///< of the meeting point on the cloth's element; unused ones 0
    Vec3 point;                     ///< of the obstacle
    Vec3 normal;  ///< unit, from the obstacle to the cloth: separates them just before; zero if nothing does
};

// The cloth's vertices move linearly from `begin` to `end`. Conservative: one that touches is always
// reported, at the latest when it does, in spite of rounding; degenerate elements and zero motion included.
// One that comes within `distance` (m, > 0) may be, but what begins nearer than twice that is let go on as
// long as it does not come within half of its gap; gaps below 1e-14 of the pair's size count as none. What is
// not finite is reported at time 0. Elements that pivot at a tiny gap in one common plane may be reported as
// well, where 256 rounds do not tell.

/// A vertex and a triangle.
std::optional<SweepHit> sweep_vertex_face(const Vec3& begin, const Vec3& end,
                                          const std::array<Vec3, 3>& triangle, double distance);

/// A cloth edge and a segment.
std::optional<SweepHit> sweep_edge_edge(const std::array<Vec3, 2>& begin, const std::array<Vec3, 2>& end,
                                        const std::array<Vec3, 2>& segment, double distance);

/// A cloth triangle and a point.
std::optional<SweepHit> sweep_face_point(const std::array<Vec3, 3>& begin, const std::array<Vec3, 3>& end,
                                         const Vec3& point, double distance);

}  // namespace arris
