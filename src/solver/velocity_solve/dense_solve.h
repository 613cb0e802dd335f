// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>

namespace arris {

/// Values nearer to 0 are round-off, and tell no sign: of a gap, as a share of the largest speed; of an
/// unknown of a dense problem, as a share of the largest. Raising it takes small forces and gaps for none.
inline constexpr double kSignTolerance = 1e-13;

/// Share of the diagonal by which `solve_refined` shifts it, so that Cholesky factorises a matrix that is
/// singular to round-off. Raising it makes refinement slower.
inline constexpr double kShift = 1e-12;

struct RefinedSolution {
    Eigen::VectorXd x;
    double last_change;  ///< largest change of `x` by the last refinement: its round-off
};

/// x with A x = b for a symmetric A that may be singular to round-off: Cholesky of `shifted`, which is A with
/// a larger diagonal, and two refinements, which remove the error of the shift. Nothing where `shifted` is
/// not positive definite.
std::optional<RefinedSolution> solve_refined(const Eigen::MatrixXd& A, const Eigen::MatrixXd& shifted,
                                             const Eigen::VectorXd& b);

/// X with A X = B by Gaussian elimination with pivots, the same for any number of threads. On dense problems
/// of a few hundred unknowns LAPACK's panels are several times as fast as Eigen's. Not finite where A is
/// singular.
Eigen::MatrixXd solve_dense(Eigen::MatrixXd A, Eigen::MatrixXd B);

}  // namespace arris
