// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "geometry/obstacle/deformation.h"
#include "geometry/obstacle/obstacle.h"
#include "geometry/rigid_motion.h"

namespace arris {

/// An obstacle at one time: its shape in a frame, and that frame's placement in the world.
struct ObstaclePose {
    std::shared_ptr<const Obstacle> shape;
    Placement placement;

    operator const Obstacle&() const { return *shape; }
    const Obstacle* operator->() const { return shape.get(); }
};

/// An obstacle of a scene: the one place that knows how obstacles move. This one is rigid. Another kind of
/// motion has another class behind `at` and `velocity_after`; what indices of faces, edges and features mean
/// must not change in time.
class MovingObstacle {
  public:
    /// `mesh` must pass `validate`. At time 0 its frame's placement in the world is `motion.at(0) *
    /// placement`. Edges that turn by more than `feature_angle` (degrees) are sharp.
    MovingObstacle(std::string name, ObstacleMesh mesh, const Placement& placement, RigidMotion motion,
                   double feature_angle, std::shared_ptr<const Deformation> deformation = nullptr);

    const std::string& name() const { return name_; }

    /// Its faces, edges and features, whose indices hold at all times.
    const Obstacle& shape() const { return *shape_; }

    ObstaclePose at(double time) const;  ///< s

    /// World velocity (m/s) just after `time` of the obstacle's material that is then at `place` (world).
    Vec3 velocity_after(double time, const Vec3& place) const { return motion_.velocity_after(time, place); }

    bool is_moving() const { return motion_.is_moving(); }         ///< at any time
    std::vector<double> jumps() const { return motion_.jumps(); }  ///< s: times at which its velocity jumps
    const RigidMotion& motion() const { return motion_; }          ///< for records and words about it
    /// How its mesh deforms in its frame; null for a rigid one.
    const std::shared_ptr<const Deformation>& deformation() const { return deformation_; }

  private:
    std::string name_;
    std::shared_ptr<const Obstacle> shape_;
    Placement placement_;
    RigidMotion motion_;
    std::shared_ptr<const Deformation> deformation_;
};

}  // namespace arris
