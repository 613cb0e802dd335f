// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/velocity_solve/constraint_rows.h"

namespace arris {

/// Share of the way between two velocities at which the energy, with the springs of all rows and of friction,
/// is least. Without it Newton's method goes to and fro where many rows depend on each other.
double find_newton_share(const VelocityProblem& problem, const ConstraintRows& constraints,
                         const Eigen::VectorXd& from, const Eigen::VectorXd& to);

/// Rows to press in the next base, ascending: of those that are violated at `point`, all that press now (by
/// `multipliers`), and of the others the worst of each group. Of rows that repeat each other, all at once
/// would press far too much. With friction all of them, so that the next base's model of the energy has the
/// energy's slope at `point`, from which its line search starts.
std::vector<int> find_newton_rows(const ConstraintRows& constraints, const Eigen::VectorXd& multipliers,
                                  const Eigen::VectorXd& point);

}  // namespace arris
