// SPDX-License-Identifier: GPL-3.0-or-later
// Cloth lands with four fifths of its length on a table and slides off over the table's long edge, on any
// mesh. On a small table it slides off around the corners. Without friction only impacts dissipate energy,
// but cloth that snags loses most of its energy. Without EOL vertices 0.025 J of 0.091 J are left at 0.6 s on
// 16 cells.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cloth_run.h"
#include "geometry/cloth/mesh_quality.h"
#include "refinement.h"
#include "solver/advance.h"
#include "solver/contact/audit.h"
#include "tests/failures_since.h"

namespace arris {
namespace {

constexpr double kStep = 0.005, kDuration = 0.6;  // s
// Kinetic energy on the half table at kDuration, J. A regression figure, without a closed form or a refined
// reference: the mean over meshes and both stiffnesses. Its tolerances are the scatter between meshes; cloth
// that snags has a quarter of it.
constexpr double kSlidOff = 0.0915;

struct TableTop {
    Vec3 size, middle;  ///< m
};
const TableTop kHalfTable = {Vec3(3.0, 3.0, 1.0), Vec3(-1.2, 0.0, -0.5)};
const TableTop kSmallTable = {Vec3(0.6, 0.6, 1.0), Vec3(0.12, 0.0, -0.5)};

struct Drop {
    int cells;
    double angle, youngs_modulus, height = 0.05;
    TableTop table = kHalfTable;
    double bending_stiffness = 1e-5;
    bool has_eol = true;
};

ClothRun make_run(const Drop& drop)
{
    ClothMesh mesh = make_sheet(Vec2(1.0, 1.0), {drop.cells, drop.cells}, GridPattern::Diagonal, drop.angle);
    lay(mesh, Vec3(-0.5, -0.5, drop.height));
    const Material material{0.05, drop.youngs_modulus, 0.01, drop.bending_stiffness, 0.0, 1e-3};
    Scene scene = make_table_scene(mesh, material, drop.table.size, drop.table.middle);
    if (!drop.has_eol) scene.eol.reset();
    return ClothRun(std::move(scene), std::move(mesh));
}

struct Slid {
    double kinetic = 0.0;  ///< J, at the end
    double height = 0.0;   ///< m, of the centre of mass at the end
    double rise = 0.0;     ///< J, greatest rise of the energy over its running minimum
    double runaway = 0.0;  ///< greatest flow over the greatest speed of the cloth at that time
    int halved = 0;
};

double greatest_flow(const State& state)
{
    double most = 0.0;
    for (const Vec2& flow : state.material_velocity) most = std::max(most, flow.norm());
    return most;
}

/// Greatest speed of the Lagrangian vertices, which move with their material.
double greatest_speed(const State& state)
{
    double most = 0.0;
    for (std::size_t v = 0; v < state.velocity.size(); ++v)
        if (state.eol_entry(state.ids[v]) < 0) most = std::max(most, state.velocity[v].norm());
    return most;
}

Slid slide_off(const Drop& drop)
{
    ClothRun run = make_run(drop);
    Slid found;
    double least = std::numeric_limits<double>::infinity();
    for (int k = 1; k * kStep <= kDuration + 1e-9 && !run.failures.any(); ++k) {
        const auto accept = [&](const StepReport& report, bool is_halved) {
            found.halved += is_halved ? 1 : 0;
            EXPECT_EQ(report.crossings, 0);
            EXPECT_EQ(report.rewound, 0);
            const ClothEnergy energy = measure_energy(run);
            found.kinetic = energy.kinetic;
            found.height = energy.potential.gravity / (0.05 * 9.81);
            found.rise = std::max(found.rise, energy.sum() - least);
            found.runaway = std::max(found.runaway, greatest_flow(run.state) / greatest_speed(run.state));
            least = std::min(least, energy.sum());
            return true;
        };
        EXPECT_FALSE(advance(run.scene, run.settings, k * kStep, run.state, run.work, accept));
        EXPECT_EQ(validate(run.state.mesh), "");
        EXPECT_NEAR(material_area(run.state.mesh), 1.0, 1e-12);
    }
    EXPECT_EQ(audit(run.scene, run.state.mesh, run.state.time).obstacle, -1);
    EXPECT_LT(found.runaway, 2.0);
    return found;
}

TEST(HalfTable, ClothSlidesOffOnAnyMeshSoftOrStiff)
{
    Table results("half_table",
                  {"E", "turned by", "cells", "kinetic energy at .6 s", "energy gained", "halved"});
    for (const double modulus : {50.0, 2000.0})
        for (const double angle : {0.0, 30.0})
            for (const int cells : {10, 16, 32}) {
                const FailuresSince failures;
                if (cells > 16 && !is_deep()) continue;
                const Slid found = slide_off({cells, angle, modulus});
                const std::string name = fmt::format("{} cells turned by {}, E {}", cells, angle, modulus);
                if (failures.any()) {
                    ADD_FAILURE() << name;
                    continue;
                }
                // The bounce of stiff cloth off the table depends on the mesh, and the slide amplifies the
                // difference.
                EXPECT_NEAR(found.kinetic, kSlidOff, (modulus < 100.0 ? 0.04 : 0.06) * kSlidOff) << name;
                EXPECT_LT(found.rise, 1e-3) << name;
                results.add({fmt::format("{:g}", modulus), fmt::format("{:g}", angle),
                             fmt::format("{}", cells), fmt::format("{:.4f} J", found.kinetic),
                             fmt::format("{:.1e} J", found.rise), fmt::format("{}", found.halved)});
            }
}

// Stiff cloth bounces: its fold leaves the edge for a while and must come back to it. A fold that moved along
// the bisector of the table's faces did not: 0.147 J here, 0.094 J with a quarter of the step.
TEST(HalfTable, FoldThatLeavesTheEdgeComesBack)
{
    const Slid found = slide_off({32, 45.0, 2000.0});
    EXPECT_NEAR(found.kinetic, 0.0944, 0.1 * 0.0944);
    EXPECT_LT(found.rise, 1e-3);
    EXPECT_LT(found.halved, 5);
}

// The result must not depend on when within a step the impact happens. Linear equations stop the cloth on the
// table but let the overhang keep falling. They neglect the stretch of the one cell between the two. When
// that cell contracted again, the fold left the edge: 0.053 and 0.077 J here.
TEST(HalfTable, TheImpactMayFallAnywhereInItsStep)
{
    for (const double higher : {5e-4, 1e-3}) {
        const Slid found = slide_off({32, 30.0, 2000.0, 0.05 + higher});
        EXPECT_NEAR(found.kinetic, kSlidOff, 0.06 * kSlidOff) << higher;
        EXPECT_LT(found.rise, 1e-3) << higher;
    }
}

// The fold ends at the table's corner and the cloth beside it crumples, in a way that varies from run to run.
// Drops that differ by 0.1 mm scatter by 0.011 J, and the mean of eleven by 0.0033 J. Without EOL vertices 64
// cells with a quarter of the step leave 0.053 J. With this step 16 and 32 cells leave 0.013 to 0.019 J: the
// cloth snags there.
TEST(SmallTable, SoftClothSlidesAroundItsCorners)
{
    constexpr int kDrops = 11;
    double sum = 0.0, least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < kDrops; ++k) {
        const double height = 0.049 + 2e-4 * k;
        const Slid found = slide_off({16, 0.0, 50.0, height, kSmallTable});
        EXPECT_LT(found.rise, 1e-3) << height;
        sum += found.kinetic;
        least = std::min(least, found.kinetic);
    }
    EXPECT_NEAR(sum / kDrops, 0.053, 0.01);
    EXPECT_GT(least, 0.022);
}

/// Mean over drops from five heights: kinetic energy and height of the centre of mass.
Slid slide_around_corners(Drop drop)
{
    constexpr int kDrops = 5;
    Slid mean;
    for (int k = 0; k < kDrops; ++k) {
        drop.height = 0.049 + 5e-4 * k;
        const Slid found = slide_off(drop);
        mean.kinetic += found.kinetic / kDrops;
        mean.height += found.height / kDrops;
        mean.rise = std::max(mean.rise, found.rise);
    }
    return mean;
}

// Bending and weight make pleats of length (K / (rho g))^(1/3) at the corners. Where cells resolve these
// pleats, with two or more cells each, EOL vertices and rows must agree. K = 1e-5 (above) would take 74
// cells.
TEST(SmallTable, WhereCellsResolveItsPleatsClothSlidesAsFineClothOfRows)
{
    struct Case {
        double bending_stiffness;
        int cells;
    };
    constexpr double kAgree = 0.03;
    // Without EOL vertices, 32 cells agree within 2 % with 64 cells, which take a minute.
    const int cells_of_rows = is_deep() ? 64 : 32;
    const double allowed = is_deep() ? kAgree : kAgree + 0.02;
    Table results("pleats", {"K", "features as", "cells", "kinetic energy at .6 s", "centre of mass"});
    const auto add = [&](double stiffness, const char* kind, int cells, const Slid& found) {
        results.add({fmt::format("{:g}", stiffness), kind, fmt::format("{}", cells),
                     fmt::format("{:.4f} J", found.kinetic), fmt::format("{:.4f} m", found.height)});
    };
    for (const auto& [stiffness, cells] : {Case{1e-3, 16}, Case{3e-4, 32}}) {
        if (cells > 16 && !is_deep()) continue;
        const Slid eol = slide_around_corners({cells, 0.0, 50.0, 0.0, kSmallTable, stiffness});
        const Slid rows =
            slide_around_corners({cells_of_rows, 0.0, 50.0, 0.0, kSmallTable, stiffness, false});
        EXPECT_NEAR(eol.kinetic, rows.kinetic, allowed * rows.kinetic) << stiffness;
        EXPECT_NEAR(eol.height, rows.height, allowed * std::abs(rows.height)) << stiffness;
        EXPECT_LT(eol.rise, 2e-3) << stiffness;
        add(stiffness, "EOL", cells, eol);
        add(stiffness, "rows only", cells_of_rows, rows);
    }
}

}  // namespace
}  // namespace arris
