// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/retry_policy.h"

#include <gtest/gtest.h>

namespace arris {
namespace {

State state_with_eol(std::vector<std::uint32_t> vertices)
{
    State state;
    state.ids = {0, 1, 2, 3, 4};
    for (const std::uint32_t v : vertices) state.eol.push_back({v, FeatureId::edge(0, 0), {0, 0, 1}, 0});
    return state;
}

StepReport with(StepStatus status)
{
    StepReport report;
    report.status = status;
    return report;
}

TEST(RetryPolicy, WhatOverrunsIsClearedThenShortenedThenGivenUpOneByOneThenAll)
{
    const State state = state_with_eol({1, 2, 3});
    RetryPolicy failed;
    const std::vector<Overrun> overrun = {{2, {1.0, 0.0}}};
    const auto fail = [&] {
        failed.note(with(StepStatus::Overrun), Attempt::Ordinary, state, state, {overrun});
    };
    fail();
    EXPECT_TRUE(failed.has_new_mesh());
    EXPECT_EQ(failed.flow().flow.at(2), Vec2(1.0, 0.0));
    EXPECT_TRUE(failed.flow().given_up.empty());
    fail();
    EXPECT_FALSE(failed.has_new_mesh());  // a shorter step comes first
    EXPECT_TRUE(failed.flow().given_up.empty());
    for (int k = 3; k <= RetryPolicy::kMostOverruns; ++k) {
        fail();
        EXPECT_TRUE(failed.has_new_mesh());
        EXPECT_EQ(failed.flow().given_up, (std::set<VertexId>{2}));
    }
    fail();
    EXPECT_TRUE(failed.has_new_mesh());
    EXPECT_EQ(failed.flow().given_up, (std::set<VertexId>{1, 2, 3}));
    fail();
    EXPECT_FALSE(failed.has_new_mesh());  // bounded, even if attempts keep failing
}

TEST(RetryPolicy, WhatIsNewIsGivenUpByItsPlace)
{
    const State state = state_with_eol({1});
    State start = state_with_eol({1, 3});
    start.mesh.material = {{0.0, 0.0}, {1.0, 0.0}, {2.0, 0.0}, {3.0, 0.0}, {4.0, 0.0}};
    RetryPolicy failed;
    const auto fail = [&](Attempt attempt) {
        failed.note(with(StepStatus::Overrun), attempt, state, start, {{{3, {1.0, 0.0}}}});
    };
    fail(Attempt::Ordinary);
    EXPECT_TRUE(failed.has_new_mesh()) << "a shorter step would cost more";
    EXPECT_FALSE(failed.has_given_up_all());
    EXPECT_EQ(failed.flow().made_at, (std::vector<Vec2>{{3.0, 0.0}}));
    EXPECT_TRUE(failed.flow().given_up.empty()) << "the next attempt's vertex may have another id";

    failed.forget();
    fail(Attempt::Last);
    EXPECT_TRUE(failed.has_new_mesh());
    EXPECT_EQ(failed.flow().made_at.size(), 1u) << "there is no shorter step";
}

TEST(RetryPolicy, WhereNoShorterStepIsLeftAnotherMeshIsTried)
{
    const State state = state_with_eol({1, 2});
    RetryPolicy failed;
    for (int k = 0; k <= RetryPolicy::kMostOverruns; ++k) {
        failed.note(with(StepStatus::Overrun), Attempt::Last, state, state, {{{1, {1.0, 0.0}}}});
        EXPECT_TRUE(failed.has_new_mesh()) << k;
    }
    EXPECT_EQ(failed.flow().given_up.size(), 2u);
    for (const StepStatus status :
         {StepStatus::NotConverged, StepStatus::NotFinite, StepStatus::Penetration, StepStatus::Infeasible}) {
        RetryPolicy other;
        other.note(with(status), Attempt::Last, state, state, {});
        EXPECT_TRUE(other.has_new_mesh());
        EXPECT_EQ(other.flow().given_up.size(), 2u);
        const State none = state_with_eol({});
        other.note(with(status), Attempt::Last, none, none, {});
        EXPECT_FALSE(other.has_new_mesh());  // all EOL vertices are demoted, and the step still fails
    }
}

TEST(RetryPolicy, WhatAllWasGivenUpForStaysSoForTheRestOfTheStep)
{
    const State state = state_with_eol({1, 2});
    RetryPolicy failed;
    failed.note(with(StepStatus::Overrun), Attempt::Ordinary, state, state, {{{1, {1.0, 0.0}}}});
    failed.note(with(StepStatus::Done), Attempt::Ordinary, state, state, {});
    EXPECT_TRUE(failed.flow().empty());
    EXPECT_FALSE(failed.has_given_up_all());
    failed.note(with(StepStatus::EnergyRise), Attempt::Last, state, state, {});
    failed.note(with(StepStatus::Done), Attempt::Ordinary, state, state, {});
    EXPECT_TRUE(failed.has_given_up_all());
    EXPECT_EQ(failed.flow().given_up.size(), 2u);
    failed.forget();
    EXPECT_FALSE(failed.has_given_up_all());
    EXPECT_TRUE(failed.flow().empty());
}

TEST(RetryPolicy, WhatContactsPinchIsGivenUpBeforeAShorterStepIsTried)
{
    const State state = state_with_eol({1, 2, 3});
    RetryPolicy failed;
    for (int k = 0; k < RetryPolicy::kMostOverconstrained; ++k) {
        failed.note(with(StepStatus::Infeasible), Attempt::Ordinary, state, state, {{}, {2}});
        EXPECT_TRUE(failed.has_new_mesh()) << k;
        EXPECT_EQ(failed.flow().given_up, (std::set<VertexId>{2}));
    }
    failed.note(with(StepStatus::Infeasible), Attempt::Ordinary, state, state, {{}, {2}});
    EXPECT_FALSE(failed.has_new_mesh());  // such attempts are bounded
    failed.forget();
    failed.note(with(StepStatus::Infeasible), Attempt::Ordinary, state, state, {});
    EXPECT_FALSE(failed.has_new_mesh());  // with rows alone no other mesh helps
    EXPECT_TRUE(failed.flow().given_up.empty());
}

TEST(RetryPolicy, OfStateAndOfWhatConformMadeOfItAllAreGivenUp)
{
    const State state = state_with_eol({1, 2}), start = state_with_eol({2, 4});
    RetryPolicy failed;
    failed.note(with(StepStatus::NotConverged), Attempt::Ordinary, state, start, {});
    EXPECT_FALSE(failed.has_new_mesh());
    EXPECT_TRUE(failed.flow().empty());
    failed.note(with(StepStatus::NotFinite), Attempt::Ordinary, state, start, {});
    EXPECT_EQ(failed.flow().given_up, (std::set<VertexId>{1, 2, 4}));
}

TEST(RetryPolicy, AStepThatIsDoneForgets)
{
    const State state = state_with_eol({1});
    RetryPolicy failed;
    failed.note(with(StepStatus::Overrun), Attempt::Last, state, state, {{{1, {1.0, 0.0}}}});
    failed.note(with(StepStatus::Done), Attempt::Last, state, state, {});
    EXPECT_FALSE(failed.has_new_mesh());
    EXPECT_TRUE(failed.flow().empty());
}

// Going round a wire moves a vertex outside the equations of motion. If this motion raises the energy, it is
// switched off for the rest of the planned step.
TEST(RetryPolicy, WhereTurningRaisesTheEnergyVerticesStay)
{
    const State state = state_with_eol({1});
    const auto fail = [&](RetryPolicy& failed, StepStatus status, bool has_turned) {
        failed.note(with(status), Attempt::Ordinary, state, state, {{}, {}, has_turned});
    };
    RetryPolicy failed;
    EXPECT_TRUE(failed.may_turn());
    fail(failed, StepStatus::EnergyRise, false);
    EXPECT_FALSE(failed.has_stopped_turning());
    EXPECT_TRUE(failed.may_turn());
    fail(failed, StepStatus::EnergyRise, true);
    EXPECT_TRUE(failed.has_stopped_turning());
    EXPECT_FALSE(failed.may_turn());
    fail(failed, StepStatus::EnergyRise, false);
    EXPECT_FALSE(failed.has_stopped_turning());  // reported once
    fail(failed, StepStatus::Done, false);
    EXPECT_FALSE(failed.may_turn());  // still off in the rest of the planned step
    failed.forget();
    EXPECT_TRUE(failed.may_turn());
    fail(failed, StepStatus::NotConverged, true);
    EXPECT_TRUE(failed.may_turn());
}

TEST(RetryPolicy, TakesTheFirstRungThatApplies)
{
    const State state = state_with_eol({1});
    const auto next = [](const RetryPolicy& policy, StepStatus status, bool has_history, bool is_shortest) {
        return policy.choose_next(
            {status, is_shortest ? Attempt::Last : Attempt::Ordinary, has_history, is_shortest});
    };
    RetryPolicy plain;
    plain.note(with(StepStatus::EnergyRise), Attempt::Ordinary, state, state, {});
    EXPECT_EQ(next(plain, StepStatus::EnergyRise, true, false), NextAttempt::WithoutHistory);
    EXPECT_EQ(next(plain, StepStatus::EnergyRise, false, false), NextAttempt::Shorter);
    EXPECT_EQ(next(plain, StepStatus::Penetration, true, false), NextAttempt::Shorter);
    EXPECT_EQ(next(plain, StepStatus::Penetration, true, true), NextAttempt::None);

    RetryPolicy turned;
    turned.note(with(StepStatus::EnergyRise), Attempt::Ordinary, state, state, {{}, {}, true});
    EXPECT_EQ(next(turned, StepStatus::EnergyRise, true, false), NextAttempt::WithoutTurning);

    RetryPolicy overrun;
    overrun.note(with(StepStatus::Overrun), Attempt::Ordinary, state, state, {{{1, {1.0, 0.0}}}});
    EXPECT_EQ(next(overrun, StepStatus::Overrun, true, false), NextAttempt::OnNewMesh);
    overrun.note(with(StepStatus::Overrun), Attempt::Ordinary, state, state, {{{1, {1.0, 0.0}}}});
    EXPECT_EQ(next(overrun, StepStatus::Overrun, true, false), NextAttempt::Shorter);

    RetryPolicy last;
    last.note(with(StepStatus::NotConverged), Attempt::Last, state, state, {});
    EXPECT_EQ(next(last, StepStatus::NotConverged, true, true), NextAttempt::WholeWithoutEol);
    const State none = state_with_eol({});
    last.note(with(StepStatus::NotConverged), Attempt::Last, none, none, {});
    EXPECT_EQ(next(last, StepStatus::NotConverged, true, true), NextAttempt::None);
}

TEST(RetryPolicy, TakesLastResortsAtTheShortestPartOrAfterMuchWork)
{
    const State state = state_with_eol({1, 2});
    StepReport costly = with(StepStatus::NotConverged), done = with(StepStatus::Done);
    costly.solve_work = 0.3 * RetryPolicy::kMostWork;
    done.solve_work = 0.5 * RetryPolicy::kMostWork;
    RetryPolicy policy;
    EXPECT_EQ(policy.choose_attempt(false), Attempt::Ordinary);
    EXPECT_EQ(policy.choose_attempt(true), Attempt::Last);
    policy.note(costly, Attempt::Ordinary, state, state, {});
    policy.note(done, Attempt::Ordinary, state, state, {});
    EXPECT_EQ(policy.choose_attempt(false), Attempt::Ordinary);
    policy.note(costly, Attempt::Ordinary, state, state, {});
    EXPECT_EQ(policy.choose_attempt(false), Attempt::Last) << "parts that were accepted count";
    // With EOL vertices a last attempt takes no last resorts. So the next one has none, and is long again.
    policy.note(costly, Attempt::Last, state, state, {});
    EXPECT_EQ(policy.choose_next({StepStatus::NotConverged, Attempt::Last, false, false}),
              NextAttempt::WholeWithoutEol);
    policy.forget();
    EXPECT_EQ(policy.choose_attempt(false), Attempt::Ordinary);
}

// The attempts at a step end, whichever failure recurs.
TEST(RetryPolicy, ComesToAnEnd)
{
    for (const StepStatus status :
         {StepStatus::Overrun, StepStatus::Infeasible, StepStatus::Penetration, StepStatus::EnergyRise,
          StepStatus::NotConverged, StepStatus::NotFinite}) {
        RetryPolicy policy;
        int shrink = 1, attempts = 0;
        bool has_history = true;
        for (NextAttempt next = NextAttempt::Shorter; next != NextAttempt::None && attempts < 1000;
             ++attempts) {
            const bool is_shortest = shrink == RetryPolicy::kMostParts;
            const Attempt attempt = policy.choose_attempt(is_shortest);
            const State state = state_with_eol(policy.has_given_up_all() ? std::vector<std::uint32_t>()
                                                                         : std::vector<std::uint32_t>{1, 2});
            policy.note(with(status), attempt, state, state,
                        state.eol.empty() ? Failure() : Failure{{{1, {1.0, 0.0}}}, {2}, true});
            next = policy.choose_next({status, attempt, has_history, is_shortest});
            if (next == NextAttempt::Shorter) shrink *= 2;
            if (next == NextAttempt::WholeWithoutEol) shrink = 1;
            if (next == NextAttempt::WithoutHistory) has_history = false;
        }
        EXPECT_LT(attempts, 100) << static_cast<int>(status);
    }
}

}  // namespace
}  // namespace arris
