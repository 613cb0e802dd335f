// SPDX-License-Identifier: GPL-3.0-or-later
// A wire turns and moves across cloth that hangs over it, past a box a little lower. The fold plane behind
// the wire, which keeps the cloth's two sides apart, moves with the wire and presses cloth against the box.
// Nothing solid is at the plane, so its contact must yield. A plane that does not yield adds a multiple of
// the cloth's kinetic energy in one step.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "cloth_run.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "geometry/surgery/initial_target.h"

namespace arris {
namespace {

constexpr double kWidth = 1.0, kDensity = 0.05;  // m, kg/m^2
constexpr double kSpeed = 1.0, kTurnsBy = 1.0;   // m/s, rad/s: of the wire

/// Largest energy gain of the cloth in a step, J.
double pass_box(int cells, double duration)
{
    constexpr double kStep = 0.005;
    ClothMesh mesh = make_sheet(Vec2(kWidth, kWidth), {cells, cells}, GridPattern::Cross);
    const Eigen::Rotation2Dd turn(5.0 * M_PI / 180.0);
    for (Vec3& x : mesh.world) x << turn * Vec2(x.x() - 0.5, x.y() - 0.5), 0.01;
    Scene scene;
    scene.materials[0] = {kDensity, 200.0, 0.01, 1e-5, 0.0, 1e-3};
    scene.gravity = Gravity{};
    RigidMotion passing;
    passing.velocity = Vec3(0.0, -kSpeed, 0.0);
    passing.angular_velocity = kTurnsBy * Vec3::UnitZ();
    passing.start = 0.1;
    scene.obstacles.push_back(
        MovingObstacle("wire", make_wire({{-0.8, 0.1, 0.0}, {0.8, 0.1, 0.0}}, false), {}, passing, 30.0));
    scene.obstacles.push_back(MovingObstacle("box", make_box({0.4, 0.4, 0.2}),
                                             {Mat3::Identity(), Vec3(0.0, -0.3, -0.115)}, {}, 30.0));
    scene.eol = make_initial_target(mesh);
    ClothRun run(std::move(scene), std::move(mesh));
    double before = std::numeric_limits<double>::infinity(), most = 0.0;
    run.advance(duration, kStep, [&](const StepReport&) {
        const double energy = measure_energy(run).sum();
        most = std::max(most, energy - before);
        before = energy;
    });
    EXPECT_EQ(run.state.crossings, 0) << cells;
    return most;
}

TEST(PassingWire, PressesNoClothAgainstABoxByThePlaneBehindItsFold)
{
    // In one step the wire can at most bring all of the cloth from rest to the wire's greatest speed below
    // the cloth, which is at a corner of the cloth. A plane that does not yield adds 1.6 J with 14 cells.
    const double fastest = kSpeed + kTurnsBy * kWidth * std::numbers::sqrt2 / 2.0;
    const double driven = 0.5 * kDensity * kWidth * kWidth * fastest * fastest;
    for (const auto& [cells, duration] : {std::pair(14, 0.32), {18, 0.36}}) {
        const double gain = pass_box(cells, duration);
        RecordProperty("gain_" + std::to_string(cells), std::to_string(gain));
        EXPECT_LT(gain, driven) << cells;
    }
}

}  // namespace
}  // namespace arris
