// SPDX-License-Identifier: GPL-3.0-or-later
// EOL vertices on features that deform: a box's edges that are sheared, and a wire that bends.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "deforming_cloth.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "geometry/surgery/initial_target.h"
#include "grid_patterns.h"
#include "solver/contact/audit.h"

namespace arris {
namespace {

constexpr double kThickness = 1e-3;  // m
constexpr double kLimp = 1e-7;       // J, bending stiffness: a bend over an edge stores nothing

/// A sheet of `size` (m) that is bent over an edge parallel to y by `angle` (degrees): from the material line
/// at `fold` (m) on it hangs down. `bend`: the world place of that line's middle, m.
ClothMesh make_bent_sheet(Vec2 size, std::array<int, 2> cells, double fold, double angle, const Vec3& bend)
{
    ClothGrid grid;
    grid.size = size;
    grid.resolution = cells;
    grid.pattern = GridPattern::Cross;
    grid.folds = {{{Vec2(fold, 0.0), Vec2(fold, size.y())}, angle}};
    ClothMesh mesh = make_cloth_grid(grid);
    fold_cloth(grid.folds, mesh);
    for (Vec3& x : mesh.world) x += bend - Vec3(fold, 0.5 * size.y(), 0.0);
    return mesh;
}

/// A sheet that slides over the edge of a table while the table is sheared in its plane by 30 degrees.
struct ShearedTable {
    EnergyBooks books;
    int steps = 0, steps_with_eol = 0, rows = 0;

    explicit ShearedTable(double dt)
    {
        constexpr double kDuration = 0.25, kDegrees = 30.0;
        const SmoothRamp ramp{kDuration};
        const double most = std::tan(kDegrees * M_PI / 180.0);
        const ObstacleMesh table = make_box({0.8, 1.6, 0.8});
        Scene scene = make_deforming_scene(kThickness);
        scene.materials[0].bending_stiffness = kLimp;
        scene.obstacles.push_back(make_deforming(
            table,
            [=](const Vec3& rest, double time) {
                return Vec3(rest.x() + most * ramp.at(time) * rest.y(), rest.y(), rest.z());
            },
            [=](const Vec3& rest, double time) {
                return Vec3(most * ramp.rate(time) * rest.y(), 0.0, 0.0);
            }));
        ClothMesh mesh =
            make_bent_sheet({0.36, 0.2}, {18, 10}, 0.24, 90.0, Vec3(0.4 + kThickness, 0.1, 0.4 + kThickness));
        scene.eol = make_initial_target(mesh);
        ClothRun run(std::move(scene), std::move(mesh));
        books = keep_books(run, kDuration, dt, [&](const StepReport& report) {
            ++steps;
            rows += report.feature_rows;
            steps_with_eol += report.eol_pressing > 0;
            EXPECT_TRUE(find_penetrations(run.scene, run.state).empty()) << run.state.time;
        });
    }
};

TEST(DeformingFeature, TableThatIsShearedUnderSlidingClothDoesTheWorkThatTheClothGains)
{
    constexpr double kStep = 0.0025;
    const ShearedTable coarse(kStep), fine(0.5 * kStep);
    for (const ShearedTable* run : {&coarse, &fine}) {
        EXPECT_EQ(run->steps_with_eol, run->steps);
        EXPECT_EQ(run->rows, 0) << "the edge holds cloth without EOL vertices";
    }
    EXPECT_GT(fine.books.driven, 1e-3) << "J";
    EXPECT_LT(std::abs(extrapolate(coarse.books, fine.books).unexplained()), 0.01 * fine.books.driven);
}

/// A wire along y bends in the vertical plane to an arc of curvature `most` (1/m, positive where its ends go
/// down) and rises by 2 cm. It stretches a strip without weight that hangs over it like a tent and whose ends
/// are held.
EnergyBooks bend_under_strip(double dt, double most)
{
    constexpr double kDuration = 0.5, kRise = 0.02, kHalf = 0.15, kSegment = 0.01;  // s, m, m, m
    const SmoothRamp ramp{kDuration};
    const auto place = [&](const Vec3& rest, double time) {
        const double half = 0.5 * most * ramp.at(time) * rest.y();  // turn of the chord from the middle
        const double sinc = half == 0.0 ? 1.0 : std::sin(half) / half;
        return Vec3(rest.y() * sinc * Vec3(0.0, std::cos(half), -std::sin(half)) +
                    kRise * ramp.at(time) * Vec3::UnitZ());
    };
    const auto velocity = [&](const Vec3& rest, double time) {
        constexpr double kShort = 1e-6;  // s
        return Vec3((place(rest, time + kShort) - place(rest, time - kShort)) / (2.0 * kShort));
    };
    std::vector<Vec3> points;
    for (int k = -20; k <= 20; ++k) points.emplace_back(0.0, k * kSegment, 0.0);
    Scene scene = make_deforming_scene(kThickness);
    scene.gravity.reset();
    scene.materials[0].youngs_modulus = 200.0;
    scene.materials[0].bending_stiffness = kLimp;
    scene.obstacles.push_back(make_deforming(make_wire(points, false), place, velocity));
    for (const double end : {0.0, 2.0 * kHalf}) {
        Pin pin;
        pin.material = {{end, 0.0}, {end, 0.2}};
        scene.pins.push_back(pin);
    }
    const Vec3 top(0.0, 0.0, kThickness);
    ClothMesh mesh = make_bent_sheet({2.0 * kHalf, 0.2}, {12, 8}, kHalf, 90.0, top);
    for (Vec3& x : mesh.world) x = top + rotation_about(Vec3::UnitY(), -45.0) * (x - top);
    scene.eol = make_initial_target(mesh);
    ClothRun run(std::move(scene), std::move(mesh));

    // The wire's segments are chords of the arc. 10 %: the outward direction halfway between two of them.
    const double sagitta = 1.1 * std::abs(most) * kSegment * kSegment / 8.0;
    constexpr double kRounding = 1e-9;  // m
    const EnergyBooks books = keep_books(run, kDuration, dt, [&](const StepReport& report) {
        EXPECT_TRUE(find_penetrations(run.scene, run.state).empty()) << run.state.time;
        const bool has_risen = run.state.time > 0.2 * kDuration;
        EXPECT_GE(report.eol_pressing, has_risen ? 5 : 0) << run.state.time;
        const double k = most * ramp.at(run.state.time), lift = kRise * ramp.at(run.state.time);
        for (const EolVertex& vertex : run.state.eol) {
            if (vertex.idle > 0) continue;
            const Vec3& x = run.state.mesh.world[run.state.index_of(vertex.vertex_id)];
            // From the circle about (0, 0, lift - r), r = 1 / k: (d^2 - r^2) / (d + r)   no cancellation
            const double up = x.z() - lift;
            const double beyond =
                (k * (x.y() * x.y() + up * up) + 2.0 * up) / (1.0 + std::hypot(k * x.y(), k * up + 1.0));
            EXPECT_NEAR(std::hypot(x.x(), beyond), kThickness, sagitta + kRounding) << run.state.time;
        }
    });
    return books;
}

TEST(DeformingFeature, WireThatBendsToAnArcKeepsItsTraceAndDoesTheWorkThatTheClothStores)
{
    for (const double curvature : {4.0, -4.0}) {
        const EnergyBooks coarse = bend_under_strip(0.005, curvature);
        const EnergyBooks fine = bend_under_strip(0.0025, curvature);
        EXPECT_GT(fine.driven, 0.03) << "J";
        EXPECT_LT(std::abs(extrapolate(coarse, fine).unexplained()), 1e-3 * fine.driven) << curvature;
        // Order 1 in the step: the work alone, see extrapolate.
        EXPECT_NEAR(coarse.unexplained() / fine.unexplained(), 2.0, 0.1) << curvature;
    }
}

}  // namespace
}  // namespace arris
