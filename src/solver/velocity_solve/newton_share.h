// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/velocity_solve/constraint_rows.h"

namespace arris {

/// Share of the way between two velocities at which the energy, with the springs of all rows and of friction,
/// is least. Without it Newton's method goes to and fro where many rows depend on each other.
double find_newton_share(const VelocityProblem& problem, const ConstraintRows& constraints,
                         const Eigen::VectorXd& from, const Eigen::VectorXd& to);

}  // namespace arris
