// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/relinearization.h"

#include <utility>
#include <vector>

#include "solver/constraints.h"
#include "solver/energy_balance.h"

namespace arris {

namespace {

/// v^ goes to the velocity found, or part of the way where that has more of what the step minimises.
void relinearise(const Scene& scene, Workspace& work, StepReport& report)
{
    constexpr double kShortest = 0.1;  // wind and pulls are not in the objective: never stay
    const std::vector<double> multiplier = contact_multipliers(work.contacts, work.solution);
    for (std::size_t c = 0; c < work.contacts.size(); ++c) work.contacts[c].is_pressing = multiplier[c] > 0.0;

    ClothVelocity next = {work.proposal.velocity, work.proposal.material_velocity};
    if (report.relinearisations > 0) {  // the first v^ keeps no contact: no measure
        const double now = compute_step_objective(scene, work, work.expansion);
        for (double share = 1.0; compute_step_objective(scene, work, next) > now && share > kShortest;) {
            share *= 0.5;
            for (std::size_t v = 0; v < next.world.size(); ++v) {
                next.world[v] = 0.5 * (next.world[v] + work.expansion.world[v]);
                next.material[v] = 0.5 * (next.material[v] + work.expansion.material[v]);
            }
        }
    }
    work.expansion = std::move(next);
    work.has_system = false;
    ++report.relinearisations;
}

}  // namespace

bool keep_energy(const Scene& scene, const State& state, Attempt attempt, bool may_solve_again,
                 Workspace& work, StepReport& report)
{
    constexpr int kMostRelinearisations = 4;  // one does nearly always, three have where they help at all
    const double rise = find_energy_rise(scene, state, work);
    report.energy_rise = rise;
    if (work.is_least_taken) return false;
    if (report.relinearisations == 0 || rise < work.least_rise) {
        work.least_rise = rise;
        work.least_at = work.expansion;
    }
    const bool may_again = report.relinearisations < kMostRelinearisations && may_solve_again;
    if (may_again && (rise > 0.0 || find_unforeseen_energy(scene, work) > 0.0)) {
        relinearise(scene, work, report);
        return true;
    }
    if (!(rise > 0.0)) return false;
    // Where history is what rises, without it nothing may; else what was found first will do.
    if (attempt == Attempt::Ordinary && (work.prediction.has_history || work.least_rise > 0.0)) {
        report.status = StepStatus::EnergyRise;
        return false;
    }
    work.expansion = work.least_at;
    work.has_system = false;
    work.is_least_taken = true;
    return true;
}

}  // namespace arris
