// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/step_friction.h"

#include "solver/friction/friction_budget.h"

namespace arris {

namespace {

/// Stores the solution's friction at the contacts: the next solve starts from it.
void store(Workspace& work)
{
    const double gamma = work.prediction.gamma;
    for (std::size_t r = 0; r < work.slip_contacts.size(); ++r) {
        const SlipContact& slipping = work.slip_contacts[r];
        ContactFriction& friction = work.contacts[slipping.contact].friction;
        const double budget = work.solution.budgets[r];
        friction = {Vec3::Zero(), Vec3::Zero(), budget / gamma};
        const bool is_sliding = work.solution.unlimited[r].norm() > budget;
        for (int d = 0; d < 2; ++d) {
            friction.force += work.solution.friction[r][d] / gamma * slipping.directions[d];
            if (is_sliding) friction.slip += work.solution.slip[r][d] * slipping.directions[d];
        }
    }
}

void count(const Workspace& work, StepReport& report)
{
    report.sticking = report.sliding = 0;
    report.friction_work = 0.0;
    for (std::size_t r = 0; r < work.slip_contacts.size(); ++r) {
        const double budget = work.solution.budgets[r];
        if (!(budget > 0.0)) continue;
        ++(work.solution.unlimited[r].norm() <= budget ? report.sticking : report.sliding);
        report.friction_work -=
            work.solution.friction[r].dot(work.solution.slip[r]) * report.dt / work.prediction.gamma;
    }
}

}  // namespace

SlippingCloth slipping_cloth(const Scene& scene, const State& state, const Workspace& work)
{
    return {scene,         state,    work.mesh.stars, work.mesh.elements, work.prediction,
            work.carriers, work.eol, work.contacts,   work.linearization};
}

void set_friction_law(const Scene& scene, const State& state, Workspace& work)
{
    work.problem.law = [&scene, &state, &work](const VelocitySolution& solution) {
        return compute_budgets(slipping_cloth(scene, state, work), work.mesh.terms, work.slip_contacts,
                               solution);
    };
}

void note_friction(const State& state, Workspace& work, StepReport& report)
{
    const VelocitySolution& solution = work.solution;
    report.friction_sweeps += solution.budget_moves;
    report.friction_residual = solution.law_residual;
    if (solution.law_worst >= 0)
        report.friction_place =
            state.mesh.world[work.contacts[work.slip_contacts[solution.law_worst].contact].vertices[0]];
    store(work);
    count(work, report);
}

}  // namespace arris
