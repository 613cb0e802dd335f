// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle/moving_obstacle.h"

#include <utility>

namespace arris {

MovingObstacle::MovingObstacle(std::string name, ObstacleMesh mesh, const Placement& placement,
                               RigidMotion motion, double feature_angle,
                               std::shared_ptr<const Deformation> deformation)
    : name_(std::move(name)),
      shape_(std::make_shared<Obstacle>(std::move(mesh), feature_angle)),
      placement_(placement),
      motion_(std::move(motion)),
      deformation_(std::move(deformation))
{
}

ObstaclePose MovingObstacle::at(double time) const
{
    return {shape_, motion_.at(time) * placement_};
}

}  // namespace arris
