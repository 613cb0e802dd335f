// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/material_flow.h"

#include <gtest/gtest.h>

#include <limits>

#include "solver/step.h"
#include "tests/solver/eol_cloth.h"

namespace arris {
namespace {

using testing::EolCloth;
using testing::lying;
using testing::tip_of;

constexpr double kStep = 0.005;  // s

/// Cloth on the ridge with two EOL vertices. Through one, `share` of a cell of material flows in a step;
/// through the other, none.
EolCloth flowing(double share)
{
    EolCloth cloth = lying(0.0);
    const int tip = tip_of(cloth.scene.obstacles[0].shape());
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

/// Flat cloth on the ridge with cells of 0.05 m halved by a diagonal. An EOL vertex is in its middle; its
/// velocity is not solved for yet.
struct FlowingCloth {
    EolCloth cloth{testing::make_ridge(60.0), testing::make_draped({8, 0.0, 180.0})};
    int v = cloth.vertex_at(0.2, 0.2);
    Workspace work;

    FlowingCloth()
    {
        cloth.add_eol(v, false, tip_of(cloth.scene.obstacles[0].shape()));
        prepare(cloth.scene, cloth.state, work);
        work.eol = {*cloth.place(v).coordinates};
        work.linearization.begin = 0.0;
        work.linearization.time = kStep;
        work.linearization.flow.emplace();
    }
    /// Sets the flow through the vertex: `now` and, one step ago, `before`, cells a step. The vertex rises at
    /// the present speed of flow.
    void flow(double now, double before)
    {
        State& state = cloth.state;
        state.previous_dt = kStep;
        state.previous_world = state.mesh.world;
        state.previous_material = state.mesh.material;
        const double cell = 0.05;
        state.material_velocity[v] = Vec2(now * cell / kStep, 0.0);
        state.previous_material_velocity[v] = Vec2(before * cell / kStep, 0.0);
        state.previous_material[v].x() -= before * cell;
        state.velocity[v] = Vec3(0.0, 0.0, now * cell / kStep);
        work.prediction = predict(state, Integrator::Bdf2, kStep);
        work.expansion = {state.velocity, state.material_velocity};
    }
    /// Linearises the flow in `work`, as a step does. Returns the vertices with too little material.
    std::vector<Overrun> linearise()
    {
        LinearisedFlow found =
            linearise_flow(cloth.state, work.prediction, work.expansion, work.eol, work.mesh, kStep);
        work.expansion = found.expansion;
        work.linearization.flow->position = found.position;
        work.linearization.flow->extrapolated = found.extrapolated;
        return found.overrun;
    }
    /// Least remaining area of a face at the vertex, over its present area.
    double least_left(const std::vector<Vec2>& material) const
    {
        double least = 1.0;
        for (const int f : work.mesh.stars.faces[v]) {
            const auto& [a, b, c] = cloth.state.mesh.faces[f];
            const double left = 0.5 * twice_area(material[a], material[b], material[c]);
            least = std::min(least, left / work.mesh.elements.faces[f].area);
        }
        return least;
    }
};

/// What a flow of `way` (m) across the ridge in a step finds to be overrun.
std::vector<Overrun> overrun_by(double way)
{
    FlowingCloth flowing;
    Workspace& work = flowing.work;
    const State& state = flowing.cloth.state;
    work.prediction.material = state.mesh.material;
    work.prediction.material_velocity = state.material_velocity;
    work.prediction.gamma = kStep;
    work.solution.velocity = Eigen::VectorXd::Zero(3 * state.mesh.vertex_count());
    work.solution.velocity[3 * flowing.v + 2] = way / kStep;
    const FlowedMaterial flowed = find_flowed_material(work.prediction, work.eol, work.solution.velocity);
    return find_overrun(flowed.material, work.eol, work.mesh, kStep);
}

TEST(MaterialFlow, IsLinearisedWhereItWouldEndAsLongAsThereIsMaterial)
{
    FlowingCloth flowing;
    flowing.flow(0.4, 0.4);
    const MovingCloth end = find_end(flowing.work.prediction, flowing.work.expansion);
    const std::vector<Vec3> expansion = flowing.work.expansion.world;
    ASSERT_TRUE(flowing.linearise().empty());
    EXPECT_EQ(flowing.work.linearization.flow->position, end.material);
    EXPECT_EQ(flowing.work.expansion.world, expansion);
}

TEST(MaterialFlow, IsLinearisedOnTheWayThereWhereThereIsNone)
{
    for (const double cells : {1.0, 1.5, 3.0, -1.0, 1e3, -1e12}) {
        SCOPED_TRACE(cells);
        FlowingCloth flowing;
        flowing.flow(cells, 0.0);
        const State& state = flowing.cloth.state;
        const int v = flowing.v;
        const MovingCloth end = find_end(flowing.work.prediction, flowing.work.expansion);
        ASSERT_TRUE(flowing.linearise().empty());
        const MovingCloth there = find_end(flowing.work.prediction, flowing.work.expansion);
        EXPECT_GE(flowing.least_left(there.material), 0.4);
        EXPECT_GE(flowing.least_left(flowing.work.linearization.flow->extrapolated.material), 0.4);
        // World and material positions have moved by the same share of their displacements.
        const double share =
            (there.material[v] - state.mesh.material[v]).x() / (end.material[v] - state.mesh.material[v]).x();
        EXPECT_NEAR((there.world[v] - state.mesh.world[v]).z(),
                    share * (end.world[v] - state.mesh.world[v]).z(), 1e-12);
        EXPECT_LT(share, 1.0);
        for (int w = 0; w < state.mesh.vertex_count(); ++w)
            EXPECT_TRUE(w == v || there.world[w] == end.world[w]) << w;
    }
}

TEST(MaterialFlow, ThatTurnsBackIsNotExtrapolatedPastTheMaterial)
{
    FlowingCloth flowing;
    flowing.flow(-0.4, 0.8);
    const std::vector<Vec2> past = extrapolate(flowing.cloth.state, flowing.work.prediction).material;
    ASSERT_LT(flowing.least_left(past), 0.4);
    EXPECT_TRUE(flowing.linearise().empty());
    EXPECT_GE(flowing.least_left(flowing.work.linearization.flow->extrapolated.material), 0.4);
}

TEST(MaterialFlow, ThatIsNotFiniteIsNotLinearised)
{
    for (const double cells :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        FlowingCloth flowing;
        flowing.flow(cells, 0.0);
        const std::vector<Overrun> overrun = flowing.linearise();
        ASSERT_FALSE(overrun.empty());
        EXPECT_EQ(overrun[0].vertex, flowing.v);
    }
}

TEST(MaterialFlow, TakesHalfOfAFaceButNotAllOfIt)
{
    // A flow by w uses up w / 0.05 of a face ahead.
    for (const double sign : {1.0, -1.0}) {
        EXPECT_TRUE(overrun_by(sign * 0.55 * 0.05).empty());
        for (const double way : {0.65, 0.99, 1.0, 1.5, 2.0, 1e3, 1e30}) {
            const std::vector<Overrun> overrun = overrun_by(sign * way * 0.05);
            ASSERT_FALSE(overrun.empty()) << way;
            EXPECT_NEAR(overrun[0].flow.norm(), way * 0.05 / kStep, 1e-9 * way * 0.05 / kStep);
        }
    }
    EXPECT_FALSE(overrun_by(std::numeric_limits<double>::quiet_NaN()).empty());
    EXPECT_FALSE(overrun_by(std::numeric_limits<double>::infinity()).empty());
}

}  // namespace
}  // namespace arris
