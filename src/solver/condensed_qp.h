// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace arris {

/// min 1/2 z^T S z + q^T z subject to z >= 0, with S dense, symmetric and positive definite.
struct CondensedQp {
    Eigen::MatrixXd hessian;  ///< S
    Eigen::VectorXd linear;   ///< q
};

/// z >= 0, w = S z + q >= 0, z w = 0; where `is_positive`, w is exactly 0, elsewhere z is.
struct CondensedAnswer {
    Eigen::VectorXd z, w;
    std::vector<char> is_positive;
    int nlopt_evaluations = 0;
};

/// NLopt's LD_LBFGS finds which z are positive, from `start`; exact pivoting makes the answer exact to
/// round-off. Whatever NLopt ends with is only where the pivoting starts, which is finite from anywhere.
/// Nothing where S or q are not finite, a diagonal entry is not positive, or the pivoting's bound on steps is
/// hit (S not positive definite to working precision).
std::optional<CondensedAnswer> solve_condensed_qp(const CondensedQp& qp, const Eigen::VectorXd& start);

/// The second half alone: pivots from the set given. Exposed for its tests, which start it from wrong sets.
std::optional<CondensedAnswer> solve_by_pivoting(const CondensedQp& qp, std::vector<char> is_positive);

}  // namespace arris
