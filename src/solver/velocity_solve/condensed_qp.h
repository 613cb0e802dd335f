// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "solver/model/settings.h"

namespace arris {

/// min 1/2 z^T S z + q^T z subject to z >= 0, with S dense, symmetric and positive definite.
struct CondensedQp {
    Eigen::MatrixXd hessian;  ///< S
    Eigen::VectorXd linear;   ///< q
};

/// A solution: either z >= 0 and w = S z + q is 0, or z is 0 and w >= 0.
struct CondensedAnswer {
    Eigen::VectorXd z, w;
    std::vector<char> is_positive;  ///< whether w is 0; else z is 0
    int nlopt_evaluations = 0;
};

/// The work that a solve may still do on dense problems.
struct DenseBudget {
    double flops;  ///< floating-point operations left
    const Settings* settings = nullptr;

    bool is_interrupted() const { return settings && settings->is_interrupted && settings->is_interrupted(); }

    /// False where nothing is left. Throws Interrupted.
    bool spend(double count)
    {
        if (settings) settings->stop_if_interrupted();
        flops -= count;
        return flops >= 0.0;
    }
};

/// NLopt's LD_LBFGS finds which z are positive, from `start`; pivoting then makes the answer exact to
/// round-off. NLopt's result only starts the pivoting, which ends from any start. Nothing where S or q is not
/// finite, a diagonal entry is not positive, or the pivoting exceeds its limit of steps: S is not positive
/// definite to working precision. Nothing either where it takes more than the budget.
std::optional<CondensedAnswer> solve_condensed_qp(const CondensedQp& qp, const Eigen::VectorXd& start,
                                                  DenseBudget& budget);

/// Only the pivoting of `solve_condensed_qp`, from the given set. Exposed for tests, which start from wrong
/// sets.
std::optional<CondensedAnswer> solve_by_pivoting(const CondensedQp& qp, std::vector<char> is_positive);

}  // namespace arris
