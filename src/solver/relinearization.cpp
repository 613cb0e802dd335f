// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/relinearization.h"

#include <cassert>
#include <utility>
#include <vector>

#include "solver/contact/constraints.h"
#include "solver/energy_balance.h"
#include "solver/material_flow.h"

namespace arris {

namespace {

// Least share of the way from v^ to the velocity found that v^ goes. Where the objective grows, v^ goes that
// far nevertheless, as the objective lacks wind and pulls. Raising it fails more steps.
constexpr double kShortest = 0.1;

constexpr int kMostRelinearisations = 4;  // one nearly always suffices; where any help, three do

/// Sets v^ to `next`, and marks the contacts that press now for the next solve.
void expand_at(ClothVelocity next, Workspace& work, StepReport& report)
{
    const std::vector<double> multiplier = contact_multipliers(work.contacts, work.solution);
    for (std::size_t c = 0; c < work.contacts.size(); ++c) work.contacts[c].is_pressing = multiplier[c] > 0.0;
    work.expansion = std::move(next);
    ++report.relinearisations;
}

/// Moves v^ to the velocity found. If `is_measure`, v^ goes only part of the way where the step's objective
/// would grow.
void relinearise(const Scene& scene, bool is_measure, Workspace& work, StepReport& report)
{
    ClothVelocity next = {work.proposal.velocity, work.proposal.material_velocity};
    if (is_measure) {
        const double now = compute_step_objective(scene, work, work.expansion);
        for (double share = 1.0; compute_step_objective(scene, work, next) > now && share > kShortest;) {
            share *= 0.5;
            next = blend(work.expansion, next, 0.5);
        }
    }
    expand_at(std::move(next), work, report);
}

void take_least(Workspace& work)
{
    assert(work.least.at.world.size() == work.expansion.world.size());
    work.expansion = work.least.at;
    work.least.is_taken = true;
}

}  // namespace

Next enforce_energy_balance(const Scene& scene, const State& state, Attempt attempt, bool may_solve_again,
                            Workspace& work, StepReport& report)
{
    const double rise = find_energy_rise(scene, state, work);
    report.energy_rise = rise;
    const auto fail = [&] {
        report.status = StepStatus::EnergyRise;
        return Next::Fail;
    };
    const bool is_first = work.least.at.world.empty();
    if (is_first || rise < work.least.rise) {
        work.least.rise = rise;
        work.least.at = work.expansion;
    }
    if (work.least.is_taken) {  // constraints added since may have raised the energy
        return rise > 0.0 && attempt == Attempt::Ordinary ? fail() : Next::Accept;
    }
    const bool may_again = report.relinearisations < kMostRelinearisations && may_solve_again;
    if (may_again && (rise > 0.0 || find_unforeseen_energy(scene, state, work) > 0.0)) {
        relinearise(scene, !is_first, work,
                    report);  // the first v^ ignores contacts, so its objective is no measure
        return Next::Assemble;
    }
    if (!(rise > 0.0)) return Next::Accept;
    // Fail where another attempt may do better: there is history to drop, or every linearization raised the
    // energy. Else take the linearization with the least rise.
    if (attempt == Attempt::Ordinary && (work.prediction.has_history || work.least.rise > 0.0)) return fail();
    take_least(work);
    return Next::Assemble;
}

bool restore_least_rise(Workspace& work, StepReport& report)
{
    const bool was_good = !work.least.at.world.empty() && !(work.least.rise > 0.0);
    if (!was_good || work.least.is_taken || report.status == StepStatus::EnergyRise) return false;
    take_least(work);
    return true;
}

bool linearise_nearer(double dt, Workspace& work, StepReport& report)
{
    if (report.relinearisations >= kMostRelinearisations) return false;
    ClothVelocity next = {work.proposal.velocity, work.proposal.material_velocity};
    const auto has_overrun = [&] {
        return !find_overrun(find_end(work.prediction, next).material, work.eol, work.mesh, dt).empty();
    };
    for (double share = 1.0; has_overrun();) {
        share *= 0.5;
        if (!(share > kShortest)) return false;
        next = blend(work.expansion, next, 0.5);
    }
    expand_at(std::move(next), work, report);
    return true;
}

}  // namespace arris
