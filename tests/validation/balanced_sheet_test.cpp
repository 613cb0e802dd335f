// SPDX-License-Identifier: GPL-3.0-or-later
// A sheet hangs over two opposite edges of a table by equal lengths: an unstable equilibrium. A difference of
// the lengths grows as cosh(t sqrt(2 g / L)), 3500-fold in 2 s. The only initial difference is from mesh and
// method, and the test bounds the drift that it causes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "cloth_run.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "geometry/surgery/initial_target.h"
#include "grid_patterns.h"
#include "refinement.h"
#include "solver/contact/audit.h"
#include "tests/failures_since.h"

namespace arris {
namespace {

constexpr double kStep = 0.005, kDuration = 2.0;  // s
constexpr double kThickness = 1e-3;               // m
constexpr double kHanging = 0.199;                // m, on each side of a sheet 1 m wide
constexpr double kMostDrift = 1e-3;               // m

struct BalancedSheet {
    int cells;
    GridPattern pattern;
    double angle, youngs_modulus;
};

ClothRun make_run(const BalancedSheet& sheet)
{
    ClothGrid grid;
    grid.size = Vec2(1.0, 1.0);
    grid.resolution = {sheet.cells, sheet.cells};
    grid.pattern = sheet.pattern;
    grid.pattern_angle = sheet.angle;
    for (const double x : {kHanging, 1.0 - kHanging})
        grid.folds.push_back({{Vec2(x, 0.0), Vec2(x, 1.0)}, 90.0});
    ClothMesh mesh = make_cloth_grid(grid);
    fold_cloth(grid.folds, mesh);
    const double half = 0.5 - kHanging;
    const Mat3 upright = rotation_about(Vec3::UnitY(), -90.0);
    for (Vec3& x : mesh.world) x = upright * x + Vec3(-half, -0.5, kThickness - kHanging);
    Scene scene;
    scene.materials[0] = {0.05, sheet.youngs_modulus, 0.01, 1e-5, 0.0, kThickness};
    scene.gravity = Gravity{};
    Placement place;
    place.translation = Vec3(0.0, 0.0, -0.5);
    const Vec3 size(2.0 * (half - kThickness), 3.0, 1.0);
    scene.obstacles.push_back(MovingObstacle("table", make_box(size), place, {}, 30.0));
    scene.eol = make_initial_target(mesh);
    return ClothRun(std::move(scene), std::move(mesh));
}

/// x of the cloth's centre of mass, m.
double middle_of(const ClothMesh& mesh)
{
    double sum = 0.0, area = 0.0;
    for (const Face& face : mesh.faces) {
        const Vec2 &a = mesh.material[face[0]], &b = mesh.material[face[1]], &c = mesh.material[face[2]];
        const double here = 0.5 * ((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x());
        for (const int v : face) sum += here / 3.0 * mesh.world[v].x();
        area += here;
    }
    return sum / area;
}

TEST(BalancedSheet, StaysOnAnyMesh)
{
    Table table("balanced_sheet", {"E", "pattern", "turned by", "cells", "drift in 2 s"});
    for (const double modulus : {50.0, 2000.0})
        for (const auto& [pattern, angle] : {std::pair(GridPattern::Diagonal, 30.0),
                                             {GridPattern::Alternating, 17.0},
                                             {GridPattern::Unstructured, 0.0}})
            for (const int cells : {10, 16, 32}) {
                const FailuresSince failures;
                if (cells > 16 && !is_deep()) continue;
                ClothRun run = make_run({cells, pattern, angle, modulus});
                const double first = middle_of(run.state.mesh);
                double drift = 0.0;
                int changes = 0;  // EOL vertices inserted or released
                for (int k = 1; k * kStep <= kDuration + 1e-9 && !run.failures.any(); ++k) {
                    const StepReport report = run.advance(k * kStep - run.state.time);
                    EXPECT_EQ(report.crossings, 0);
                    if (k > 2) changes += report.inserted + report.released;  // a new contact is a row first
                    drift = std::max(drift, std::abs(middle_of(run.state.mesh) - first));
                }
                EXPECT_EQ(audit(run.scene, run.state.mesh, run.state.time).obstacle, -1);
                EXPECT_FALSE(run.state.eol.empty());
                const std::string name = fmt::format("{} cells, {}, E {}", cells, name_of(pattern), modulus);
                if (failures.any()) {
                    ADD_FAILURE() << name;
                    continue;
                }
                EXPECT_LT(drift, kMostDrift) << name;
                EXPECT_EQ(changes, 0) << name << ": resting cloth flickers";
                table.add({fmt::format("{:g}", modulus), name_of(pattern), fmt::format("{:g}", angle),
                           fmt::format("{}", cells), fmt::format("{:.1e} m", drift)});
            }
}

}  // namespace
}  // namespace arris
