// SPDX-License-Identifier: GPL-3.0-or-later
// Steps of cloth on real obstacles: nothing passes, nothing sticks that should slide, nothing gains energy.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/cloth_grid.h"
#include "geometry/obstacle_shapes.h"
#include "geometry/penetration.h"
#include "physics/inertia.h"
#include "solver/step.h"
#include "tests/solver/floor.h"

namespace arris {
namespace {

constexpr double kStep = 0.005;  // s

ClothMesh make_sheet(double size, int cells, const Placement& place)
{
    ClothGrid grid;
    grid.size = {size, size};
    grid.resolution = {cells, cells};
    grid.pattern = GridPattern::Cross;
    ClothMesh mesh = make_cloth_grid(grid);
    for (Vec3& x : mesh.world) x = place(x - Vec3(0.5 * size, 0.5 * size, 0.0));
    return mesh;
}

Obstacle place(ObstacleMesh mesh, const Vec3& at = Vec3::Zero(), RigidMotion motion = {})
{
    return Obstacle("it", std::move(mesh), {Mat3::Identity(), at}, std::move(motion), 30.0);
}

/// A cloth on obstacles, each of whose steps is checked by the classification that knows nothing of the step.
struct ObstacleRun {
    Scene scene;
    Settings settings;
    State state;
    Workspace work;
    int rewound = 0, yielded = 0, most_solves = 0;

    ObstacleRun(std::vector<Obstacle> obstacles, ClothMesh mesh, const Vec3& velocity = Vec3::Zero(),
                bool has_gravity = true)
    {
        scene.material = {0.05, 50.0, 0.3, 1e-5, 0.0, 1e-3};
        if (has_gravity) scene.gravity = Gravity{};
        scene.obstacles = std::move(obstacles);
        state = make_state(scene, std::move(mesh), velocity);
    }

    /// As a run does: where a step fails its rest is done in twice as many parts; at last with the last
    /// resort.
    StepStatus advance(double dt = kStep)
    {
        const double end = state.time + dt;
        for (int parts = 1, left = 1; state.time < end;) {
            const double part_end = left == 1 ? end : state.time + (end - state.time) / left;
            const StepReport report =
                step(scene, settings, part_end, state, work, parts < 64 ? Attempt::Ordinary : Attempt::Last);
            if (report.status != StepStatus::Done) {
                if (parts == 64) return report.status;
                parts *= 2;
                left *= 2;
                continue;
            }
            rewound += report.rewound;
            yielded += report.yielded;
            most_solves = std::max(most_solves, report.solves);
            left = std::max(left - 1, 1);
            for (const Obstacle& obstacle : scene.obstacles) expect_free(obstacle);
        }
        return StepStatus::Done;
    }

    void advance_all(int steps)
    {
        for (int k = 0; k < steps && !testing::Test::HasFailure(); ++k)
            ASSERT_EQ(advance(), StepStatus::Done) << "t = " << state.time;
    }

    void expect_free(const Obstacle& obstacle) const
    {
        std::vector<Vec3> positions;
        for (const Vec3& x : state.mesh.world) positions.push_back(obstacle.at(state.time).inverse(x));
        const Penetration found = find_penetration(obstacle, positions, state.mesh.faces);
        EXPECT_FALSE(found.is_any()) << obstacle.name() << " in face " << found.face
                                     << " at t = " << state.time;
    }

    double kinetic() const { return kinetic_energy(scene.material.density, work.elements, state.velocity); }
    Vec3 centre() const
    {
        Vec3 sum = Vec3::Zero();
        for (const Vec3& x : state.mesh.world) sum += x;
        return sum / static_cast<double>(state.mesh.world.size());
    }
};

/// Cloth thrown down on something small or thin with one of its vertices, edges or faces above the middle.
class Fall : public testing::TestWithParam<double> {};

TEST_P(Fall, OnAThinPlateStopsAboveIt)
{
    for (const double offset : {0.0, 0.013}) {
        ObstacleRun run({place(make_box({0.8, 0.8, 1e-3}))},
                        make_sheet(0.6, 12, {rotation_about(Vec3::UnitZ(), 20), Vec3(offset, 0, 0.07)}),
                        Vec3(0, 0, -GetParam()));
        run.advance_all(30);
        for (const Vec3& x : run.state.mesh.world) EXPECT_GT(x.z(), 0.0);
        EXPECT_EQ(run.rewound, 0);
    }
}

TEST_P(Fall, OnAWireHangsOnIt)
{
    for (const double offset : {0.0, 0.011}) {
        ObstacleRun run({place(make_wire({{0, -1, 0}, {0, 1, 0}}, false))},
                        make_sheet(0.6, 12, {rotation_about(Vec3::UnitZ(), 20), Vec3(offset, 0, 0.07)}),
                        Vec3(0, 0, -GetParam()));
        run.advance_all(25);
        // It still goes over the wire, all along it: without it, it would be far below.
        for (const double y : {-0.1, -0.05, 0.0, 0.05, 0.1}) {
            double highest = -1e9;
            for (const Vec3& x : run.state.mesh.world)
                if (std::abs(x.y() - y) < 0.05) highest = std::max(highest, x.z());
            EXPECT_GT(highest, -0.02) << "at y = " << y;
        }
        EXPECT_EQ(run.rewound, 0);
    }
}

TEST_P(Fall, OnANailIsHeldByIt)
{
    for (const Vec3& nail :
         {Vec3(0, 0, 0), Vec3(0.017, 0.0, 0), Vec3(0.012, 0.009, 0)}) {  // vertex, edge, face
        ObstacleRun run({place(make_points({nail}))},
                        make_sheet(0.6, 12, {Mat3::Identity(), Vec3(0, 0, 0.07)}), Vec3(0, 0, -GetParam()));
        run.advance_all(15);
        // The column of cloth over the nail has not gone through: some cloth stays at its height.
        double highest = -1e9;
        for (const Vec3& x : run.state.mesh.world) highest = std::max(highest, x.z());
        EXPECT_GT(highest, -0.03);
        EXPECT_EQ(run.rewound, 0);
    }
}

INSTANTIATE_TEST_SUITE_P(Speeds, Fall, testing::Values(2.0, 5.0, 20.0));

TEST(ConvexEdge, ABorderAlongItCanBePulledBothWays)
{
    for (const double force : {-0.02, 0.02})
        for (const double height : {1e-3, 1.5e-3}) {
            // The cloth lies on the box's top; its border is exactly above the box's edge x = 0.
            ObstacleRun run({place(make_box({1, 1, 0.2}), {-0.5, 0, -0.1})},
                            make_sheet(0.4, 8, {Mat3::Identity(), Vec3(-0.2, 0, height)}), Vec3::Zero(),
                            false);
            Pull pull;
            pull.material = {Vec2(0, 0), Vec2(0.4, 0.4)};
            pull.force = Vec3(force, 0, 0);
            run.scene.pulls = {pull};
            run.settings.integrator = Integrator::ImplicitEuler;
            const double mass = 0.05 * 0.16, before = run.centre().x();
            run.advance_all(20);
            const double t = 20 * kStep;
            EXPECT_NEAR(run.centre().x() - before, 0.5 * force / mass * t * (t + kStep), 1e-9);
        }
}

TEST(Hollow, ClothInAClosedBoxStaysInIt)
{
    // Walls 5 cm thick: an outer shell and a cavity.
    ObstacleMesh hollow = make_box({0.6, 0.6, 0.6});
    const ObstacleMesh cavity = make_box({0.5, 0.5, 0.5});
    for (const Face& f : cavity.faces) hollow.faces.push_back({f[0] + 8, f[2] + 8, f[1] + 8});
    hollow.points.insert(hollow.points.end(), cavity.points.begin(), cavity.points.end());
    RigidMotion shake;
    shake.angular_velocity = Vec3(5, 0, 0);
    shake.velocity = Vec3(0.3, 0, 0);
    ObstacleRun run({place(hollow, Vec3::Zero(), shake)},
                    make_sheet(0.48, 8, {rotation_about(Vec3(1, 1, 0), 8), Vec3(0, 0, 0)}));
    run.advance_all(200);
    for (const Vec3& x : run.state.mesh.world)
        EXPECT_LT((run.scene.obstacles[0].at(run.state.time).inverse(x)).cwiseAbs().maxCoeff(), 0.25);
}

TEST(Fin, ClothHangsOnBothSidesOfIt)
{
    ObstacleRun run({place(make_box({0.002, 1.0, 0.4}), {0, 0, -0.2})},
                    make_sheet(0.5, 10, {rotation_about(Vec3::UnitZ(), 15), Vec3(0.02, 0, 0.01)}));
    run.advance_all(80);
    double left = 0, right = 0;
    for (const Vec3& x : run.state.mesh.world) {
        left = std::min(left, x.x());
        right = std::max(right, x.x());
    }
    EXPECT_LT(run.centre().z(), -0.02);
    EXPECT_LT(left, -0.01);
    EXPECT_GT(right, 0.01);
}

TEST(Crush, AGapOfLessThanTwoStandOffsYields)
{
    // A lid comes down on cloth on a floor and stops 1.2 mm above it.
    RigidMotion down;
    down.velocity = Vec3(0, 0, -0.1);
    down.stop = 0.1;
    ObstacleRun run({make_floor(), place(make_box({0.5, 0.5, 0.1}), {0, 0, 0.0612}, down)},
                    make_sheet(0.3, 6, {Mat3::Identity(), Vec3(0, 0, 1e-3)}));
    run.advance_all(40);
    for (const Vec3& x : run.state.mesh.world) {
        EXPECT_GT(x.z(), 0.0);
        EXPECT_LT(x.z(), 0.0012);
    }
}

TEST(Crush, AGapBelowZeroIsInfeasibleAndNamesAVertex)
{
    RigidMotion down;
    down.velocity = Vec3(0, 0, -0.1);
    ObstacleRun run({make_floor(), place(make_box({0.5, 0.5, 0.1}), {0, 0, 0.06}, down)},
                    make_sheet(0.3, 6, {Mat3::Identity(), Vec3(0, 0, 1e-3)}));
    StepStatus status = StepStatus::Done;
    for (int k = 0; k < 40 && status == StepStatus::Done; ++k) status = run.advance();
    EXPECT_EQ(status, StepStatus::Infeasible);
    EXPECT_GT(run.state.time, 0.08) << "it yielded as far as there was room";
}

TEST(MovingObstacle, CarriesClothWithoutPushingEnergyIn)
{
    // A box that rises, stops, and sinks more slowly than cloth falls.
    RigidMotion motion;
    motion.keyframes = {{0.0, {0, 0, 0}, Eigen::Quaterniond::Identity()},
                        {0.1, {0, 0, 0}, Eigen::Quaterniond::Identity()},
                        {0.3, {0, 0, 0.2}, Eigen::Quaterniond::Identity()},
                        {0.5, {0, 0, 0.2}, Eigen::Quaterniond::Identity()},
                        {0.9, {0, 0, 0.1}, Eigen::Quaterniond::Identity()}};
    ObstacleMesh box = make_box({1, 1, 0.2});
    for (Vec3& p : box.points) p.z() -= 0.1;
    ObstacleRun run({Obstacle("lift", box, {}, motion, 30.0)},
                    make_sheet(0.4, 8, {Mat3::Identity(), Vec3(0, 0, 1e-3)}));
    for (int k = 0; k < 200; ++k) {
        const double t = run.state.time;
        for (const double jump : motion.jumps())
            if (std::abs(t - jump) < 1e-9) restart(run.state);
        ASSERT_EQ(run.advance(), StepStatus::Done);
        const double top = motion.at(run.state.time).translation.z();
        for (const Vec3& x : run.state.mesh.world) {
            ASSERT_GT(x.z() - top, 1e-3 - 1e-12);
            ASSERT_TRUE(run.state.time > 0.2999 || x.z() - top < 1e-3 + 1e-9) << run.state.time;
        }
        const bool is_rising = run.state.time > 0.15 && run.state.time < 0.2999;
        ASSERT_TRUE(!is_rising || std::abs(run.kinetic() - 0.5 * 0.05 * 0.16) < 1e-9);
    }
}

TEST(Pin, FollowsAnObstacle)
{
    RigidMotion turn;
    turn.angular_velocity = Vec3(0, 0, 3);
    turn.velocity = Vec3(0.2, 0, 0);
    Scene scene;
    scene.material = {0.05, 50.0, 0.3, 1e-5, 0.0, 1e-3};
    scene.obstacles.push_back(place(make_box({0.1, 0.1, 0.1}), {0.3, 0.2, 0.1}, turn));
    Pin pin;
    pin.material = {Vec2(0, 0), Vec2(0, 1)};
    pin.follows = 0;
    scene.pins = {pin};
    State state = make_state(scene, make_sheet(0.4, 4, {Mat3::Identity(), Vec3(0, 0, -0.3)}), Vec3::Zero());
    const ClothMesh first = state.mesh;
    Workspace work;
    for (int k = 1; k <= 60; ++k)
        ASSERT_EQ(step(scene, Settings(), kStep * k, state, work).status, StepStatus::Done);
    const Placement moved = scene.obstacles[0].at(state.time) * scene.obstacles[0].at(0.0).inverse();
    for (const int v : vertices_in_box(first, pin.material))
        EXPECT_NEAR((state.mesh.world[v] - moved(first.world[v])).norm(), 0.0, 1e-13);
    EXPECT_EQ(input_jumps(scene), std::vector<double>()) << "it never starts or stops after time 0";
}

}  // namespace
}  // namespace arris
