// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/friction/friction_sweeps.h"

#include <algorithm>

#include "solver/velocity_solve/condensed_discs.h"

namespace arris {

namespace {

constexpr int kMostSweeps = 12;

/// Residual at which sweeps end.
constexpr double kAgreement = 1e-4;

/// Sweeps after which budgets move only half the way: two contacts may take turns to press.
constexpr int kFullSweeps = 6;

/// Sets `residual` and `worst`.
void compare_with_law(const VelocitySolution& solution, const std::vector<double>& budgets,
                      FrictionSweeps& sweeps)
{
    double error = 0.0, largest = 0.0;
    sweeps.worst = -1;
    for (std::size_t p = 0; p < budgets.size(); ++p) {
        const double difference =
            (solution.friction[p] - project_on_disc(solution.unlimited[p], budgets[p])).norm();
        if (difference > error) sweeps.worst = static_cast<int>(p);
        error = std::max(error, difference);
        largest = std::max(largest, budgets[p]);
    }
    sweeps.residual = error > 0.0 ? error / std::max(largest, error) : 0.0;
}

}  // namespace

FrictionSweeps sweep_friction(const std::function<const VelocitySolution&()>& solve,
                              const std::function<std::vector<double>(const VelocitySolution&)>& compute,
                              VelocityProblem& problem)
{
    FrictionSweeps sweeps;
    for (;;) {
        const VelocitySolution& solution = solve();
        ++sweeps.count;
        if (solution.status == SolveStatus::NotConverged) return sweeps;
        sweeps.certified.reset();
        if (solution.status != SolveStatus::Certified || problem.friction.empty()) return sweeps;
        const std::vector<double> budgets = compute(solution);
        compare_with_law(solution, budgets, sweeps);
        const bool is_last =
            sweeps.residual <= kAgreement || sweeps.count == kMostSweeps || problem.most_factorisations <= 0;
        const double share = is_last || sweeps.count <= kFullSweeps ? 1.0 : 0.5;
        for (std::size_t p = 0; p < budgets.size(); ++p)
            problem.friction[p].budget += share * (budgets[p] - problem.friction[p].budget);
        if (is_last) return sweeps;
        sweeps.certified = solution;
    }
}

}  // namespace arris
