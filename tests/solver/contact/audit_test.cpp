// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/contact/audit.h"

#include <gtest/gtest.h>

#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "solver/step.h"

namespace arris {
namespace {

/// A level cloth 0.4 m wide at `height`, and two boxes of which the second moves.
struct Laid {
    Scene scene;
    State state;

    explicit Laid(double height)
    {
        RigidMotion motion;
        motion.velocity = Vec3(0, 0, -1.0);
        const Placement far{Mat3::Identity(), Vec3(0.1, 0.1, 1.0)};
        scene.obstacles.emplace_back("table", make_box({2, 2, 0.2}), Placement(), RigidMotion(), 30.0);
        scene.obstacles.emplace_back("lid", make_box({0.1, 0.1, 0.2}), far, motion, 30.0);
        ClothGrid grid;
        grid.size = {0.4, 0.4};
        grid.resolution = {3, 3};
        ClothMesh mesh = make_cloth_grid(grid);
        for (Vec3& x : mesh.world) x.z() = height;
        state = make_state(scene, std::move(mesh), Vec3::Zero());
    }
};

TEST(Audit, FreeClothHasNone)
{
    EXPECT_EQ(audit(Laid(0.11).scene, Laid(0.11).state.mesh, 0.0).obstacle, -1);
}

TEST(Audit, FindsTheObstacleTheClothIsDeepestIn)
{
    Laid laid(0.09);  // 1 cm inside the table
    const Audit first = audit(laid.scene, laid.state.mesh, laid.state.time);
    EXPECT_EQ(first.obstacle, 0);
    EXPECT_NEAR(first.found.depth, 0.01, 1e-4);
    laid.state.time = 0.875;  // the lid reaches from 0.025 to 0.225, so its sides are 0.05 m from the cloth
    const Audit second = audit(laid.scene, laid.state.mesh, laid.state.time);
    EXPECT_EQ(second.obstacle, 1);
    EXPECT_NEAR(second.found.depth, 0.05, 1e-3);
    EXPECT_NEAR(second.found.place.z(), 0.09, 1e-9) << "in the world";
}

}  // namespace
}  // namespace arris
