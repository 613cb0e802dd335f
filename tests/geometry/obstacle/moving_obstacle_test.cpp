// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle/moving_obstacle.h"

#include <gtest/gtest.h>

#include <numbers>

namespace arris {
namespace {

TEST(MovingObstacle, MovesFromItsPlacementAsItsMotionSays)
{
    RigidMotion motion;
    motion.angular_velocity = Vec3(0, 0, std::numbers::pi / 2.0);
    motion.pivot = Vec3(1, 0, 0);
    const Placement placement{rotation_about(Vec3::UnitX(), 90.0), Vec3(2, 0, 0)};
    const MovingObstacle obstacle("it", {{{0, 0, 0}}, {}, {}, {0}}, placement, motion, 30.0);
    EXPECT_NEAR((obstacle.at(0.0).placement(Vec3(0, 1, 0)) - Vec3(2, 0, 1)).norm(), 0.0, 1e-15);
    EXPECT_NEAR((obstacle.at(1.0).placement(Vec3(0, 1, 0)) - Vec3(1, 1, 1)).norm(), 0.0, 1e-15);
    EXPECT_NEAR((obstacle.at(1.0).placement.inverse()(Vec3(1, 1, 1)) - Vec3(0, 1, 0)).norm(), 0.0, 1e-15);
    EXPECT_NEAR((obstacle.velocity_after(0.0, Vec3(2, 0, 0)) - Vec3(0, std::numbers::pi / 2.0, 0)).norm(),
                0.0, 1e-15);
}

TEST(MovingObstacle, ItsShapeIsTheSameAtAllTimesAndInItsCopies)
{
    const MovingObstacle nail("nail", {{{1, 2, 3}}, {}, {}, {0}}, {}, {}, 30.0);
    const MovingObstacle copy = nail;
    EXPECT_EQ(&nail.at(0.0).shape->mesh(), &nail.shape().mesh());
    EXPECT_EQ(&copy.at(7.0)->mesh(), &nail.shape().mesh());
}

}  // namespace
}  // namespace arris
