// SPDX-License-Identifier: GPL-3.0-or-later
// Cloth pulled off a table, faster in the end than its tension holds it on the edge: its fold flies off while
// the tail still flows through it. The pull and the fall do work all the time, nothing takes any.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cloth_run.h"
#include "geometry/mesh_quality.h"
#include "grid_patterns.h"
#include "refinement.h"
#include "solver/advance.h"
#include "solver/audit.h"

namespace arris {
namespace {

constexpr double kBefore = 0.4, kAfter = 0.58;  // s: all of it on the edge; the fold .1 m off it

/// A strip of denim, 0.1 m of it over the edge, pulled there.
ClothRun make_run(std::array<int, 2> cells)
{
    ClothMesh mesh = make_sheet(Vec2(0.9, 0.1), cells, GridPattern::Cross);
    lay(mesh, Vec3(-0.8, -0.05, 0.004));
    Scene scene = make_table_scene(mesh, {0.4, 2000.0, 0.3, 1e-4, 0.0, 1e-3}, Vec3(1.6, 0.9, 0.5),
                                   Vec3(-0.8, 0.0, -0.25));
    scene.pulls.push_back({{Vec2(0.9, 0.0), Vec2(0.9, 0.1)}, Vec3(0.08, 0.0, -0.04)});
    return ClothRun(std::move(scene), std::move(mesh));
}

struct Pulled {
    double before = 0.0, after = 0.0;  ///< J
    double drop = 0.0;                 ///< J, greatest below the running maximum between them
    int fewest = 1 << 20;              ///< EOL vertices, then
};

Pulled pull_off(std::array<int, 2> cells, double step)
{
    ClothRun run = make_run(cells);
    Pulled found;
    double greatest = -std::numeric_limits<double>::infinity();
    const auto accept = [&](const StepReport& report, bool) {
        EXPECT_EQ(report.crossings, 0);
        const double energy = measure_energy(run).sum();
        if (run.state.time <= kBefore + 1e-9) {
            found.before = energy;
            return true;
        }
        greatest = std::max(greatest, energy);
        found.drop = std::max(found.drop, greatest - energy);
        found.fewest = std::min(found.fewest, static_cast<int>(run.state.eol.size()));
        found.after = energy;
        return true;
    };
    for (int k = 1; k * step <= kAfter + 1e-9 && !testing::Test::HasFailure(); ++k) {
        EXPECT_FALSE(advance(run.scene, run.settings, k * step, run.state, run.work, accept));
        EXPECT_EQ(validate(run.state.mesh), "");
    }
    EXPECT_EQ(audit(run.scene, run.state.mesh, run.state.time).obstacle, -1);
    return found;
}

TEST(PulledCloth, LosesNothingWhereItsFoldLeavesTheTable)
{
    Table results("pulled_cloth", {"cells", "step", "energy at .4 s", "energy at .58 s", "greatest drop"});
    // On 36 cells the fold is let go within the time, as a kink of a cell that rings: longer steps than 1.25
    // ms take more of that.
    for (const auto& [cells, step] : {std::pair(18, 5e-3), {18, 2.5e-3}, {18, 1.25e-3}, {36, 1.25e-3}}) {
        const Pulled found = pull_off({cells, cells / 9}, step);
        const std::string name = fmt::format("{} cells, {} s", cells, step);
        ASSERT_FALSE(HasFailure()) << name;
        EXPECT_LT(found.drop, 2e-4) << name;
        if (cells == 18) {  // of others it is more than four away
            EXPECT_GE(found.fewest, 3) << name << ": the fold is let go";
        }
        // Rows only, 144 cells at .6 ms: from .0261 to .0540 J.
        EXPECT_NEAR(found.after, 0.0545, 0.1 * 0.0545) << name;
        results.add({fmt::format("{}", cells), fmt::format("{:g} ms", 1e3 * step),
                     fmt::format("{:.4f} J", found.before), fmt::format("{:.4f} J", found.after),
                     fmt::format("{:.1e} J", found.drop)});
    }
}

/// Cotton on a box, a tenth of it over the edge, pulled there by its front border.
ClothRun make_sheet_run(GridPattern pattern)
{
    const Vec2 size(0.8, 0.5);
    ClothMesh mesh = make_sheet(size, {20, 12}, pattern);
    lay(mesh, Vec3(-0.7, -0.25, 0.002));
    Scene scene = make_table_scene(mesh, {0.15, 500.0, 0.3, 1e-5, 0.0, 1e-3}, Vec3(2.0, 1.0, 0.8),
                                   Vec3(-1.0, 0.0, -0.4));
    scene.pulls.push_back({{Vec2(size.x(), 0.0), size}, Vec3(0.0, 0.0, -0.3)});
    return ClothRun(std::move(scene), std::move(mesh));
}

double largest_face(const ClothMesh& mesh)
{
    double largest = 0.0;
    for (const auto& [a, b, c] : mesh.faces)
        largest = std::max(largest, 0.5 * twice_area(mesh.material[a], mesh.material[b], mesh.material[c]));
    return largest;
}

// What stands ahead of a trace is merged and comes back behind it: at the rear border, too, after which the
// trace is gone and nothing changes the mesh any more.
TEST(PulledCloth, HasFacesOfTheirOwnSizeWhereItsRearBorderHasPassedTheEdge)
{
    for (const GridPattern pattern : {GridPattern::Diagonal, GridPattern::Cross}) {
        ClothRun run = make_sheet_run(pattern);
        const double before = largest_face(run.state.mesh);
        const int vertices = run.state.mesh.vertex_count();
        const double area = material_area(run.state.mesh);
        int most = 0;
        const auto accept = [&](const StepReport& report, bool) {
            EXPECT_EQ(report.crossings, 0);
            EXPECT_LE(report.energy_rise, 0.0);
            most = std::max(most, static_cast<int>(run.state.eol.size()));
            return true;
        };
        for (int k = 1; k <= 110 && !HasFailure(); ++k) {
            EXPECT_FALSE(advance(run.scene, run.settings, 0.005 * k, run.state, run.work, accept));
            EXPECT_EQ(validate(run.state.mesh), "");
        }
        EXPECT_GT(most, 5) << "it has passed over a trace";
        EXPECT_TRUE(run.state.eol.empty());
        ASSERT_LT(largest_face(run.state.mesh), 4.0 * before) << name_of(pattern);
        EXPECT_LT(run.state.mesh.vertex_count(), 1.1 * vertices);
        EXPECT_GT(run.state.mesh.vertex_count(), 0.6 * vertices);
        EXPECT_NEAR(material_area(run.state.mesh), area, 1e-12);
    }
}

}  // namespace
}  // namespace arris
