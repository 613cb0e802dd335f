// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace arris {

/// min 1/2 z^T S z + q^T z subject to 0 <= z <= cap, with S dense, symmetric and positive definite. With caps
/// S may be semidefinite, if each of its null vectors involves a capped unknown.
struct CondensedQp {
    Eigen::MatrixXd hessian;   ///< S
    Eigen::VectorXd linear;    ///< q
    Eigen::VectorXd cap = {};  ///< infinity where an unknown has no cap; empty where none has
};

/// State of an unknown: at 0 with w >= 0, between its bounds with w = 0, or at its cap with w <= 0.
enum class Stand : char { AtZero, Between, AtCap };

/// A solution: 0 <= z <= cap, and w = S z + q has exactly the sign that `stand` implies.
struct CondensedAnswer {
    Eigen::VectorXd z, w;
    std::vector<Stand> stand;
    int nlopt_evaluations = 0;
};

/// NLopt's LD_LBFGS finds which z are positive, from `start`; pivoting then makes the answer exact to
/// round-off. NLopt's result only starts the pivoting, which ends from any start. Nothing where S or q is not
/// finite, a diagonal entry is not positive, or the pivoting exceeds its limit of steps (without caps: S is
/// not positive definite to working precision).
std::optional<CondensedAnswer> solve_condensed_qp(const CondensedQp& qp, const Eigen::VectorXd& start);

/// Solves by descent alone, also with semidefinite S, from a nearby z at which w is `gap`. Needs caps;
/// `qp.linear` is not used.
std::optional<CondensedAnswer> solve_by_descent(const CondensedQp& qp, const Eigen::VectorXd& z,
                                                const Eigen::VectorXd& gap);

/// Only the pivoting of `solve_condensed_qp`, from the given set. Exposed for tests, which start from wrong
/// sets.
std::optional<CondensedAnswer> solve_by_pivoting(const CondensedQp& qp, std::vector<Stand> stand);

}  // namespace arris
