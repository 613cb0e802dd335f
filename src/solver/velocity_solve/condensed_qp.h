// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace arris {

/// min 1/2 z^T S z + q^T z subject to 0 <= z <= cap, with S dense, symmetric and positive definite; where
/// there are caps semidefinite will do, if none of its null vectors stands on uncapped unknowns alone.
struct CondensedQp {
    Eigen::MatrixXd hessian;   ///< S
    Eigen::VectorXd linear;    ///< q
    Eigen::VectorXd cap = {};  ///< infinity where there is none; empty: there is none anywhere
};

/// Where an unknown stands: at 0 with w >= 0, between with w = 0, or at its cap with w <= 0.
enum class Stand : char { AtZero, Between, AtCap };

/// 0 <= z <= cap and w = S z + q as `stand` says, exactly.
struct CondensedAnswer {
    Eigen::VectorXd z, w;
    std::vector<Stand> stand;
    int nlopt_evaluations = 0;
};

/// NLopt's LD_LBFGS finds which z are positive, from `start`; exact pivoting makes the answer exact to
/// round-off. Whatever NLopt ends with is only where the pivoting starts, which is finite from anywhere.
/// Nothing where S or q are not finite, a diagonal entry is not positive, or the pivoting's bound on steps is
/// hit (S not positive definite to working precision, without caps).
std::optional<CondensedAnswer> solve_condensed_qp(const CondensedQp& qp, const Eigen::VectorXd& start);

/// From a z that is near, where w is `gap`, by descent alone, which takes in semidefinite S. Needs caps;
/// `qp.linear` is not used.
std::optional<CondensedAnswer> solve_by_descent(const CondensedQp& qp, const Eigen::VectorXd& z,
                                                const Eigen::VectorXd& gap);

/// The second half alone: pivots from the set given. Exposed for its tests, which start it from wrong sets.
std::optional<CondensedAnswer> solve_by_pivoting(const CondensedQp& qp, std::vector<Stand> stand);

}  // namespace arris
