// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "geometry/obstacle/obstacle.h"

namespace arris {

// Directions in which a vertex on a sharp feature may move in the world: along the feature, and away from it
// along `outward`. Moving along `outward` opens the gap to every face beside the feature. All vectors are in
// the obstacle's frame.

struct FeatureFrame {
    Vec3 point;    ///< point of the feature nearest to the vertex
    Vec3 tangent;  ///< unit vector along an edge; zero at corners
    Vec3 outward;  ///< unit vector perpendicular to the tangent
    double mitre;  ///< distance along `outward` at distance 1 from the faces beside the feature; at most 2
};

/// The cloth around the vertex. Only the cloth determines which direction is outward of a wire or point.
struct ClothAround {
    Vec3 normal;          ///< sum of the unit normals of the cloth's two sides, as the faces are oriented
    Vec3 leaving;         ///< sum of the unit directions in which the two sides leave the feature
    Vec3 side;            ///< any vector from the feature to the side on which the cloth has been
    int orientation = 0;  ///< 1 or -1 where normals are known to point outward or inward; 0 if unknown. Cloth
                          ///< folded flat does not show its orientation.
};

/// Frame on feature edge `edge` (index in features().edges). Outward is the bisector of the faces' normals on
/// a convex edge, and the outward conormal on a border. On a wire it is halfway between the cloth's two
/// sides, along the cloth's mean normal and opposite to where the sides leave. Returns nothing where the
/// cloth at a wire determines no direction.
std::optional<FeatureFrame> find_edge_frame(const Obstacle& obstacle, int edge, const Vec3& place,
                                            const ClothAround& cloth);

/// Frame where a wire bends at end `end` (0 or 1) of edge `edge`: as on an edge halfway between the two
/// edges.
std::optional<FeatureFrame> find_bend_frame(const Obstacle& obstacle, int edge, int end,
                                            const ClothAround& cloth);

/// Frame on corner `corner` (index in features().corners). On a solid, outward maximises its least component
/// along the normals of the patches. On a sheet, it maximises its least component opposite to the sheet's
/// edges. Nodes of wires and lone points are treated as a wire is. Returns nothing where that least component
/// is below 0.1, as at a saddle, where no direction opens all gaps.
std::optional<FeatureFrame> find_corner_frame(const Obstacle& obstacle, int corner, const Vec3& place,
                                              const ClothAround& cloth);

}  // namespace arris
