// SPDX-License-Identifier: GPL-3.0-or-later
// Friction as springs that yield. With y = g u the two scaled slip rows of a pair and v = (lower - y) /
// compliance the impulse that its spring would have without a limit, the impulse is f = P(v), P the
// projection onto the disc of the budget. A linear model of it is stiff where the pair sticks. Where it
// slides, v is far outside the disc, and the tangent, budget / |slip| across the slip, is right only near y.
// The stiffness is that of the primal-dual Newton method instead, which converges from far (Hintermueller and
// Stadler 2006, SIAM J. Sci. Comput. 28(1), Section 3, for total variation, whose law is this one).
#pragma once

#include <Eigen/Core>

#include "solver/velocity_solve/constraint_rows.h"

namespace arris {

/// The point of the disc |z| <= radius nearest to z.
Eigen::Vector2d project_on_disc(const Eigen::Vector2d& z, double radius);

/// (lower - y) / compliance of a pair, N s, with y = `values` of its two scaled rows.
Eigen::Vector2d unlimited_at(const ConstraintRows& constraints, int pair, const Eigen::Vector2d& values);

/// Stiffness, kg, of a linear model of the pair's law at v = `unlimited`. With d = v / |v| and w = `impulse`
/// / budget, projected onto the unit disc, it is budget / (|v| compliance) (1 - (w d^T + d w^T) / 2) where
/// the pair slides: the tangent where `impulse` is the law's, a secant to where the law has `impulse`
/// otherwise.
Eigen::Matrix2d slip_stiffness(const Eigen::Vector2d& unlimited, const Eigen::Vector2d& impulse,
                               double budget, double compliance);

/// Difference of a model's stiffness from `wanted`, relative to that and to the mass that slips: about the
/// factor by which moving the model's force to the law's reduces an error.
double distance(const Eigen::Matrix2d& stiffness, const Eigen::Matrix2d& wanted, double mass);

}  // namespace arris
