// SPDX-License-Identifier: GPL-3.0-or-later
//
// Cloth that hangs over a wire, seen along the wire. Its sides A and B must not pass the fold plane: the half
// plane that begins at the wire and leads away from the vertex v on the wire. An edge of the cloth from v
// meets the wire exactly when the edge enters that plane.
//
//           v          As long as both sides keep off the plane, the wire is between them, and the check
//          /|\         proves this. Where the sides hang straight down, only the plane holds them apart:
//          angle
//         / o \        by an angle too small to be visible, but well above round-off.
//        A  :  B
#pragma once

#include <array>
#include <vector>

#include "geometry/obstacle/feature_frame.h"

namespace arris {

/// Whether cloth is folded around a wire's `segment` at the vertex `place`: on both sides, an edge from there
/// passes the segment nearer than the vertex, and within `reach` (m). One of these edges leads to `other`,
/// one to a vertex of `around`.
bool is_folded_around(const std::array<Vec3, 2>& segment, const Vec3& place, const Vec3& other,
                      const std::vector<Vec3>& around, double reach);

/// Whether the cloth at the vertex `place` is folded beside a wire's `segment`: all its edges across the
/// wire, which lead to `around`, leave to one side of the way to the wire. The wire is then outside of the
/// fold.
bool is_folded_beside(const std::array<Vec3, 2>& segment, const Vec3& place, const std::vector<Vec3>& around);

/// Direction outward from a wire at the end of a step of `dt` (s). Turns towards `wanted.outward`, as far as
/// the plane behind stays off the cloth and the vertex moves at most at 0.1 m/s. `place` is the vertex and
/// `beside` its neighbours that are not on the wire, m, in the obstacle's frame. `wanted.outward` where the
/// vertex is exactly on the wire.
Vec3 turn_outward(const FeatureFrame& wanted, const Vec3& place, const std::vector<Vec3>& beside, double dt);

/// Angle, rad in (-pi, pi], of a place from the plane behind a vertex with the outward direction of `frame`,
/// about the wire's tangent. Its sign is the side.
double angle_behind(const FeatureFrame& frame, const Vec3& place);

/// Bound that keeps a place on its side, 1 or -1 as the sign of its angle, of cloth folded over a wire.
struct FoldPlaneBound {
    Vec3 normal;       ///< unit, from the plane to its side
    double least_gap;  ///< m, from the wire along `normal`: `wanted`, or the current gap if smaller
    double wanted;     ///< m, at the least angle
};
FoldPlaneBound find_fold_plane_bound(const FeatureFrame& frame, const Vec3& place, int side);

}  // namespace arris
