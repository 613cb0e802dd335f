// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace arris {

/// X with A X = B by LAPACK's Gaussian elimination with pivots, which on dense problems of a few hundred
/// unknowns is several times as fast as Eigen's. Not finite where A is singular.
Eigen::MatrixXd solve_dense(Eigen::MatrixXd A, Eigen::MatrixXd B);

}  // namespace arris
