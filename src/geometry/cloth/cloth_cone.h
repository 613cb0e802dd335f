// SPDX-License-Identifier: GPL-3.0-or-later
//
// Finds the axis of a cone of cloth: cloth around a vertex that hangs over a point (a nail, or the end of a
// wire), with the point inside. Cloth that hangs steeply has pleats. The normals of its faces then have no
// common half space, and their mean may lead out of the cone. Seen from the vertex, the faces are arcs on a
// sphere. The axis is the centre of the largest circle that can be grown among these arcs from the direction
// of the point:
//
//        ___
//     __/   \_
//     \  q    \_     q: the point's direction, o: the axis
//      \_ o ___/
//        \_/
//
// At q, each arc is bounded by the great circle that touches the arc at its point nearest to q. The middle of
// the resulting half spaces has at least as much room as q, and no arc lies between the two. So the axis
// moves there, and the construction is repeated.
#pragma once

#include <array>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// A face of the cloth seen from one of its vertices: the unit directions along its two edges at that vertex.
using FaceSector = std::array<Vec3, 2>;

/// Sine of the angle between a unit direction and the sector; 1 from a right angle on. It is the distance of
/// a point in that direction to the face, taken as unbounded, over the point's distance to the vertex.
double sine_to_sector(const FaceSector& sector, const Vec3& direction);

/// The unit direction from the vertex with the most room (least sine to a sector) that can be reached from
/// `inside` (unit). On the way the room never shrinks and no sector is passed. Returns `inside` if it touches
/// a sector.
Vec3 find_cone_axis(const std::vector<FaceSector>& sectors, const Vec3& inside);

}  // namespace arris
