// SPDX-License-Identifier: GPL-3.0-or-later
// Contact of cloth with itself: layers at rest, impacts, folds, friction between layers.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "cloth_pieces.h"
#include "cloth_run.h"
#include "grid_patterns.h"
#include "solver/contact/audit.h"
#include "tests/solver/floor.h"

namespace arris {
namespace {

constexpr double kG = 9.81, kThickness = 1e-3, kStep = 0.005;

Material make_material(double damping = 0.0)
{
    return {0.15, 500.0, 0.3, 1e-5, damping, kThickness};
}

ClothMesh make_square(int cells, GridPattern pattern)
{
    return make_sheet({0.3, 0.3}, {cells, cells}, pattern);
}

/// Mean velocity by mass.
Vec3 mean_velocity(const State& state)
{
    Vec3 sum = Vec3::Zero();
    double area = 0.0;
    for (const Face& face : state.mesh.faces) {
        const std::vector<Vec2>& X = state.mesh.material;
        const double own = twice_area(X[face[0]], X[face[1]], X[face[2]]);
        for (const int v : face) sum += own / 3.0 * state.velocity[v];
        area += own;
    }
    return sum / area;
}

bool crosses_itself(const ClothRun& run)
{
    return find_self_crossings(run.scene, run.state.mesh).count > 0;
}

TEST(SelfContactAtRest, PilesKeepTheirThicknessAndBecomeStill)
{
    for (const int sheets : {2, 5}) {
        Scene scene;
        scene.materials[0] = make_material(0.05);
        scene.gravity = Gravity{{0.0, 0.0, -kG}};
        scene.obstacles.push_back(make_floor());
        scene.self_contact = ClothContact{kThickness};
        ClothMesh pile;
        for (int k = 0; k < sheets; ++k)
            add_piece(make_sheet({0.3 - 0.02 * k, 0.3 - 0.02 * k}, {4, 4}, kPatterns[k % kPatterns.size()]),
                      {0.01 * k, 0.01 * k, (k + 1) * 1.2e-3}, 0.0, pile);
        ClothRun run(std::move(scene), pile);
        run.advance(1.0, kStep);
        double highest = 0.0;
        for (const Vec3& x : run.state.mesh.world) highest = std::max(highest, x.z());
        EXPECT_NEAR(highest, sheets * kThickness, 1e-6) << sheets;
        EXPECT_LT(measure_energy(run).kinetic, 1e-12) << sheets;
        EXPECT_FALSE(crosses_itself(run));
    }
}

TEST(SelfContactImpact, OfTwoSheetsKeepsMomentumAndDoesNotRebound)
{
    constexpr double kSpeed = 1.0;
    for (int phase = 0; phase < 20; ++phase) {
        Scene scene;
        scene.materials[0] = make_material();
        scene.self_contact = ClothContact{kThickness};
        ClothMesh cloth;
        add_piece(make_square(4, GridPattern::Diagonal), Vec3::Zero(), 0.0, cloth);
        const int first = cloth.vertex_count();
        const double gap = 0.01 + kSpeed * kStep * phase / 20.0;
        add_piece(make_square(4, GridPattern::Diagonal), {0.0, 0.0, gap}, 0.0, cloth);
        ClothRun run(std::move(scene), cloth);
        for (int v = first; v < cloth.vertex_count(); ++v) run.state.velocity[v] = {0.0, 0.0, -kSpeed};
        run.advance(0.05, kStep);
        // Both sheets have the same mass: after the impact each moves at half the speed.
        const Vec3 mean = mean_velocity(run.state);
        double rebound = 0.0;
        for (std::size_t v = 0; v < run.state.velocity.size(); ++v) {
            const double own = run.state.velocity[v].z() + 0.5 * kSpeed;
            rebound = std::max(rebound, static_cast<int>(v) < first ? -own : own);
        }
        EXPECT_NEAR(mean.z(), -0.5 * kSpeed, 1e-12) << phase;
        EXPECT_LT(rebound, 0.01 * kSpeed) << phase;
        EXPECT_FALSE(crosses_itself(run)) << phase;
    }
}

/// A sheet on another one, which is pinned on a slope.
TEST(SelfContactFriction, BetweenLayersObeysCoulombsLaw)
{
    constexpr double kDuration = 0.1, kFriction = 0.3;
    for (const double degrees : {10.0, 25.0}) {
        const double slope = degrees * std::numbers::pi / 180.0;
        Scene scene;
        scene.materials[0] = make_material();
        scene.gravity = Gravity{kG * Vec3(std::sin(slope), 0.0, -std::cos(slope))};
        scene.self_contact = ClothContact{kThickness};
        scene.friction = Friction{.of_pieces = {0.0}, .of_obstacles = {}, .between_layers = kFriction};
        scene.pins.push_back({.material = {{0.0, 0.0}, {0.3, 0.3}}, .motion = {}});
        ClothMesh cloth;
        add_piece(make_square(6, GridPattern::Cross), Vec3::Zero(), 0.0, cloth);
        const int first = cloth.vertex_count();
        add_piece(make_sheet({0.1, 0.1}, {2, 2}, GridPattern::Diagonal), {0.08, 0.11, kThickness}, 5.0,
                  cloth);
        ClothRun run(std::move(scene), cloth);
        run.advance(kDuration, kStep);
        Vec3 mean = Vec3::Zero();
        const int n = cloth.vertex_count() - first;
        for (int v = first; v < cloth.vertex_count(); ++v) mean += run.state.velocity[v] / n;
        const double slides = kG * std::max(0.0, std::sin(slope) - kFriction * std::cos(slope));
        EXPECT_NEAR(mean.x() / kDuration, slides, 2e-3 * kG) << degrees;
    }
}

// Hundreds of contacts change between sticking and sliding as one sheet after the other lands.
TEST(SelfContactFriction, OfAStackThatLandsTakesFewFactorisations)
{
    constexpr int kSheets = 5, kCells = 8;
    constexpr int kMostInAStep = 150,
                  kMostInTheMean =
                      15;  // with tangents as springs 300 and 22; the most scatters from 60 to 110
    Scene scene;
    scene.materials[0] = make_material();
    scene.gravity = Gravity{{0.0, 0.0, -kG}};
    scene.obstacles.push_back(make_floor());
    scene.self_contact = ClothContact{kThickness};
    scene.friction = Friction{.of_pieces = {0.3}, .of_obstacles = {}, .between_layers = {}};
    ClothMesh cloth;
    for (int k = 0; k < kSheets; ++k)
        add_piece(make_square(kCells, GridPattern::Alternating), {0.0, 0.0, 0.01 + 0.005 * k}, 0.0, cloth);
    ClothRun run(std::move(scene), cloth);
    int steps = 0, all = 0;
    run.advance(0.1, kStep, [&](const StepReport& report) {
        ++steps;
        all += report.factorisations;
        EXPECT_LE(report.factorisations, kMostInAStep) << run.state.time;
        EXPECT_LE(report.friction_residual, 0.1) << run.state.time;  // else a run warns
    });
    EXPECT_LE(all, kMostInTheMean * steps);
}

TEST(SelfContactFold, ClosesToItsThicknessWithoutPassing)
{
    Scene scene;
    scene.materials[0] = make_material(0.005);
    scene.gravity = Gravity{{0.0, 0.0, -kG}};
    scene.obstacles.push_back(make_floor());
    scene.self_contact = ClothContact{kThickness};
    constexpr double kLine = 0.2;
    ClothMesh mesh = make_sheet({0.2, 0.3}, {4, 6}, GridPattern::Cross);
    const double fold = 150.0 * std::numbers::pi / 180.0;
    for (std::size_t v = 0; v < mesh.world.size(); ++v) {
        const double u = mesh.material[v].x(), y = std::max(mesh.material[v].y() - kLine, 0.0);
        mesh.world[v] = {u, std::min(mesh.material[v].y(), kLine) + y * std::cos(fold),
                         2.0 * kThickness + y * std::sin(fold)};
    }
    ClothRun run(std::move(scene), std::move(mesh));
    for (int k = 0; k < 80; ++k) {
        run.advance(kStep);
        ASSERT_FALSE(crosses_itself(run)) << k;
    }
    // The upper part lies on the lower one, two thicknesses above the floor.
    double lowest = 1.0;
    for (std::size_t v = 0; v < run.state.mesh.world.size(); ++v)
        if (run.state.mesh.material[v].y() > 1.1 * kLine)
            lowest = std::min(lowest, run.state.mesh.world[v].z());
    EXPECT_GT(lowest, 1.9 * kThickness);
    EXPECT_LT(lowest, 2.5 * kThickness);
}

/// A strip thrown edge-on at the floor, as heaps and crumples are.
TEST(SelfContactCrumple, NeverCrossesItself)
{
    for (const double tilt : {88.0, 92.0, 75.0}) {
        Scene scene;
        scene.materials[0] = make_material();
        scene.gravity = Gravity{{0.0, 0.0, -kG}};
        scene.obstacles.push_back(make_floor());
        scene.self_contact = ClothContact{kThickness};
        ClothMesh mesh = make_sheet({0.3, 0.1}, {12, 4}, GridPattern::Alternating);
        const Mat3 turn =
            Eigen::AngleAxisd(-tilt * std::numbers::pi / 180.0, Vec3::UnitY()).toRotationMatrix();
        for (Vec3& x : mesh.world) x = turn * x + Vec3(0.0, 0.0, 0.02);
        ClothRun run(std::move(scene), std::move(mesh), Vec3(0.0, 0.0, -4.0));
        int most = 0;
        for (int k = 0; k < 50; ++k) {
            most = std::max(most, run.advance(kStep).self_contacts);
            ASSERT_FALSE(crosses_itself(run)) << tilt << " " << k;
        }
        EXPECT_GT(most, 0) << tilt;
    }
}

/// Contacts of layers couple vertices in the matrix for more than one step: the state tells which, and so
/// alone decides the last bit of the next step.
TEST(SelfContactCrumple, GoesOnFromAStateAlone)
{
    Scene scene;
    scene.materials[0] = make_material();
    scene.gravity = Gravity{{0.0, 0.0, -kG}};
    scene.obstacles.push_back(make_floor());
    scene.self_contact = ClothContact{kThickness};
    scene.friction = Friction{{0.3}, {}, {}};
    ClothMesh mesh = make_sheet({0.3, 0.15}, {14, 7}, GridPattern::Alternating);
    const Mat3 turn = Eigen::AngleAxisd(-1.5, Vec3::UnitY()).toRotationMatrix();
    for (Vec3& x : mesh.world) x = turn * x + Vec3(0.0, 0.0, 0.02);
    ClothRun run(std::move(scene), std::move(mesh), Vec3(0.0, 0.0, -3.0));
    std::size_t most = 0;
    for (int k = 0; k < 40; ++k) {
        ClothRun resumed = {run.scene, run.state.mesh};
        resumed.state = run.state;
        run.advance(kStep);
        resumed.advance(kStep);
        most = std::max(most, run.state.coupled.size());
        ASSERT_EQ(run.state.mesh.world, resumed.state.mesh.world) << k;
        ASSERT_EQ(run.state.coupled, resumed.state.coupled) << k;
    }
    EXPECT_GT(most, 0u);
}

}  // namespace
}  // namespace arris
