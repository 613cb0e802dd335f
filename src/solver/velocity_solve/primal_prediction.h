// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/velocity_solve/pinned_base.h"
#include "solver/velocity_solve/velocity_solve.h"

namespace arris {

struct ActivePrediction {
    std::vector<char> is_active;  ///< one a coordinate
    int nlopt_evaluations = 0;
};

/// A cheap global guess of the active bounds: a few evaluations of NLopt's LD_LBFGS on the sparse problem,
/// from `start` moved into its bounds. A bound counts as active where u - gradient / diagonal <= lower.
/// First-order accurate.
ActivePrediction predict_active_bounds(const VelocityProblem& problem, const Eigen::VectorXd& start);

/// The guess from `iterate`, with the impulses of its rows kept constant, as NLopt's method handles only
/// bounds.
ActivePrediction predict_active_bounds(const VelocityProblem& problem, const ConstraintRows& constraints,
                                       const Iterate& iterate);

}  // namespace arris
