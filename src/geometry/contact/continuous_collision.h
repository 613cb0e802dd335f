// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>

#include "geometry/vectors.h"

namespace arris {

/// A time after the step, later than every touch.
inline constexpr double kNever = 2.0;

/// The first touch of a moving element of the cloth and an element of an obstacle.
struct SweepHit {
    double time;                    ///< fraction of the step in [0, 1]
    std::array<double, 3> weights;  ///< weights of the meeting point on the cloth's element; unused ones 0
    std::array<double, 3> on_obstacle;  ///< the same on the obstacle's element
    Vec3 point;                         ///< meeting point on the obstacle, where that is at the step's end
    Vec3 normal;  ///< unit vector from the obstacle to the cloth that separates the elements just before;
                  ///< zero if none does
};

// The cloth's vertices move linearly from `begin` to `end`. The sweeps are conservative: a pair that touches
// is always reported, at the latest at the touch, in spite of rounding. This includes degenerate elements and
// zero motion.
//
// A pair that comes within `distance` (m, > 0) may be reported too. A pair that begins nearer than twice
// `distance` is reported only if it comes within half of its initial gap. Gaps below 1e-14 of the pair's size
// count as zero. Coordinates that are not finite are reported at time 0. Elements that pivot at a tiny gap in
// one common plane may be reported where 256 rounds do not decide.
//
// The obstacle rests, or its points move linearly from their places at begin to those at the end.

/// A vertex and a triangle.
std::optional<SweepHit> sweep_vertex_face(const Vec3& begin, const Vec3& end,
                                          const std::array<Vec3, 3>& triangle_begin,
                                          const std::array<Vec3, 3>& triangle_end, double distance);
inline std::optional<SweepHit> sweep_vertex_face(const Vec3& begin, const Vec3& end,
                                                 const std::array<Vec3, 3>& triangle, double distance)
{
    return sweep_vertex_face(begin, end, triangle, triangle, distance);
}

/// A cloth edge and a segment.
std::optional<SweepHit> sweep_edge_edge(const std::array<Vec3, 2>& begin, const std::array<Vec3, 2>& end,
                                        const std::array<Vec3, 2>& segment_begin,
                                        const std::array<Vec3, 2>& segment_end, double distance);
inline std::optional<SweepHit> sweep_edge_edge(const std::array<Vec3, 2>& begin,
                                               const std::array<Vec3, 2>& end,
                                               const std::array<Vec3, 2>& segment, double distance)
{
    return sweep_edge_edge(begin, end, segment, segment, distance);
}

/// A cloth triangle and a point.
std::optional<SweepHit> sweep_face_point(const std::array<Vec3, 3>& begin, const std::array<Vec3, 3>& end,
                                         const Vec3& point_begin, const Vec3& point_end, double distance);
inline std::optional<SweepHit> sweep_face_point(const std::array<Vec3, 3>& begin,
                                                const std::array<Vec3, 3>& end, const Vec3& point,
                                                double distance)
{
    return sweep_face_point(begin, end, point, point, distance);
}

/// The first touch of two moving elements of the cloth. `begin` and `end` hold the corners of both.
struct ClothSweepHit {
    double time;
    std::array<double, 4>
        weights;  ///< of the two meeting points: sum 1 on the first, -1 on the second element
    Vec3 normal;  ///< as SweepHit's, from the second element to the first
};

/// A vertex (the first point) and a face of the cloth.
std::optional<ClothSweepHit> sweep_cloth_vertex_face(const std::array<Vec3, 4>& begin,
                                                     const std::array<Vec3, 4>& end, double distance);

/// Two edges of the cloth: the first two points, and the last two.
std::optional<ClothSweepHit> sweep_cloth_edges(const std::array<Vec3, 4>& begin,
                                               const std::array<Vec3, 4>& end, double distance);

}  // namespace arris
