// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/velocity_solve/constraint_rows.h"
#include "solver/velocity_solve/factorization.h"
#include "solver/velocity_solve/velocity_solve.h"

namespace arris {

/// A velocity, the constraints taken as active, and the residual of the equations.
struct Iterate {
    Eigen::VectorXd velocity;
    std::vector<char> is_active;      ///< u = lower, by coordinate
    Eigen::VectorXd row_multipliers;  ///< of the scaled rows, in [0, cap]
    Eigen::VectorXd gradient;         ///< A u - b - C^T lambda: the multiplier where active, else a residual
    Eigen::VectorXd magnitude;        ///< |A||u| + |b| + |C^T||lambda|: scale of the round-off in `gradient`
};

/// The problem with chosen bounds pinned and no row, solved by one factorisation:
/// u = lower where pinned, 0 where fixed, and A_FF u_F = b_F - A_FP u_P on the free coordinates F.
struct PinnedBase {
    const VelocityProblem* problem;
    const ConstraintRows* constraints;
    const Factorization* factorization;
    std::vector<char> is_pinned;  ///< a bound guessed active or a fixed coordinate: not in the factor
    Eigen::VectorXd forward;      ///< f = L^-1 P (b_F - A_FP u_P)
    Iterate iterate;
};

/// Sets gradient and magnitude of `iterate` from its velocity and row multipliers.
void evaluate_gradient(const VelocityProblem& problem, const ConstraintRows& constraints, Iterate& iterate);

/// The coordinates that the factor leaves out when these bounds are active: their coordinates and the fixed
/// ones.
std::vector<char> find_pinned(const VelocityProblem& problem, const std::vector<char>& is_active);

/// `factorization` must be that of the matrix with `find_pinned(problem, is_active)` pinned.
PinnedBase solve_pinned(const VelocityProblem& problem, const ConstraintRows& constraints,
                        const std::vector<char>& is_active, const Factorization& factorization);

}  // namespace arris
