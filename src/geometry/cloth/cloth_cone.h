// SPDX-License-Identifier: GPL-3.0-or-later
//
// Cloth around a vertex that hangs over a point is a cone with the point inside, mostly a pleated one: cloth
// that hangs steeper than it can without pleats. Its faces' normals then have no middle, and their mean may
// lead out of it; what the point needs is room. Seen from the vertex the faces are arcs on a sphere, and the
// axis is the centre of the largest circle about the point's direction that can be grown among them:
//
//        ___
//     __/   \_
//     \  q    \_     q: the point's direction, o: the axis
//      \_ o ___/
//        \_/
//
// Around q each arc is kept off by the great circle that touches it where it is nearest. The middle of these
// half spaces has as much room as q at least, and no arc is between q and it: so it may be gone to, and from
// there again.
#pragma once

#include <array>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// A face of the cloth seen from one of its vertices: the unit directions along its two edges there.
using FaceSector = std::array<Vec3, 2>;

/// Sine of the angle between a unit direction and the sector: of the distance from a place in that direction
/// to a face that has no end, over the distance to the vertex. 1 where the vertex is nearest.
double sine_to_sector(const FaceSector& sector, const Vec3& direction);

/// The unit direction from the vertex with the most room, as far as it can be turned to from `inside` (unit)
/// with no less room on the way and through none of the sectors. `inside` where it touches one.
Vec3 find_cone_axis(const std::vector<FaceSector>& sectors, const Vec3& inside);

}  // namespace arris
