// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/obstacle/obstacle_topology.h"

namespace arris {

enum class FeatureKind { Convex, Border, Wire };

/// A sharp edge that cloth can bend over: a convex edge of a solid or sheet (a sheet's edge that turns is
/// convex on one of its sides and is one, too), a sheet's border, or a wire's segment.
struct FeatureEdge {
    int edge;  ///< in the topology
    FeatureKind kind;
    std::array<Vec3, 2> normals;  ///< of the faces beside it; border: both that face's; wire: zero
    int polyline;                 ///< edges of one kind chained from corner to corner share one
};

/// A point where features meet, end or turn, or that stands out by itself.
struct FeatureCorner {
    int point;                  ///< in the mesh
    std::vector<Vec3> normals;  ///< of the planar patches around it; none for wires' ends and lone points
};

struct ObstacleFeatures {
    std::vector<FeatureEdge> edges;      ///< ascending by `edge`
    std::vector<FeatureCorner> corners;  ///< ascending by `point`; lone points among them
    std::vector<int> patch;              ///< planar patch of each face: neighbours in one plane, 1e-6 rad
    int polyline_count = 0;
};

/// Features of a mesh that passes `validate`. An edge is sharp where its faces turn by more than
/// `feature_angle` (degrees, + 1e-6). A solid's are convex or reflex by an exact predicate, faces folded flat
/// onto one another convex; reflex ones are no features. Corners: where the number of feature edges is
/// neither none nor two, where two turn by more than 30 degrees (of a wire: 60) or differ in kind, or where
/// the angle defect of the faces exceeds 60 degrees (a cone's apex, but no solid's pit). A triangle lower
/// than rounding in single precision (3e-7 of the mesh's diagonal) has the normal of the neighbour at its
/// longest side.
ObstacleFeatures find_features(const ObstacleMesh& mesh, const ObstacleTopology& topology,
                               double feature_angle);

}  // namespace arris
