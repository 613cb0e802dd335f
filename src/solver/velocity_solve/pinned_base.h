// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/velocity_solve/constraint_rows.h"
#include "solver/velocity_solve/factorization.h"
#include "solver/velocity_solve/velocity_solve.h"

namespace arris {

/// A velocity, which constraints it takes as active, and what is left of the equations.
struct Iterate {
    Eigen::VectorXd velocity;
    std::vector<char> is_active;      ///< u = lower, by coordinate
    Eigen::VectorXd row_multipliers;  ///< of the scaled rows, in [0, cap]
    Eigen::VectorXd gradient;   ///< A u - b - C^T lambda: the multiplier where active, a residual where free
    Eigen::VectorXd magnitude;  ///< |A||u| + |b| + |C^T||lambda|: what round-off in `gradient` is measured by
};

/// The problem with chosen bounds pinned and no row, solved by one factorisation:
/// u = lower where pinned, 0 where fixed, and A_FF u_F = b_F - A_FP u_P on the free coordinates F.
struct PinnedBase {
    const VelocityProblem* problem;
    const ConstraintRows* constraints;
    const Factorization* factorization;
    std::vector<char> is_pinned;  ///< a guessed bound or a fixed coordinate: not in the factor
    Eigen::VectorXd forward;      ///< f = L^-1 P (b_F - A_FP u_P)
    Iterate iterate;
};

/// The gradient and magnitude that belong to `iterate`'s velocity and row multipliers.
void evaluate_gradient(const VelocityProblem& problem, const ConstraintRows& constraints, Iterate& iterate);

/// What the factor leaves out when these bounds are active: them and the fixed coordinates.
std::vector<char> find_pinned(const VelocityProblem& problem, const std::vector<char>& is_active);

/// `factorization` is the matrix's with `find_pinned(problem, is_active)`.
PinnedBase solve_pinned(const VelocityProblem& problem, const ConstraintRows& constraints,
                        const std::vector<char>& is_active, const Factorization& factorization);

}  // namespace arris
