// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "solver/velocity_solve/velocity_solve.h"

namespace arris::testing {

/// The exact solution of a small problem by an independent method. It is a primal active set that adds the
/// coordinate of steepest descent and steps back to the first bound met. Source: Lawson and Hanson 1974, ch.
/// 23, for a QP; dense, in extended precision. Each step descends, so no set recurs and the method
/// terminates.
struct DenseAnswer {
    Eigen::VectorXd velocity, multipliers;
};
DenseAnswer solve_densely(const VelocityProblem& problem);

/// The KKT residual, computed in extended precision from the dense matrix.
double dense_kkt_residual(const VelocityProblem& problem, const VelocitySolution& solution);

}  // namespace arris::testing
