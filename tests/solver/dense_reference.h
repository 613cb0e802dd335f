// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "solver/velocity_solve/velocity_solve.h"

namespace arris::testing {

/// The exact answer of a small problem, by a method that shares nothing with the solver's: a primal active
/// set that adds the coordinate of the steepest descent and steps back to the first bound met (Lawson and
/// Hanson 1974, ch. 23, for a QP), dense and in extended precision. Each step descends, so that no set comes
/// twice and it ends.
struct DenseAnswer {
    Eigen::VectorXd velocity, multipliers;
};
DenseAnswer solve_densely(const VelocityProblem& problem);

/// The KKT residual in extended precision from the dense matrix.
double dense_kkt_residual(const VelocityProblem& problem, const VelocitySolution& solution);

}  // namespace arris::testing
