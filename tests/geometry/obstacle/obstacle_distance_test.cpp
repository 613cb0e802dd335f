// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle/obstacle_distance.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/geometry/contact_scene.h"
#include "tests/geometry/sample_obstacles.h"

namespace arris {
namespace {

TEST(ObstacleDistance, IsThatOfTheNearestOfAllElementsUpToTheMost)
{
    const auto bumps = [](int i, int j) { return 0.3 * std::sin(1.3 * i) * std::cos(2.1 * j); };
    const ObstacleMesh mixed = samples::together(
        samples::together(samples::l_prism(), samples::wire({{2, 0, 0}, {2, 1, 0.5}}, false)),
        samples::nails({{-1, -1, 0.2}}));
    std::mt19937 engine(7);
    std::uniform_real_distribution<double> coordinate(-2.0, 3.0);
    for (const ObstacleMesh& mesh : {mixed, samples::sheet(4, 5, bumps), samples::sphere(6, 9)}) {
        const Obstacle obstacle = samples::make_obstacle(mesh);
        for (int k = 0; k < 200; ++k) {
            const Vec3 place(coordinate(engine), coordinate(engine), coordinate(engine));
            const double expected = (place - samples::nearest_point(mesh, place)).norm();
            for (const double most : {0.0, 0.3, 10.0})
                EXPECT_NEAR(distance_to(obstacle, place, most), std::min(most, expected), 1e-12);
        }
    }
}

TEST(ObstacleDistance, IsZeroOnTheObstacleAndFarFromTheOrigin)
{
    const ObstacleMesh box = samples::box({1e6, 0, 0}, {1e6 + 1, 1, 1});
    const Obstacle obstacle = samples::make_obstacle(box);
    EXPECT_EQ(distance_to(obstacle, {1e6 + 0.5, 0.5, 1.0}, 1.0), 0.0);
    EXPECT_EQ(distance_to(obstacle, {1e6, 0, 0}, 1.0), 0.0);
    EXPECT_NEAR(distance_to(obstacle, {1e6 + 0.5, 0.5, 1.001}, 1.0), 0.001, 1e-9);
    EXPECT_NEAR(distance_to(obstacle, {1e6 + 0.5, 0.5, 0.999}, 1.0), 0.001, 1e-9) << "inside";
}

}  // namespace
}  // namespace arris
