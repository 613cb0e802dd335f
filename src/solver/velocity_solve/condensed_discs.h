// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "solver/velocity_solve/condensed_qp.h"

namespace arris {

/// `solve_condensed_qp` for a problem with discs (friction), from `start`. Some sweeps of block descent lead
/// near the answer where the discs hardly depend on each other; where that is not near enough, Newton's
/// method on the energy does from anywhere. A semismooth Newton method on z = P(z - w), P the projection onto
/// bounds and discs, makes the answer exact to round-off.
std::optional<CondensedAnswer> solve_with_discs(const CondensedQp& qp, const Eigen::VectorXd& start,
                                                DenseBudget& budget);

/// The minimiser of 1/2 z^T S z + q^T z in the disc |z| <= radius. S must be positive definite.
Eigen::Vector2d minimise_in_disc(const Eigen::Matrix2d& S, const Eigen::Vector2d& q, double radius);

/// The point of the disc |z| <= radius nearest to z.
Eigen::Vector2d project_on_disc(const Eigen::Vector2d& z, double radius);

/// Derivative of `project_on_disc` at z.
Eigen::Matrix2d projection_slope(const Eigen::Vector2d& z, double radius);

}  // namespace arris
