// SPDX-License-Identifier: GPL-3.0-or-later
//
// Cloth that hangs over a wire, seen along it: the sides A and B must not get past the half plane that begins
// at the wire and leads away from the vertex v on it. An edge of the cloth from v meets the wire exactly when
// it gets into that plane.
//
//           v          As long as both keep off it, the wire is between them, and this is checked like all
//          /|\         else. Where they hang straight down the plane is all that holds them apart: by an
//          angle
//         / o \        that nobody sees, but well above what rounding makes of it.
//        A  :  B
#pragma once

#include <vector>

#include "geometry/obstacle/feature_frame.h"

namespace arris {

/// Outward from a wire at the end of a step of `dt` (s): towards `wanted.outward`, at 0.1 m/s of the vertex
/// at most and as far as the plane behind it stays off the cloth. `place` is the vertex, `beside` are its
/// neighbours that are not on the wire, m, in the obstacle's frame. `wanted.outward` where the vertex is on
/// the wire's very line.
Vec3 turn_outward(const FeatureFrame& wanted, const Vec3& place, const std::vector<Vec3>& beside, double dt);

/// The angle of a place from the plane behind a vertex whose outward direction `frame` has, seen from the
/// wire, about its tangent: in (-pi, pi] rad. Its sign tells the side.
double angle_behind(const FeatureFrame& frame, const Vec3& place);

/// How a place on one side of cloth folded over a wire, 1 or -1 as the sign of its angle, is kept there.
struct FoldBound {
    Vec3 normal;       ///< unit, from the plane to its side
    double least_gap;  ///< m, from the wire along `normal`: `wanted`, or less where it is nearer
    double wanted;     ///< m, at the least angle
};
FoldBound find_fold_bound(const FeatureFrame& frame, const Vec3& place, int side);

}  // namespace arris
