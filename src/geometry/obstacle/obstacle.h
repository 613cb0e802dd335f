// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "geometry/obstacle/obstacle_features.h"
#include "geometry/obstacle/obstacle_mesh.h"
#include "geometry/obstacle/obstacle_topology.h"
#include "geometry/rigid_motion.h"

namespace arris {

using Box3 = Eigen::AlignedBox3d;

/// A rigid obstacle. Everything but `at` and `velocity_after` is in the obstacle's own frame, where mesh,
/// features and search trees are built once. Queries are const and may run in parallel.
class Obstacle {
  public:
    /// `mesh` must pass `validate`. At time 0 the frame's placement in the world is `motion.at(0) *
    /// placement`.
    Obstacle(std::string name, ObstacleMesh mesh, const Placement& placement, RigidMotion motion,
             double feature_angle);
    ~Obstacle();
    Obstacle(const Obstacle& other);  ///< builds its own trees
    Obstacle& operator=(const Obstacle& other);
    Obstacle(Obstacle&&) noexcept;
    Obstacle& operator=(Obstacle&&) noexcept;

    const std::string& name() const { return name_; }
    const ObstacleMesh& mesh() const { return mesh_; }
    const ObstacleTopology& topology() const { return topology_; }
    const ObstacleFeatures& features() const { return features_; }
    const Box3& bounds() const { return bounds_; }
    const RigidMotion& motion() const { return motion_; }

    /// Placement that maps the frame to the world at `time` (s).
    Placement at(double time) const;

    /// World velocity (m/s) just after `time` of the obstacle's material that is then at `place` (world).
    Vec3 velocity_after(double time, const Vec3& place) const { return motion_.velocity_after(time, place); }

    // Elements that intersect a box, ascending, without duplicates. `found` is overwritten.
    void find_faces(const Box3& box, std::vector<int>& found) const;
    void find_feature_edges(const Box3& box, std::vector<int>& found) const;  ///< indices in features().edges
    void find_corners(const Box3& box, std::vector<int>& found) const;        ///< indices in
                                                                              ///< features().corners

    /// Faces that intersect the closed triangle (a, b, c) or segment (a, b), by exact predicates; ascending.
    void find_faces_touching(const Vec3& a, const Vec3& b, const Vec3& c, std::vector<int>& found) const;
    void find_faces_touching(const Vec3& a, const Vec3& b, std::vector<int>& found) const;

  private:
    struct Trees;
    std::string name_;
    ObstacleMesh mesh_;
    Placement placement_;
    RigidMotion motion_;
    ObstacleTopology topology_;
    ObstacleFeatures features_;
    Box3 bounds_;
    std::unique_ptr<Trees> trees_;
};

}  // namespace arris
