// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/velocity_solve/constraint_rows.h"
#include "solver/velocity_solve/velocity_solve.h"

namespace arris {

/// Relative KKT residual of (velocity, multipliers, row multipliers), from A, b, the bounds and the rows
/// alone: the greatest of
///   stationarity     |A u - b - C^T lambda|_i / (|A||u| + |b| + |C^T||lambda|)_i     where not fixed
///   primal violation max(lower - C u, 0) / max|u|, and |u| / max|u| where fixed
///   wrong sign       max(-lambda, 0) / max|lambda|
///   complementarity  |lambda (C u - lower)| / (max|lambda| max|u|)
/// where C holds the bounds and the scaled rows; C u - lower of a row includes compliance * lambda. With
/// rows, max|u| is at least their least speed, and diag(A) times that speed is added to the scale of
/// stationarity. 0/0 counts as 0. NaN where anything is NaN; infinite where a coordinate without a bound has
/// a multiplier. `row_multipliers` belong to the scaled rows. Impulses of friction are taken as given forces;
/// `VelocitySolution::law_residual` tells how far they are from the law.
double kkt_residual(const VelocityProblem& problem, const ConstraintRows& constraints,
                    const Eigen::VectorXd& velocity, const Eigen::VectorXd& multipliers,
                    const Eigen::VectorXd& row_multipliers);

/// The residual of a problem without rows.
double kkt_residual(const VelocityProblem& problem, const Eigen::VectorXd& velocity,
                    const Eigen::VectorXd& multipliers);

}  // namespace arris
