// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/material_flow.h"

#include <gtest/gtest.h>

#include <limits>

#include "solver/step_mesh.h"
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
    EXPECT_EQ(parts_of(flowing(0.55)), 1);
    EXPECT_EQ(parts_of(flowing(0.65)), 2);
    EXPECT_EQ(parts_of(flowing(1.15)), 2);
    EXPECT_EQ(parts_of(flowing(1.25)), 4);
}

TEST(FlowParts, DependOnTheStep)
{
    EXPECT_EQ(parts_of(flowing(0.7), 0.5 * kStep), 1);
    EXPECT_EQ(parts_of(flowing(0.5), 2.0 * kStep), 2);
    EXPECT_EQ(parts_of(flowing(0.5), 0.0), 1);
}

TEST(FlowParts, AreBoundedHoweverWildTheFlow)
{
    EXPECT_EQ(parts_of(flowing(1e12)), 4);
    EXPECT_EQ(parts_of(flowing(std::numeric_limits<double>::infinity())), 4);
}

TEST(FlowParts, CountOnlyWhatIsEol)
{
    EolCloth cloth = flowing(1.25);
    cloth.state.eol.clear();
    EXPECT_EQ(parts_of(cloth), 1);
}

/// Whether the mesh has the material that flows in a step through the vertex at (0.2, 0.2) of flat cloth on
/// the ridge, as far as (m) across it; `overrun` are the vertices named.
bool has_material_for(double way, std::vector<Overrun>& overrun)
{
    EolCloth cloth(testing::make_ridge(60.0), testing::make_draped({8, 0.0, 180.0}));
    const int v = cloth.vertex_at(0.2, 0.2);
    cloth.add_eol(v, false, tip_of(cloth.scene.obstacles[0]));
    Workspace work;
    prepare(cloth.scene, cloth.state, work);
    work.eol = {*cloth.place(v).coordinates};
    work.prediction.material = cloth.state.mesh.material;
    work.prediction.gamma = kStep;
    work.at.begin = 0.0;
    work.at.time = kStep;
    work.solution.velocity = Eigen::VectorXd::Zero(3 * cloth.state.mesh.vertex_count());
    work.solution.velocity[3 * v + 2] = way / kStep;
    const bool has_left = propose_flow(work);
    overrun = work.overrun;
    return has_left;
}

TEST(MaterialFlow, TakesHalfOfAFaceButNotAllOfIt)
{
    // Cells of 0.05 m halved by a diagonal: what goes by w takes w / 0.05 of a face ahead.
    std::vector<Overrun> overrun;
    for (const double sign : {1.0, -1.0}) {
        EXPECT_TRUE(has_material_for(sign * 0.55 * 0.05, overrun));
        EXPECT_TRUE(overrun.empty());
        for (const double way : {0.65, 0.99, 1.0, 1.5, 2.0, 1e3, 1e30}) {
            EXPECT_FALSE(has_material_for(sign * way * 0.05, overrun)) << way;
            ASSERT_FALSE(overrun.empty());
            EXPECT_NEAR(overrun[0].flow.norm(), way * 0.05 / kStep, 1e-9 * way * 0.05 / kStep);
        }
    }
    EXPECT_FALSE(has_material_for(std::numeric_limits<double>::quiet_NaN(), overrun));
    EXPECT_FALSE(has_material_for(std::numeric_limits<double>::infinity(), overrun));
}

}  // namespace
}  // namespace arris
