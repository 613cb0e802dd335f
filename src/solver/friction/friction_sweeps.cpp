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

double residual_of(const VelocitySolution& solution, const std::vector<double>& budgets)
{
    double error = 0.0, largest = 0.0;
    for (std::size_t p = 0; p < budgets.size(); ++p) {
        const Eigen::Vector2d law = project_on_disc(solution.unlimited[p], budgets[p]);
        error = std::max(error, (solution.friction[p] - law).norm());
        largest = std::max(largest, budgets[p]);
    }
    return error > 0.0 ? error / std::max(largest, error) : 0.0;
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
        if (solution.status != SolveStatus::Certified || problem.friction.empty()) return sweeps;
        const std::vector<double> budgets = compute(solution);
        sweeps.residual = residual_of(solution, budgets);
        const bool is_last = sweeps.residual <= kAgreement || sweeps.count == kMostSweeps;
        const double share = is_last || sweeps.count <= kFullSweeps ? 1.0 : 0.5;
        for (std::size_t p = 0; p < budgets.size(); ++p)
            problem.friction[p].budget += share * (budgets[p] - problem.friction[p].budget);
        if (is_last) return sweeps;
    }
}

}  // namespace arris
