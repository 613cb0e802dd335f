// SPDX-License-Identifier: GPL-3.0-or-later
// Cloth on bodies: parts of one body that close on cloth, and skin that swells.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "deforming_cloth.h"
#include "geometry/obstacle/point_cache.h"
#include "geometry/obstacle_input/deform/slit_samples.h"
#include "grid_patterns.h"
#include "solver/advance.h"
#include "solver/contact/audit.h"
#include "tests/elbow_body.h"
#include "tests/pose_samples.h"

namespace arris {
namespace {

constexpr double kThickness = 1e-3;

/// An elbow that closes in `kClosing`, and then stays so that its legs overlap by 4 mm, on a strip of cloth
/// that lies on the inner side of one leg.
constexpr double kClosing = 0.4, kEnd = 0.6, kRate = 24.0;  // s, s, 1/s

ElbowBody make_elbow()
{
    ElbowBody body;
    body.gap = -0.004;
    return body;
}

std::vector<std::vector<Vec3>> close_elbow(const ElbowBody& body, const ObstacleMesh& mesh)
{
    std::vector<std::vector<Vec3>> samples;
    for (int k = 0; k <= std::lround(kEnd * kRate); ++k) {
        const double part = std::min(k / (kRate * kClosing), 1.0);
        const double eased = part * part * (3.0 - 2.0 * part);
        samples.push_back(body.bend(mesh.points, 0.5 * M_PI * (1.0 + eased)));
    }
    return samples;
}

ClothRun make_elbow_run(std::vector<std::vector<Vec3>> samples, const ObstacleMesh& mesh)
{
    Scene scene = make_deforming_scene(kThickness);
    scene.friction = Friction{{0.3}};
    const auto source = std::make_shared<PoseSamples>(std::move(samples), 1.0 / kRate);
    const auto deformation = std::make_shared<PointCache>(source, PoseInterpolation::Cubic);
    scene.obstacles.push_back(MovingObstacle("elbow", mesh, {}, {}, 30.0, deformation));
    ClothMesh strip = make_sheet({0.1, 0.04}, {10, 4}, GridPattern::Cross);
    lay(strip, Vec3(-0.15, -0.02, 0.03 + kThickness));
    return ClothRun(std::move(scene), std::move(strip));
}

constexpr double kStep = 1.0 / 216.0;

TEST(BodyThatClosesOnCloth, WithoutRoomEndsInfeasibleAndNamesTheBody)
{
    const ElbowBody body = make_elbow();
    const ObstacleMesh mesh = body.make();
    ClothRun run = make_elbow_run(close_elbow(body, mesh), mesh);
    std::optional<StepReport> failed;
    while (!failed && run.state.time < kEnd - 0.5 * kStep) {
        failed = advance(run.scene, run.settings, run.state.time + kStep, run.state, run.work,
                         [](const StepReport&, bool) { return true; });
        ASSERT_TRUE(find_penetrations(run.scene, run.state).empty()) << run.state.time;
    }
    ASSERT_TRUE(failed) << "the legs overlap where the cloth is";
    EXPECT_EQ(failed->status, StepStatus::Infeasible);
    EXPECT_GE(failed->infeasible.vertex, 0);
    // Two parts of one obstacle: the second is none.
    EXPECT_EQ(failed->infeasible.obstacles, (std::array{0, -1}));
    EXPECT_EQ(failed->place.crease, (std::array{0, 0}));
}

TEST(BodyThatClosesOnCloth, WithASlitLeavesTheClothItsRoom)
{
    constexpr double kWidth = 0.005;
    const ElbowBody body = make_elbow();
    const ObstacleMesh mesh = body.make();
    std::vector<std::vector<Vec3>> opened;
    const SlitSurvey survey = make_slit(PoseSamples(close_elbow(body, mesh), 1.0 / kRate), mesh, kWidth,
                                        [&](const std::vector<Vec3>& points) { opened.push_back(points); });
    EXPECT_GT(survey.samples, 0u);
    ClothRun run = make_elbow_run(std::move(opened), mesh);
    run.advance(kEnd, kStep, [&](const StepReport&) {
        EXPECT_TRUE(find_penetrations(run.scene, run.state).empty()) << run.state.time;
    });
    EXPECT_NEAR(run.state.time, kEnd, 1e-9);
}

/// A closed sphere about the origin of rings at equal polar angles.
ObstacleMesh make_sphere(double radius, int rings)
{
    const int around = 2 * rings;
    ObstacleMesh sphere;
    sphere.points.push_back(Vec3(0, 0, radius));
    for (int i = 1; i < rings; ++i)
        for (int j = 0; j < around; ++j) {
            const double polar = M_PI * i / rings, turn = 2.0 * M_PI * j / around;
            sphere.points.push_back(radius * Vec3(std::sin(polar) * std::cos(turn),
                                                  std::sin(polar) * std::sin(turn), std::cos(polar)));
        }
    sphere.points.push_back(Vec3(0, 0, -radius));
    const int last = static_cast<int>(sphere.points.size()) - 1;
    const auto at = [&](int i, int j) { return 1 + (i - 1) * around + j % around; };
    for (int j = 0; j < around; ++j) {
        sphere.faces.push_back({0, at(1, j), at(1, j + 1)});
        sphere.faces.push_back({last, at(rings - 1, j + 1), at(rings - 1, j)});
        for (int i = 1; i < rings - 1; ++i) {
            sphere.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            sphere.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return sphere;
}

constexpr double kRadius = 0.1;  // m
constexpr double kGrowth = 1.0;  // 1/s

/// A sphere that swells lifts the cloth on it.
TEST(SphereThatSwells, LiftsItsCloth)
{
    Scene scene = make_deforming_scene(kThickness);
    scene.friction = Friction{{0.5}};
    scene.obstacles.push_back(make_deforming(
        make_sphere(kRadius, 24),
        [](const Vec3& rest, double time) { return Vec3((1.0 + kGrowth * time) * rest); },
        [](const Vec3& rest, double) { return Vec3(kGrowth * rest); }));
    ClothMesh mesh = make_sheet({0.3, 0.3}, {12, 12}, GridPattern::Cross);
    lay(mesh, Vec3(-0.15, -0.15, kRadius + kThickness));
    ClothRun run(std::move(scene), std::move(mesh));
    run.advance(1.0, 0.005);
    const double radius = kRadius * (1.0 + kGrowth * run.state.time);
    double top = -1.0;
    for (const Vec3& x : run.state.mesh.world) top = std::max(top, x.z());
    EXPECT_NEAR(top, radius + kThickness, 1e-4);
    EXPECT_TRUE(find_penetrations(run.scene, run.state).empty());
}

/// A sphere that swells slowly into a sheet whose border is held, and stretches it: in steps of `dt` (s).
EnergyBooks swell_into_sheet(double dt)
{
    constexpr double kGrown = 0.04, kDuration = 1.0, kSize = 0.3;  // m, s, m
    const SmoothRamp ramp{kDuration};
    const auto radius = [&](double time) { return kRadius + kGrown * ramp.at(time); };
    Scene scene = make_deforming_scene(kThickness);
    scene.gravity.reset();
    scene.obstacles.push_back(make_deforming(
        make_sphere(kRadius, 36),
        [&](const Vec3& rest, double time) { return Vec3(radius(time) / kRadius * rest); },
        [&](const Vec3& rest, double time) { return Vec3(kGrown * ramp.rate(time) / kRadius * rest); }));
    for (const MaterialBox& side :
         {MaterialBox{{0, 0}, {kSize, 0}}, MaterialBox{{0, kSize}, {kSize, kSize}},
          MaterialBox{{0, 0}, {0, kSize}}, MaterialBox{{kSize, 0}, {kSize, kSize}}}) {
        Pin pin;
        pin.material = side;
        scene.pins.push_back(pin);
    }
    ClothMesh mesh = make_sheet({kSize, kSize}, {16, 16}, GridPattern::Cross);
    lay(mesh, Vec3(-0.5 * kSize, -0.5 * kSize, kRadius + kThickness));
    ClothRun run(std::move(scene), std::move(mesh));

    // Cloth slides on facets that lean by at most 3.6 degrees, half of their longest side. Its radial speed
    // differs from the sphere's by their cosine, and by the sine times its speed along them, which is below a
    // quarter of the sphere's.
    const double lean = 3.6 * M_PI / 180.0, allowed = 1.0 - std::cos(lean) + 0.25 * std::sin(lean);
    int touching = 0;
    const EnergyBooks books = keep_books(run, kDuration, dt, [&](const StepReport&) {
        EXPECT_TRUE(find_penetrations(run.scene, run.state).empty()) << run.state.time;
        const double r = radius(run.state.time), speed = kGrown * ramp.rate(run.state.time);
        const bool is_half_way = std::abs(run.state.time - 0.5 * kDuration) < 0.5 * dt;
        for (std::size_t v = 0; v < run.state.mesh.world.size(); ++v) {
            const Vec3& x = run.state.mesh.world[v];
            EXPECT_GT(x.norm(), r * std::cos(lean) + kThickness) << run.state.time;
            if (!is_half_way || x.norm() > r + kThickness) continue;
            ++touching;
            EXPECT_NEAR(run.state.velocity[v].dot(x.normalized()), speed, allowed * speed);
        }
    });
    EXPECT_GT(touching, 10);
    return books;
}

TEST(SphereThatSwells, DoesTheWorkThatItsClothStores)
{
    constexpr double kStride = 0.01;
    const EnergyBooks coarse = swell_into_sheet(kStride), fine = swell_into_sheet(0.5 * kStride);
    EXPECT_GT(fine.last - fine.first, 0.05) << "J";
    EXPECT_LT(std::abs(extrapolate(coarse, fine).unexplained()), 1e-3 * fine.driven);
}

}  // namespace
}  // namespace arris
