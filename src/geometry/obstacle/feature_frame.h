// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "geometry/obstacle/obstacle.h"

namespace arris {

// Where a vertex that is on a sharp feature may go in the world: along the feature, and away from it by one
// direction chosen so that moving along it opens the gap to every face beside the feature. All in the
// obstacle's frame.

struct FeatureFrame {
    Vec3 point;    ///< of the feature, nearest to the vertex
    Vec3 tangent;  ///< unit, along an edge; zero at corners
    Vec3 outward;  ///< unit, perpendicular to the tangent
    double mitre;  ///< distance along `outward` that keeps distance 1 to the faces beside; at most 2
};

/// The cloth around the vertex, which alone tells which way is outward of a wire or point.
struct ClothAround {
    Vec3 normal;          ///< sum of the unit normals of both its sides, as they are oriented
    Vec3 leaving;         ///< sum of the unit directions in which its sides leave the feature
    Vec3 side;            ///< any vector from the feature to the cloth's side on which it has been
    int orientation = 0;  ///< 1 or -1 where it is known that normals point outward, or inward: cloth folded
                          ///< flat does not show it
};

/// On feature edge `edge` (index in features().edges). Convex: the bisector of its faces' normals; border:
/// the outward conormal; wire: halfway between the cloth's two sides, that is along its mean normal and
/// against where it leaves. Nothing where a wire's cloth tells no direction.
std::optional<FeatureFrame> find_edge_frame(const Obstacle& obstacle, int edge, const Vec3& place,
                                            const ClothAround& cloth);

/// Where a wire turns at end `end` (0 or 1) of edge `edge`: as on an edge that runs halfway between both.
std::optional<FeatureFrame> find_bend_frame(const Obstacle& obstacle, int edge, int end,
                                            const ClothAround& cloth);

/// On corner `corner` (index in features().corners). On a solid the direction whose least part along the
/// normals of its patches is greatest, on a sheet the same against its edges; wires' nodes and lone points as
/// a wire. Nothing where that least part is below 0.1 (a saddle: no direction opens all gaps).
std::optional<FeatureFrame> find_corner_frame(const Obstacle& obstacle, int corner, const Vec3& place,
                                              const ClothAround& cloth);

}  // namespace arris
