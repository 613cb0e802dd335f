// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/material_flow.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/solver/eol_cloth.h"

namespace arris {
namespace {

using testing::EolCloth;
using testing::lying;
using testing::tip_of;

constexpr double kStep = 0.005;  // s

/// Cloth on the ridge with one EOL vertex through which material flows by `share` of a cell a step, another
/// through which none does.
EolCloth flowing(double share)
{
    EolCloth cloth = lying(0.0);
    const int tip = tip_of(cloth.scene.obstacles[0]);
    const int still = cloth.vertex_at(0.2, 0.1), moving = cloth.vertex_at(0.2, 0.3);
    cloth.add_eol(still, false, tip);
    cloth.add_eol(moving, false, tip);
    const double cell = cloth.scene.eol->length(cloth.state.mesh.material[moving]);
    cloth.state.material_velocity[moving] = share * cell / kStep * Vec2(0.6, -0.8);
    return cloth;
}

int parts_of(const EolCloth& cloth, double dt = kStep)
{
    return find_flow_parts(cloth.scene, cloth.state, dt);
}

TEST(FlowParts, AreAsManyAsTheFastestFlowNeeds)
{
    EXPECT_EQ(parts_of(lying(0.0)), 1);
    EXPECT_EQ(parts_of(flowing(0.0)), 1);
    EXPECT_EQ(parts_of(flowing(0.3)), 1);
    EXPECT_EQ(parts_of(flowing(0.4)), 2);
    EXPECT_EQ(parts_of(flowing(0.65)), 2);
    EXPECT_EQ(parts_of(flowing(0.8)), 4);
}

TEST(FlowParts, DependOnTheStep)
{
    EXPECT_EQ(parts_of(flowing(0.4), 0.5 * kStep), 1);
    EXPECT_EQ(parts_of(flowing(0.3), 2.0 * kStep), 2);
    EXPECT_EQ(parts_of(flowing(0.3), 0.0), 1);
}

TEST(FlowParts, AreBoundedHoweverWildTheFlow)
{
    EXPECT_EQ(parts_of(flowing(1e12)), 4);
    EXPECT_EQ(parts_of(flowing(std::numeric_limits<double>::infinity())), 4);
}

TEST(FlowParts, CountOnlyWhatIsEol)
{
    EolCloth cloth = flowing(0.8);
    cloth.state.eol.clear();
    EXPECT_EQ(parts_of(cloth), 1);
}

}  // namespace
}  // namespace arris
