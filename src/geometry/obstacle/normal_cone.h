// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/obstacle/obstacle.h"

namespace arris {

// Where a point c of an obstacle is the nearest of its surroundings to a place y, y - c lies in the normal
// cone at c: it has no part along any direction that leads from c into the obstacle (Johnson and Cohen, local
// minima of distance). On an edge these are the directions into its faces, at a point the edges that leave
// it. On solids the cone is outside by the sign of the angle-weighted normal (Baerentzen and Aanaes 2005):
// behind a thin wall is no contact. Sheets, wires and points have no inside.

/// Sine of the angle by which a direction may lie outside a cone: cloth that lies flat on a table is at the
/// rim's cone's bound, and comes and goes there by rounding. About three degrees.
inline constexpr double kConeTolerance = 0.05;

/// Whether a unit direction lies in the normal cone inside topology edge `edge` (its part along the edge is
/// not looked at), or at `point`; within kConeTolerance.
bool is_in_edge_cone(const Obstacle& obstacle, int edge, const Vec3& direction);
bool is_in_point_cone(const Obstacle& obstacle, int point, const Vec3& direction);

/// The unit direction of the edge's normal cone nearest to `direction` (not along the edge), perpendicular to
/// the edge.
Vec3 clamp_to_edge_cone(const Obstacle& obstacle, int edge, const Vec3& direction);

/// The outward normal of that of the solid faces at `point` over which a place off by `from` is highest; zero
/// where it is over none of them.
Vec3 face_normal_towards(const Obstacle& obstacle, int point, const Vec3& from);

/// Unit, in `face` and perpendicular to its edge `edge` (topology), towards the face's inside.
Vec3 into_face(const Obstacle& obstacle, int face, int edge);

/// Away from the obstacle: along the sum of the normals of an edge's faces, of a point's by their angles;
/// zero on wires and lone points, from a sheet's border away from the sheet.
Vec3 outward_of_edge(const Obstacle& obstacle, int edge);
Vec3 outward_of_point(const Obstacle& obstacle, int point);

}  // namespace arris
