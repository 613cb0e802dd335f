// SPDX-License-Identifier: GPL-3.0-or-later
// The border of cloth on a table lies exactly along the table's edge, and nothing may hold the border there.
// Pulled onto the table, the cloth accelerates at F / m. Pulled over the edge, its overhang adds to the pull.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cloth_run.h"
#include "geometry/cloth/mesh_quality.h"
#include "grid_patterns.h"
#include "refinement.h"
#include "solver/contact/audit.h"

namespace arris {
namespace {

constexpr double kLength = 0.5, kWidth = 0.2, kThickness = 1e-3;  // m
constexpr double kDensity = 0.2, kPull = 2.0;                     // kg/m^2, m/s^2
constexpr double kStep = 0.0025, kDuration = 0.2;                 // s

/// The cloth's border x = kLength lies above the table's edge, which is the line x = z = 0.
ClothRun make_run(int cells, GridPattern pattern, double pull)
{
    const Vec2 size(kLength, kWidth);
    ClothMesh mesh = make_sheet(size, {cells, std::max(cells / 2, 1)}, pattern);
    lay(mesh, Vec3(-kLength, -0.5 * kWidth, kThickness));
    Scene scene = make_table_scene(mesh, {kDensity, 2e4, 0.3, 1e-7, 0.0, kThickness}, Vec3(1.6, 0.9, 0.5),
                                   Vec3(-0.8, 0.0, -0.25));
    scene.pulls.push_back({{Vec2::Zero(), size}, Vec3(pull * kDensity * kLength * kWidth, 0.0, 0.0)});
    return ClothRun(std::move(scene), std::move(mesh));
}

/// Mean displacement of the border that stays on the table, m.
double measure_displacement(const ClothRun& run)
{
    double sum = 0.0;
    int count = 0;
    for (int v = 0; v < run.state.mesh.vertex_count(); ++v) {
        if (run.state.mesh.material[v].x() != 0.0) continue;
        sum += run.state.mesh.world[v].x() + kLength;
        ++count;
    }
    return sum / count;
}

/// Displacement of cloth whose overhang x hangs straight down at once: gravity adds g x / L to the
/// acceleration.
double displacement_hanging(double pull)
{
    const double rate = std::sqrt(Gravity{}.acceleration.norm() / kLength);
    return pull / (rate * rate) * (std::cosh(rate * kDuration) - 1.0);
}

// Outward the cloth moves farther: the overhang falls and adds to the pull.
TEST(BorderOnEdge, HoldsNothing)
{
    constexpr double kTolerance = 1e-3;
    Table table("border_on_edge", {"pulled", "pattern", "cells", "displacement in .2 s", "F t^2 / 2 m"});
    for (const double pull : {-kPull, kPull}) {
        const double alone = 0.5 * pull * kDuration * kDuration;
        const double most = pull < 0.0 ? alone : displacement_hanging(pull);
        for (const GridPattern pattern : kPatterns)
            for (const int cells : {5, 10, 20}) {
                ClothRun run = make_run(cells, pattern, pull);
                for (int k = 1; k * kStep <= kDuration + 1e-9; ++k) {
                    EXPECT_EQ(run.advance(k * kStep - run.state.time).crossings, 0);
                    EXPECT_EQ(validate(run.state.mesh), "");
                }
                EXPECT_EQ(audit(run.scene, run.state.mesh, run.state.time).obstacle, -1);
                const double moved = measure_displacement(run);
                const std::string name = fmt::format("{}, {} cells", name_of(pattern), cells);
                EXPECT_GT(std::abs(moved), (1.0 - kTolerance) * std::abs(alone)) << name;
                EXPECT_LT(std::abs(moved), (1.0 + kTolerance) * std::abs(most)) << name;
                table.add({pull > 0.0 ? "outward" : "inward", name_of(pattern), fmt::format("{}", cells),
                           fmt::format("{:.3f} mm", 1e3 * moved), fmt::format("{:.3f} mm", 1e3 * alone)});
            }
    }
}

}  // namespace
}  // namespace arris
