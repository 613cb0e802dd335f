// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "geometry/obstacle/obstacle_topology.h"

namespace arris {

enum class FeatureKind { Convex, Border, Wire };

/// A sharp edge over which cloth can bend: a convex edge of a solid, a bent edge of a sheet, a sheet's
/// border, or a segment of a wire. A bent edge of a sheet is convex on one of the sheet's two sides, so it
/// has the kind Convex.
struct FeatureEdge {
    int edge;  ///< index in the topology
    FeatureKind kind;
    std::array<Vec3, 2> normals;  ///< normals of the faces beside the edge; border: twice that of its only
                                  ///< face; wire: zero
    int polyline;                 ///< index in ObstacleFeatures::polylines
    bool is_awake = true;         ///< whether it is sharp in the present pose of an obstacle that deforms
};

/// A point where features meet, end or bend sharply, a cone's apex, or a lone point.
struct FeatureCorner {
    int point;                  ///< index in the mesh
    std::vector<Vec3> normals;  ///< normals of the planar patches around the point; none for ends of wires
                                ///< and lone points
    bool is_awake = true;       ///< whether one of its edges is, or it has none
};

/// A chain of feature edges of one kind from corner to corner, or closed.
struct FeaturePolyline {
    double length = 0.0;  ///< m
    bool is_closed = false;
};

struct ObstacleFeatures {
    std::vector<FeatureEdge> edges;      ///< ascending by `edge`
    std::vector<FeatureCorner> corners;  ///< ascending by `point`; includes lone points
    std::vector<int> patch;              ///< planar patch of each face: connected faces in one plane, within
                                         ///< 1e-6 rad
    std::vector<FeaturePolyline> polylines;
};

/// Finds the features of a mesh that passes `validate`. An edge is sharp where the normals of its faces
/// differ by more than `feature_angle` (degrees, + 0.01).
///
/// An exact predicate decides whether a solid's edge is convex or reflex; faces folded flat onto one another
/// are convex. Reflex edges are no features.
///
/// A point is a corner where the number of feature edges is neither none nor two, or where its two edges
/// differ in kind. It is also a corner where the two bend by more than 30 degrees (wires: 60), or where the
/// angle defect of the faces exceeds 60 degrees. The last rule marks a cone's apex, but no pit in a solid.
///
/// A triangle lower than rounding in single precision (3e-7 of the mesh's diagonal) takes the normal of the
/// neighbour at its longest side.
ObstacleFeatures find_features(const ObstacleMesh& mesh, const ObstacleTopology& topology,
                               double feature_angle);

/// Calls a function with each pose of a mesh: the same mesh with its points elsewhere.
using PoseVisitor = std::function<void(const ObstacleMesh&, const ObstacleTopology&)>;
using VisitPoses = std::function<void(const PoseVisitor&)>;

/// Features of a mesh that deforms: what is sharp in at least one of its poses is a feature for ever, so that
/// numbers of features mean the same at all times. Normals and lengths are those of the given `mesh`.
/// `visit_poses` is called twice.
ObstacleFeatures find_features_of_poses(const ObstacleMesh& mesh, const ObstacleTopology& topology,
                                        double feature_angle, const VisitPoses& visit_poses);

/// The same features in another pose of their mesh: sets their normals there, and which of them are awake. A
/// convex edge is awake where its faces turn by more than `feature_angle` (degrees) over it.
void pose_features(const ObstacleMesh& mesh, const ObstacleTopology& topology, double feature_angle,
                   ObstacleFeatures& features);

}  // namespace arris
