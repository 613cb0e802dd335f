// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/velocity_solve/pinned_base.h"
#include "solver/velocity_solve/velocity_solve.h"

namespace arris {

struct ActivePrediction {
    std::vector<char> is_active;  ///< one a coordinate
    int nlopt_evaluations = 0;
};

/// A guess at the active bounds, cheap and global: a few evaluations of NLopt's LD_LBFGS on the sparse
/// problem itself from `start` moved into its bounds; active is then where u - gradient / diagonal <= lower.
/// First-order accurate.
ActivePrediction predict_active_bounds(const VelocityProblem& problem, const Eigen::VectorXd& start);

/// The same from `iterate`, whose rows push on as they do there: NLopt's method knows bounds alone.
ActivePrediction predict_active_bounds(const VelocityProblem& problem, const ConstraintRows& constraints,
                                       const Iterate& iterate);

}  // namespace arris
