// SPDX-License-Identifier: GPL-3.0-or-later
// Cloth on obstacles that deform, against closed forms and against the same motion of a rigid obstacle.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "deforming_cloth.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "geometry/surgery/initial_target.h"
#include "grid_patterns.h"
#include "solver/contact/audit.h"

namespace arris {
namespace {

constexpr double kThickness = 1e-3;  // m

Vec3 mean_velocity(const ClothRun& run)
{
    Vec3 sum = Vec3::Zero();
    for (const Vec3& v : run.state.velocity) sum += v;
    return sum / static_cast<double>(run.state.velocity.size());
}

/// A sheet on a box that turns and moves, with friction.
ClothRun make_box_run(MovingObstacle box, bool has_eol)
{
    Scene scene = make_deforming_scene(kThickness);
    scene.friction = Friction{{0.3}};
    scene.obstacles.push_back(std::move(box));
    ClothMesh mesh = make_sheet({0.4, 0.4}, {8, 8}, GridPattern::Cross);
    lay(mesh, Vec3(-0.2, -0.2, 0.05 + kThickness));
    if (has_eol) scene.eol = make_initial_target(mesh);
    return ClothRun(std::move(scene), std::move(mesh));
}

TEST(DeformingObstacle, CarriesClothAsARigidOneWithTheSameMotion)
{
    // m. Rounding grows tenfold in some five steps, and more where a vertex begins to slide or a trace
    // changes: from 1e-12 to 1e-10 in 16 steps, and by chance to between 1e-9 and 1e-7 in 40.
    constexpr double kRounding = 1e-9, kGrown = 1e-3 * kThickness;
    constexpr int kEarly = 16;
    RigidMotion motion;
    motion.velocity = Vec3(0.2, 0.0, 0.1);
    motion.angular_velocity = Vec3(0.0, 0.3, 2.0);
    const ObstacleMesh box = make_box({0.3, 0.3, 0.1});
    const auto place = [&](const Vec3& rest, double time) { return motion.at(time)(rest); };
    const auto velocity = [&](const Vec3& rest, double time) {
        return motion.velocity_after(time, motion.at(time)(rest));
    };
    for (const bool has_eol : {false, true}) {
        ClothRun rigid = make_box_run(MovingObstacle("it", box, {}, motion, 30.0), has_eol);
        ClothRun deforming = make_box_run(make_deforming(box, place, velocity), has_eol);
        double largest = 0.0;
        for (int k = 0; k < 40; ++k) {
            rigid.advance(0.005);
            deforming.advance(0.005);
            ASSERT_EQ(rigid.state.ids, deforming.state.ids);
            ASSERT_EQ(rigid.state.eol.size(), deforming.state.eol.size());
            for (std::size_t v = 0; v < rigid.state.mesh.world.size(); ++v)
                largest =
                    std::max(largest, (rigid.state.mesh.world[v] - deforming.state.mesh.world[v]).norm());
            ASSERT_LT(largest, k < kEarly ? kRounding : kGrown) << has_eol << ", step " << k;
        }
        EXPECT_EQ(rigid.state.eol.empty(), !has_eol);
    }
}

/// A floor that stretches, x = (1 + e t) X, drags a strip of width w: its middle x_c gains
/// mu g clip(2 (x_c - v / E) / w, -1, 1), E = e / (1 + e t).
TEST(DeformingObstacle, FloorThatStretchesDragsAStrip)
{
    constexpr double kRate = 1.0, kFriction = 0.3, kWidth = 0.1;
    Scene scene = make_deforming_scene(kThickness);
    scene.materials[0].youngs_modulus = 2e5;
    scene.friction = Friction{{kFriction}};
    const ObstacleMesh floor = {
        {{-1, -1, 0}, {2, -1, 0}, {2, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}, {}, {}};
    const auto stretch = [](const Vec3& rest, double time) {
        return Vec3((1.0 + kRate * time) * rest.x(), rest.y(), rest.z());
    };
    const auto velocity = [](const Vec3& rest, double) { return Vec3(kRate * rest.x(), 0.0, 0.0); };
    scene.obstacles.push_back(make_deforming(floor, stretch, velocity));
    ClothMesh mesh = make_sheet({kWidth, 0.05}, {20, 4}, GridPattern::Cross);
    lay(mesh, Vec3(0.5 - 0.5 * kWidth, -0.025, kThickness));
    ClothRun run(std::move(scene), std::move(mesh));
    run.advance(0.1, 0.0025);
    EXPECT_NEAR(mean_velocity(run).x(), 0.2943, 1e-3);
    run.advance(0.2, 0.0025);
    EXPECT_NEAR(mean_velocity(run).x(), 0.4632, 1e-3);
    EXPECT_NEAR(mean_velocity(run).y(), 0.0, 1e-5);
}

/// Cloth that is stuck to a floor that bends to and fro stays at its place.
TEST(DeformingObstacle, FloorThatBendsKeepsClothThatSticks)
{
    constexpr double kPeriod = 0.2, kMost = 0.5;  // rad over a metre
    constexpr double kWave = 2.0 * M_PI / kPeriod;
    ObstacleMesh floor;
    constexpr int kCells = 20;
    for (int i = 0; i <= kCells; ++i)
        for (const double y : {-0.5, 0.5}) floor.points.push_back(Vec3(-0.5 + i / double{kCells}, y, 0.0));
    for (int i = 0; i < kCells; ++i) {
        floor.faces.push_back({2 * i, 2 * i + 2, 2 * i + 3});
        floor.faces.push_back({2 * i, 2 * i + 3, 2 * i + 1});
    }
    const auto height = [](double x) { return 0.5 * kMost * x * x; };
    const auto bend = [&](const Vec3& rest, double time) {
        return Vec3(rest.x(), rest.y(), height(rest.x()) * std::sin(kWave * time));
    };
    const auto velocity = [&](const Vec3& rest, double time) {
        return Vec3(0.0, 0.0, height(rest.x()) * kWave * std::cos(kWave * time));
    };
    Scene scene = make_deforming_scene(kThickness);
    scene.materials[0].youngs_modulus = 20.0;  // N/m: stiffer cloth would slip rather than stretch
    scene.friction = Friction{{0.8}};
    scene.obstacles.push_back(make_deforming(floor, bend, velocity));
    ClothMesh mesh = make_sheet({0.2, 0.2}, {5, 5}, GridPattern::Cross);
    lay(mesh, Vec3(-0.08, -0.1, kThickness));
    ClothRun run(std::move(scene), std::move(mesh));
    const auto middle = [&] {
        Vec3 sum = Vec3::Zero();
        for (const Vec3& x : run.state.mesh.world) sum += x;
        return Vec3(sum / static_cast<double>(run.state.mesh.world.size()));
    };
    run.advance(20.0 * kPeriod, 0.01);  // in which what slips at the border has found its place
    const Vec3 first = middle();
    run.advance(100.0 * kPeriod, 0.01);
    EXPECT_LT((middle() - first).norm(), 1e-6);
    EXPECT_TRUE(find_penetrations(run.scene, run.state).empty());
}

/// A sheet that slides over the edge of a table whose points move along that edge with the strain `rate` t.
ClothRun make_stretched_table_run(double rate)
{
    const ObstacleMesh table = make_box({0.4, 1.0, 0.1});
    Scene scene = make_deforming_scene(kThickness);
    scene.obstacles.push_back(make_deforming(
        table,
        [rate](const Vec3& rest, double time) {
            return Vec3(rest.x(), (1.0 + rate * time) * rest.y(), rest.z());
        },
        [rate](const Vec3& rest, double) { return Vec3(0.0, rate * rest.y(), 0.0); }));
    ClothMesh mesh = make_sheet({0.4, 0.2}, {8, 4}, GridPattern::Cross);
    lay(mesh, Vec3(0.0, 0.1, 0.05 + kThickness));
    scene.eol = make_initial_target(mesh);
    return ClothRun(std::move(scene), std::move(mesh));
}

TEST(DeformingObstacle, EdgeThatStretchesDoesNotDragClothAlong)
{
    constexpr double kDuration = 0.15, kRounding = 1e-9;
    ClothRun resting = make_stretched_table_run(0.0), stretching = make_stretched_table_run(2.0);
    resting.advance(kDuration, 0.005);
    stretching.advance(kDuration, 0.005);
    EXPECT_EQ(stretching.state.eol.size(), 5u);
    ASSERT_EQ(resting.state.ids, stretching.state.ids);
    for (std::size_t v = 0; v < resting.state.mesh.world.size(); ++v)
        EXPECT_LT((resting.state.mesh.world[v] - stretching.state.mesh.world[v]).norm(), kRounding);
}

/// A roof whose ridge gets sharper and blunter than `feature_angle` under a cloth: the trace on it appears
/// once and stays.
TEST(DeformingObstacle, TraceOnAnEdgeThatSharpensDoesNotFlicker)
{
    constexpr double kWave = 2.0 * M_PI;  // 1/s: swings from 20 to 70 degrees and back, from 45 on
    const auto slope = [](double time) { return (22.5 + 12.5 * std::sin(kWave * time)) * M_PI / 180.0; };
    const ObstacleMesh roof = {
        {{-0.3, -0.3, 0}, {0, -0.3, 0}, {0.3, -0.3, 0}, {-0.3, 0.3, 0}, {0, 0.3, 0}, {0.3, 0.3, 0}},
        {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}},
        {},
        {}};
    const auto fold = [&](const Vec3& rest, double time) {
        return Vec3(rest.x() * std::cos(slope(time)), rest.y(), -std::abs(rest.x()) * std::sin(slope(time)));
    };
    const auto velocity = [&](const Vec3& rest, double time) {
        const double rate = 12.5 * M_PI / 180.0 * kWave * std::cos(kWave * time);
        return Vec3(-rate * rest.x() * std::sin(slope(time)), 0.0,
                    -rate * std::abs(rest.x()) * std::cos(slope(time)));
    };
    Scene scene = make_deforming_scene(kThickness);
    scene.friction = Friction{{0.5}};
    const auto deformation = std::make_shared<FormulaDeformation>(
        roof.points, fold, velocity, std::vector<double>{0.0, 0.25, 0.5, 0.75, 1.0});
    scene.obstacles.push_back(MovingObstacle("roof", roof, {}, {}, 45.0, deformation));
    ClothMesh mesh = make_sheet({0.3, 0.2}, {9, 6}, GridPattern::Cross);
    lay(mesh, Vec3(-0.16, -0.11, kThickness));
    scene.eol = make_initial_target(mesh);
    ClothRun run(std::move(scene), std::move(mesh));
    int appeared = 0, disappeared = 0;
    std::size_t before = 0;
    run.advance(2.0, 0.005, [&](const StepReport&) {
        const std::size_t now = run.state.eol.size();
        appeared += before == 0 && now > 0;
        disappeared += before > 0 && now == 0;
        before = now;
    });
    EXPECT_EQ(appeared, 1);
    EXPECT_EQ(disappeared, 0);
    EXPECT_GE(before, 5u);
    EXPECT_TRUE(find_penetrations(run.scene, run.state).empty());
}

/// A drum that turns by 30 degrees a step beside cloth at rest, 1.4 thicknesses away: steps in parts do not
/// take the arcs of its points for chords that would reach the cloth.
TEST(FastObstacle, DoesNotTouchClothBesideIt)
{
    constexpr double kRadius = 0.1, kStep = 0.005;
    constexpr int kSides = 360;
    ObstacleMesh drum;
    for (const double y : {-0.2, 0.2})
        for (int i = 0; i < kSides; ++i) {
            const double angle = 2.0 * M_PI * i / kSides;
            drum.points.push_back(Vec3(kRadius * std::cos(angle), y, kRadius * std::sin(angle)));
        }
    for (int i = 0; i < kSides; ++i) {
        const int j = (i + 1) % kSides;
        drum.faces.push_back({i, kSides + i, kSides + j});
        drum.faces.push_back({i, kSides + j, j});
    }
    RigidMotion motion;
    motion.angular_velocity = Vec3(0.0, M_PI / 6.0 / kStep, 0.0);
    const auto place = [&](const Vec3& rest, double time) { return motion.at(time)(rest); };
    const auto velocity = [&](const Vec3& rest, double time) {
        return motion.velocity_after(time, motion.at(time)(rest));
    };
    for (const bool is_deforming : {false, true}) {
        Scene scene = make_deforming_scene(kThickness);
        scene.gravity.reset();
        scene.obstacles.push_back(is_deforming ? make_deforming(drum, place, velocity)
                                               : MovingObstacle("drum", drum, {}, motion, 30.0));
        ClothMesh mesh = make_sheet({0.1, 0.1}, {4, 4}, GridPattern::Cross);
        lay(mesh, Vec3(-0.05, -0.05, kRadius + 1.4 * kThickness));
        const std::vector<Vec3> placed = mesh.world;
        ClothRun run(std::move(scene), std::move(mesh));
        run.advance(0.1, kStep, [&](const StepReport& report) {
            EXPECT_EQ(report.solves, 1) << "an attempt met the drum";
        });
        for (std::size_t v = 0; v < placed.size(); ++v)
            EXPECT_LT((run.state.mesh.world[v] - placed[v]).norm(), 1e-12) << is_deforming;
    }
}

}  // namespace
}  // namespace arris
