// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/velocity_solve.h"

namespace arris {

/// How far (velocity, multipliers) is from solving the problem, by A, b and the bounds alone. The greatest of
///   stationarity     |A u - b - lambda|_i / (|A||u| + |b| + |lambda|)_i     over coordinates that are not
///   fixed primal violation max(lower - u, 0) / max|u|, and |u| / max|u| where fixed wrong sign max(-lambda,
///   0) / max|lambda| complementarity  |lambda (u - lower)| / (max|lambda| max|u|)
/// 0/0 counts as 0. NaN where anything is NaN; infinite where a multiplier stands on no bound.
double kkt_residual(const VelocityProblem& problem, const Eigen::VectorXd& velocity,
                    const Eigen::VectorXd& multipliers);

}  // namespace arris
