// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/step_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/solver/eol_cloth.h"

namespace arris {
namespace {

using testing::EolCloth;
using testing::kLyingCell;
using testing::kStep;
using testing::lying;
using testing::press_edges;

/// A trace half a cell beside a row of vertices that stands up, as a pleat does, and behind which a pin holds
/// the cloth: merged into the trace it would leave the cloth too short, by 5 %. The trace flows towards it, a
/// quarter of a cell a step.
EolCloth heading_for_pleat(double youngs_modulus)
{
    EolCloth cloth = lying(0.0);
    cloth.scene.gravity = Gravity{};
    cloth.scene.material.youngs_modulus = youngs_modulus;
    press_edges(cloth);
    testing::take(cloth);

    Pin pin;
    pin.material = {Vec2(4.9 * kLyingCell, 0.0), Vec2(0.4, 0.4)};
    cloth.scene.pins = {pin};
    constexpr double kHeight = 0.2;  // cells
    const double before = 0.5 - std::sqrt(0.25 - kHeight * kHeight);
    const double behind = 1.0 - std::sqrt(1.0 - kHeight * kHeight);
    for (std::size_t v = 0; v < cloth.state.mesh.world.size(); ++v) {
        const double u = cloth.state.mesh.material[v].x() / kLyingCell;
        if (u < 3.6) continue;
        const bool is_pleat = u < 4.5;
        cloth.state.mesh.world[v].x() -= (is_pleat ? before : before + behind) * kLyingCell;
        if (is_pleat) cloth.state.mesh.world[v].z() += kHeight * kLyingCell;
    }
    for (const EolVertex& e : cloth.state.eol)
        cloth.state.material_velocity[cloth.state.index_of(e.vertex_id)] =
            Vec2(0.25 * kLyingCell / kStep, 0.0);
    press_edges(cloth);
    return cloth;
}

TEST(StepMesh, ClearsATracesWayByForceWhereThatStrainsLittle)
{
    // By .047 and .2 of what moves the cloth around; kTraceStrain is .06.
    for (const double youngs_modulus : {200.0, 800.0}) {
        EolCloth cloth = heading_for_pleat(youngs_modulus);
        for (const StrainLimit limit : {StrainLimit::GivesWay, StrainLimit::AsMade})
            EXPECT_GT(testing::conform_cloth(cloth, {}, {.strain = limit}).blocked, 0)
                << "nothing gentler does";
        Workspace work;
        prepare(cloth.scene, cloth.state, work);
        StepReport report;
        const std::size_t eol = cloth.state.eol.size();
        ASSERT_GT(eol, 6u);
        const State& start = conform(cloth.scene, cloth.state.time + kStep, cloth.state, work, report);
        const auto blocked =
            std::count_if(work.refused.begin(), work.refused.end(),
                          [](const RefusedContact& refused) { return refused.cause == RowCause::Blocked; });
        if (youngs_modulus < 500.0) {
            EXPECT_EQ(blocked, 0);
            EXPECT_EQ(start.eol.size(), eol);
        } else {
            EXPECT_GT(blocked, 0);
            EXPECT_LT(start.eol.size(), eol);
        }
    }
}

}  // namespace
}  // namespace arris
