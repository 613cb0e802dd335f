// SPDX-License-Identifier: GPL-3.0-or-later
// Cloth in a press: plates that leave a gap g of less than two thicknesses t hold a pull of 2 mu A p, with
// the pressure p = E (1 - g / (2 t)).
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "geometry/surgery/initial_target.h"
#include "solver/advance.h"
#include "solver/step.h"

namespace arris {
namespace {

constexpr double kThickness = 1e-3, kSide = 0.1, kModulus = 200.0, kStep = 0.005;

/// A sheet between two large plates, which have closed after 0.05 s, and a pull on all of it from 0.1 s on.
struct Press {
    Scene scene;
    Settings settings;
    State state;
    Workspace work;
    int factorisations = 0, steps = 0;

    Press(double gap, int cells, double coefficient, double pull)
    {
        constexpr double kHeight = 0.05, kOpen = 1.5e-3, kClosing = 0.05;
        ClothGrid grid;
        grid.size = {kSide, kSide};
        grid.resolution = {cells, cells};
        grid.pattern = GridPattern::Cross;
        ClothMesh mesh = make_cloth_grid(grid);
        scene.materials[0] = {0.15, 500.0, 0.3, 1e-5, 0.0, kThickness};
        scene.materials[0].compression_modulus = kModulus;
        scene.friction.emplace();
        scene.friction->of_pieces = {coefficient};
        scene.pulls.push_back({.material = {Vec2(0.0, 0.0), Vec2(kSide, kSide)},
                               .force = Vec3(pull, 0.0, 0.0),
                               .start = 2.0 * kClosing});
        for (const double side : {-1.0, 1.0}) {
            RigidMotion motion;
            motion.velocity = Vec3(0.0, 0.0, -side * (kOpen - 0.5 * gap) / kClosing);
            motion.stop = kClosing;
            scene.obstacles.push_back(MovingObstacle(
                "plate", make_box({1.0, 1.0, kHeight}),
                {Mat3::Identity(), Vec3(0.05, 0.05, side * (0.5 * kHeight + kOpen))}, motion, 30.0));
        }
        state = make_state(scene, std::move(mesh), Vec3::Zero());
    }

    /// Distance, m, by which the sheet has moved along.
    double advance_to(double time)
    {
        while (state.time < time - 0.5 * kStep) {
            prepare(scene, state, work);
            const auto accept = [this](const StepReport& report, bool) {
                factorisations += report.factorisations;
                ++steps;
                return true;
            };
            EXPECT_FALSE(advance(scene, settings, state.time + kStep, state, work, accept));
            if (testing::Test::HasFailure()) break;
        }
        double sum = 0.0;
        for (std::size_t v = 0; v < state.mesh.world.size(); ++v)
            sum += state.mesh.world[v].x() - state.mesh.material[v].x();
        return sum / static_cast<double>(state.mesh.world.size());
    }
};

TEST(Press, HoldsUpToFrictionsShareOfItsPressure)
{
    constexpr double kMu = 0.5, kMargin = 0.02, kMass = 0.15 * kSide * kSide;
    for (const int cells : {3, 5, 8, 12})
        for (const double gap : {1.9e-3, 1.5e-3, 1.2e-3, 0.5e-3}) {
            const double hold = 2.0 * kMu * kSide * kSide * kModulus * (1.0 - gap / (2.0 * kThickness));
            SCOPED_TRACE(testing::Message() << cells << " cells, a gap of " << gap << " m");
            Press held(gap, cells, kMu, (1.0 - kMargin) * hold);
            EXPECT_LT(std::abs(held.advance_to(0.2)), 1e-6);
            EXPECT_LT(held.factorisations, 2 * held.steps);
            Press sliding(gap, cells, kMu, (1.0 + kMargin) * hold);
            const double way = 0.5 * kMargin * hold / kMass * 0.1 * 0.1;
            EXPECT_NEAR(sliding.advance_to(0.2), way, 0.1 * way);
        }
}

TEST(Press, HoldsNothingWithoutFriction)
{
    Press press(0.5e-3, 5, 0.0, 0.01);
    const double way = 0.5 * 0.01 / (0.15 * kSide * kSide) * 0.1 * 0.1;
    EXPECT_NEAR(press.advance_to(0.2), way, 0.1 * way);
}

TEST(Press, LeavesTheClothInTheMiddleOfItsGap)
{
    Press press(1.2e-3, 5, 0.3, 0.0);
    press.advance_to(0.2);
    for (const Vec3& x : press.state.mesh.world) EXPECT_NEAR(x.z(), 0.0, 1e-9);
}

/// A sheet that hangs from its pinned border between two boxes. They close to `gap` within 0.2 s; the pin
/// lets go at 0.3 s. Returns by how far the middle of the sheet has moved at `end` since then, m.
double fall_out_of_pinch(double gap, double coefficient, double end, int& steps)
{
    constexpr double kDepth = 0.05, kClosing = 0.2, kRelease = 0.3;
    ClothGrid grid;
    grid.size = {0.1, 0.15};
    grid.resolution = {4, 6};
    grid.pattern = GridPattern::Cross;
    ClothMesh mesh = make_cloth_grid(grid);
    for (Vec3& x : mesh.world) x = Vec3(x.x() - 0.05, 0.0, x.y() - 0.15);
    Scene scene;
    scene.materials[0] = {0.15, 500.0, 0.3, 1e-5, 0.002, kThickness};
    scene.gravity = Gravity{};
    if (coefficient > 0.0) scene.friction = Friction{{coefficient, coefficient}};
    Pin pin;
    pin.material = {Vec2(0.0, 0.15), Vec2(0.1, 0.15)};
    pin.release = kRelease;
    scene.pins = {pin};
    for (const double side : {-1.0, 1.0}) {
        RigidMotion motion;
        motion.velocity = Vec3(0.0, -side * 0.05, 0.0);
        motion.stop = kClosing;
        const double away = 0.5 * (kDepth + gap) + 0.05 * kClosing;
        scene.obstacles.push_back(MovingObstacle("box", make_box({0.2, kDepth, 0.06}),
                                                 {Mat3::Identity(), Vec3(0.0, side * away, -0.04)}, motion,
                                                 30.0));
    }
    scene.eol = make_initial_target(mesh);
    State state = make_state(scene, std::move(mesh), Vec3::Zero());
    Workspace work;
    const auto height = [&] {
        double sum = 0.0;
        for (const Vec3& x : state.mesh.world) sum += x.z();
        return sum / static_cast<double>(state.mesh.world.size());
    };
    double from = 0.0;
    while (state.time < end - 1e-9) {
        if (std::abs(state.time - kRelease) < 1e-9) {
            from = height();
            restart(state);
        }
        prepare(scene, state, work);
        const auto accept = [&](const StepReport&, bool) { return ++steps > 0; };
        if (advance(scene, Settings(), kStep * std::round(state.time / kStep + 1.0), state, work, accept)) {
            ADD_FAILURE() << "t = " << state.time;
            break;
        }
    }
    return from - height();
}

TEST(Pinch, HoldsASheetByFriction)
{
    int steps = 0;
    EXPECT_LT(std::abs(fall_out_of_pinch(1.5e-3, 1.0, 0.6, steps)), 1e-4);
    EXPECT_LT(steps, 150) << "120 planned";
}

TEST(Pinch, LetsASheetFallFreelyWithoutFriction)
{
    constexpr double kFall = 0.5 * 9.81 * 0.2 * 0.2;
    int steps = 0;
    EXPECT_NEAR(fall_out_of_pinch(1e-3, 0.0, 0.5, steps), kFall, 0.02 * kFall);
    EXPECT_LT(steps, 150) << "100 planned";
}

/// Runs a sheet that lies in a V of two plates, which fold up to `degrees` from 30. Returns the steps made.
int close_vee(double degrees, int cells)
{
    ClothGrid grid;
    grid.size = {0.3, 0.2};
    grid.resolution = {cells, 2 * cells / 3};
    grid.pattern = GridPattern::Cross;
    ClothMesh mesh = make_cloth_grid(grid);
    for (Vec3& x : mesh.world) x += Vec3(-0.15, -0.1, 0.095);
    Scene scene;
    scene.materials[0] = {0.15, 500.0, 0.3, 1e-5, 0.003, kThickness};
    scene.gravity = Gravity{};
    for (const double side : {1.0, -1.0}) {
        RigidMotion motion;
        motion.angular_velocity = Vec3(0.0, -side * (degrees - 30.0) * M_PI / 180.0 / 0.4, 0.0);
        motion.start = 0.4;
        motion.stop = 0.8;
        const Mat3 turn = Eigen::AngleAxisd(-side * M_PI / 6.0, Vec3::UnitY()).toRotationMatrix();
        scene.obstacles.push_back(MovingObstacle("plate", make_box({0.3, 0.4, 0.02}),
                                                 {turn, Vec3(side * 0.134904, 0.0, 0.066340)}, motion, 30.0));
    }
    scene.eol = make_initial_target(mesh);
    State state = make_state(scene, std::move(mesh), Vec3::Zero());
    Workspace work;
    int steps = 0;
    while (state.time < 1.0 - 1e-9) {
        for (const double jump : {0.4, 0.8})
            if (std::abs(state.time - jump) < 1e-9) restart(state);
        prepare(scene, state, work);
        const auto accept = [&](const StepReport&, bool) { return ++steps > 0; };
        if (advance(scene, Settings(), kStep * std::round(state.time / kStep + 1.0), state, work, accept)) {
            ADD_FAILURE() << degrees << " degrees, " << cells << " cells, t = " << state.time;
            break;
        }
    }
    return steps;
}

TEST(Vee, LetsClothMoveUpItsClosingCrease)
{
    for (const double degrees : {75.0, 78.0, 80.0})
        for (const int cells : {6, 12}) EXPECT_LT(close_vee(degrees, cells), 400) << degrees << ", " << cells;
}

}  // namespace
}  // namespace arris
