// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "geometry/obstacle/obstacle_features.h"
#include "geometry/obstacle/obstacle_mesh.h"
#include "geometry/obstacle/obstacle_topology.h"
#include "geometry/vectors.h"

namespace arris {

using Box3 = Eigen::AlignedBox3d;

/// What an obstacle is made of, in its own frame: mesh, sharp features and search trees. It does not move:
/// where it is at a time says `MovingObstacle`. Queries are const and may run in parallel.
class Obstacle {
  public:
    /// `mesh` must pass `validate`. Edges that turn by more than `feature_angle` (degrees) are sharp. Of a
    /// mesh that deforms, whatever is sharp in one of its poses is a feature (find_features_of_poses).
    Obstacle(ObstacleMesh mesh, double feature_angle, const VisitPoses& visit_poses = nullptr);

    /// The same obstacle with its points (finite, any) elsewhere. Faces may lose their area there.
    Obstacle(const Obstacle& shape, std::vector<Vec3> points);
    ~Obstacle();
    Obstacle(Obstacle&&) noexcept;
    Obstacle& operator=(Obstacle&&) noexcept;

    const ObstacleMesh& mesh() const { return mesh_; }
    const ObstacleTopology& topology() const { return topology_; }
    const ObstacleFeatures& features() const { return features_; }
    const Box3& bounds() const { return bounds_; }

    // Elements that intersect a box, ascending, without duplicates; of features those that are awake. `found`
    // is overwritten.
    void find_faces(const Box3& box, std::vector<int>& found) const;
    void find_feature_edges(const Box3& box, std::vector<int>& found) const;  ///< indices in features().edges
    void find_corners(const Box3& box, std::vector<int>& found) const;        ///< indices in
                                                                              ///< features().corners

    /// The face nearest to a place (any of several equally near), of those nearer than `most` (m); else -1.
    int find_nearest_face(const Vec3& place, double most) const;

    /// Faces that intersect the closed triangle (a, b, c) or segment (a, b), by exact predicates; ascending.
    void find_faces_touching(const Vec3& a, const Vec3& b, const Vec3& c, std::vector<int>& found) const;
    void find_faces_touching(const Vec3& a, const Vec3& b, std::vector<int>& found) const;

  private:
    struct Trees;
    ObstacleMesh mesh_;
    ObstacleTopology topology_;
    double feature_angle_;  ///< degrees
    ObstacleFeatures features_;
    Box3 bounds_;
    std::unique_ptr<Trees> trees_;
};

}  // namespace arris
