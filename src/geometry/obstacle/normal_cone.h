// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/obstacle/obstacle.h"

namespace arris {

// If a point c of an obstacle is the nearest of its surroundings to a place y, then y - c lies in the normal
// cone at c. That is, y - c has no component along any direction that leads from c into the obstacle (Johnson
// and Cohen, local minima of distance). At an edge these directions lead into its faces; at a point they lead
// along the edges that leave it. On solids the sign of the angle-weighted normal (Baerentzen and Aanaes 2005)
// selects the outside, so there is no contact from behind a thin wall. Sheets, wires and points have no
// inside.

/// Sine of the angle by which a direction may lie outside a cone, about three degrees. Cloth that lies flat
/// on a table is at the bound of the rim's cone, where rounding would switch contacts on and off.
inline constexpr double kConeTolerance = 0.05;

/// Whether a unit direction lies in the normal cone in the interior of topology edge `edge`, or at `point`,
/// within kConeTolerance. The component along the edge is ignored.
bool is_in_edge_cone(const Obstacle& obstacle, int edge, const Vec3& direction);
bool is_in_point_cone(const Obstacle& obstacle, int point, const Vec3& direction);

/// The unit direction perpendicular to the edge, in the edge's normal cone, that is nearest to `direction`.
/// `direction` must not be parallel to the edge.
Vec3 clamp_to_edge_cone(const Obstacle& obstacle, int edge, const Vec3& direction);

/// The outward normal of one of the solid faces at `point`: the face above which the place `point` + `from`
/// is highest. Zero where that place is above none of these faces.
Vec3 face_normal_towards(const Obstacle& obstacle, int point, const Vec3& from);

/// Unit vector in the plane of `face`, perpendicular to its edge `edge` (topology), towards the interior of
/// the face.
Vec3 into_face(const Obstacle& obstacle, int face, int edge);

/// Direction away from the obstacle, not unit. For an edge this is the sum of its faces' normals, for a point
/// the sum weighted by the faces' angles. Zero on wires and lone points. On a sheet's border edge it points
/// away from the sheet, in the sheet's plane.
Vec3 outward_of_edge(const Obstacle& obstacle, int edge);
Vec3 outward_of_point(const Obstacle& obstacle, int point);

}  // namespace arris
