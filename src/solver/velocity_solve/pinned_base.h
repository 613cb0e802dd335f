// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "solver/velocity_solve/constraint_rows.h"
#include "solver/velocity_solve/factorization.h"
#include "solver/velocity_solve/friction_springs.h"
#include "solver/velocity_solve/velocity_solve.h"

namespace arris {

/// A velocity, the constraints taken as active, and the residual of the equations.
struct Iterate {
    Eigen::VectorXd velocity;
    std::vector<char> is_active;      ///< u = lower, by coordinate
    Eigen::VectorXd row_multipliers;  ///< of the scaled rows; a base's pressing rows may pull (< 0)
    Eigen::VectorXd gradient;         ///< A u - b - C^T lambda: the multiplier where active, else a residual
    Eigen::VectorXd magnitude;        ///< |A||u| + |b| + |C^T||lambda|: scale of the round-off in `gradient`
    std::vector<char> is_exact;    ///< by friction pair: its impulse follows its law, not the base's spring
    std::vector<char> has_let_go;  ///< by row: the base has its spring, but it would pull, and does not act
};

/// The problem with chosen bounds pinned and chosen rows pressing, solved by one factorisation: u = lower
/// where pinned, 0 where fixed, and A'_FF u_F = b'_F - A'_FP u_P on the free coordinates F. The springs of
/// the pressing rows S and of friction (SlipSpring: K, force) are part of the matrix:
///   A' = A + sum_S g g^T / give + sum g^T K g,   b' = b + sum_S g lower / give + sum g^T force.
struct PinnedBase {
    const VelocityProblem* problem;
    const ConstraintRows* constraints;
    const Factorization* factorization;
    std::vector<char> is_pressing;          ///< by row: whether it is in S
    std::vector<SlipSpring> slips;          ///< by friction pair
    Eigen::SparseMatrix<double> with_rows;  ///< A'; empty where it is A
    std::vector<char> is_pinned;  ///< a bound guessed active or a fixed coordinate: not in the factor
    Eigen::VectorXd forward;      ///< f = L^-1 P (b_F - A_FP u_P)
    Iterate iterate;

    const Eigen::SparseMatrix<double>& matrix() const
    {
        return with_rows.size() > 0 ? with_rows : *problem->matrix;
    }
};

/// Sets the multipliers of the base's springs, then gradient and magnitude of `iterate`, from its velocity
/// and its other row multipliers.
void evaluate_gradient(const PinnedBase& base, Iterate& iterate);

/// Adds `change` to the velocity, and what it changes in the multipliers of the base's springs to them; sets
/// gradient and magnitude anew. A multiplier computed from the velocity itself has the round-off of a speed
/// times the spring's stiffness; a multiplier that was corrected has that of the correction.
void correct(const PinnedBase& base, const Eigen::VectorXd& change, Iterate& iterate);

/// The coordinates that the factor leaves out when these bounds are active: their coordinates and the fixed
/// ones.
std::vector<char> find_pinned(const VelocityProblem& problem, const std::vector<char>& is_active);

/// Whether the matrix has an entry for each pair of the row's coordinates, so that its spring fits.
bool has_room_for(const Eigen::SparseMatrix<double>& matrix, const ScaledRow& row);

/// Solves the base again, with its factor, after the forces of its friction springs have changed.
void solve_with_forces(PinnedBase& base);

/// Factorises and solves a base. Its iterate is not finite where the matrix is not; nothing where it is not
/// positive definite. There must be room for the pressing rows. A friction spring without room has no
/// stiffness.
std::optional<PinnedBase> solve_pinned(const VelocityProblem& problem, const ConstraintRows& constraints,
                                       const std::vector<char>& is_active, std::vector<char> is_pressing,
                                       std::vector<SlipSpring> slips, Factorization& factorization);

}  // namespace arris
