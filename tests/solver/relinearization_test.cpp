// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/relinearization.h"

#include <gtest/gtest.h>

#include "geometry/cloth_input/cloth_grid.h"
#include "solver/energy_balance.h"
#include "solver/step.h"

namespace arris {
namespace {

constexpr double kStep = 0.01;  // s

/// A sheet at rest after a step of implicit Euler; the tests then give its proposal a velocity.
struct Proposed {
    Scene scene;
    Settings settings;
    State state;
    Workspace work;
    StepReport report;

    explicit Proposed(const Vec3& velocity)
    {
        ClothGrid grid;
        grid.size = {0.5, 0.4};
        grid.resolution = {5, 4};
        scene.materials[0] = {0.05, 50.0, 0.3, 1e-5, 0.0, 1e-3};
        settings.integrator = Integrator::ImplicitEuler;
        state = make_state(scene, make_cloth_grid(grid), Vec3::Zero());
        EXPECT_EQ(step(scene, settings, kStep, state, work).status, StepStatus::Done);
        report.status = StepStatus::Done;
        work.least.at = {};  // as at the beginning of a step
        work.proposal.velocity.assign(state.velocity.size(), velocity);
        work.proposal.material_velocity.assign(state.velocity.size(), Vec2::Zero());
        work.proposal.world =
            find_end(work.prediction, {work.proposal.velocity, work.proposal.material_velocity}).world;
        measure_proposal_energy(scene, kStep, work);
    }

    Next keep(Attempt attempt, bool may_solve_again)
    {
        return enforce_energy_balance(scene, state, attempt, may_solve_again, work, report);
    }
};

const Vec3 kDriven(0.3, 0.0, 0.4);  // m/s, without a driving force

TEST(KeepEnergy, SolvesAgainAtWhatWasFoundThenFailsOrTakesTheLeast)
{
    Proposed proposed(kDriven);
    EXPECT_EQ(proposed.keep(Attempt::Ordinary, true), Next::Assemble);
    EXPECT_EQ(proposed.report.relinearisations, 1);
    EXPECT_EQ(proposed.work.expansion.world, proposed.work.proposal.velocity);

    Proposed last(kDriven);
    EXPECT_EQ(last.keep(Attempt::Ordinary, false), Next::Fail);
    EXPECT_EQ(last.report.status, StepStatus::EnergyRise);

    Proposed resort(kDriven);
    EXPECT_EQ(resort.keep(Attempt::Last, false), Next::Assemble);
    EXPECT_TRUE(resort.work.least.is_taken);
    EXPECT_EQ(resort.keep(Attempt::Last, false), Next::Accept) << "whatever it is";
    EXPECT_EQ(resort.report.status, StepStatus::Done);
    EXPECT_GT(resort.report.energy_rise, 0.0);
}

// Forces may be linearised again because material ran out, before any energy is measured.
TEST(KeepEnergy, TheLeastIsOfThisStepAlsoWhereItIsNotTheFirstLinearisation)
{
    Proposed proposed(kDriven);
    proposed.report.relinearisations = 1;
    proposed.work.least.rise = 0.0;  // left by an earlier step
    const ClothVelocity expansion = proposed.work.expansion;
    EXPECT_EQ(proposed.keep(Attempt::Last, false), Next::Assemble);
    EXPECT_EQ(proposed.work.expansion.world, expansion.world);
    EXPECT_GT(proposed.work.least.rise, 0.0);
}

TEST(KeepEnergy, WhatWasTakenAndRisesAfterAllFailsAnOrdinaryAttempt)
{
    Proposed proposed(kDriven);
    proposed.work.least.is_taken = true;
    EXPECT_EQ(proposed.keep(Attempt::Ordinary, true), Next::Fail);
    EXPECT_EQ(proposed.report.status, StepStatus::EnergyRise);
}

TEST(FallBack, IsToAVelocityThatRaisedNoEnergyAndOnce)
{
    Proposed proposed(Vec3::Zero());
    proposed.report.status = StepStatus::NotConverged;
    EXPECT_FALSE(restore_least_rise(proposed.work, proposed.report)) << "there was none";
    proposed.report.status = StepStatus::Done;
    EXPECT_EQ(proposed.keep(Attempt::Ordinary, true), Next::Accept);
    const ClothVelocity good = proposed.work.expansion;
    proposed.work.expansion.world.front() = kDriven;
    proposed.report.status = StepStatus::EnergyRise;  // a status with other retries
    EXPECT_FALSE(restore_least_rise(proposed.work, proposed.report));
    proposed.report.status = StepStatus::Overrun;
    EXPECT_TRUE(restore_least_rise(proposed.work, proposed.report));
    EXPECT_EQ(proposed.work.expansion.world, good.world);
    EXPECT_FALSE(restore_least_rise(proposed.work, proposed.report));
}

}  // namespace
}  // namespace arris
