// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>

#include "solver/velocity_solve/velocity_solve.h"

namespace arris {

/// Outcome of the sweeps.
struct FrictionSweeps {
    int count = 0;          ///< solves
    double residual = 0.0;  ///< greatest |f - the law's impulse for the budget that the solution gives| /
                            ///< largest budget
    int worst = -1;         ///< friction pair with that difference
    /// The last certified solution, where a later sweep has not converged: the one to use.
    std::optional<VelocitySolution> certified;
};

/// Solves again, with budgets from the last solution, until the impulses agree with them: `solve` is the
/// problem's solve or resume, and takes its factorisations off `problem.most_factorisations`; `compute` gives
/// the budgets of a solution. Each sweep is a convex problem, so its answer is an admissible one even where
/// the sweeps end before they agree, or factorisations run out; the residual then tells by how much they do
/// not.
FrictionSweeps sweep_friction(const std::function<const VelocitySolution&()>& solve,
                              const std::function<std::vector<double>(const VelocitySolution&)>& compute,
                              VelocityProblem& problem);

}  // namespace arris
