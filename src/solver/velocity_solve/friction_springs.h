// SPDX-License-Identifier: GPL-3.0-or-later
// Friction as springs that yield. With y = g u the two scaled slip rows of a pair and v = (lower - y) / give
// the impulse that its spring would have without a limit, the impulse is f = P(v), P the projection onto the
// disc of the budget. A base holds a linear law through f(y) in its matrix: stiff where the pair sticks.
// Where it slides, v is far outside the disc, and the tangent, budget / |slip| across the slip, is right only
// near y. The springs are those of the primal-dual Newton method instead, which converges from far
// (Hintermueller and Stadler 2006, SIAM J. Sci. Comput. 28(1), Section 3, for total variation, whose law is
// this one).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "solver/velocity_solve/constraint_rows.h"

namespace arris {

/// Impulses of friction that differ by less, relative to the largest budget, count as the same. Budgets agree
/// to 1e-4 (friction_sweeps.cpp).
inline constexpr double kSameFriction = 3e-5;

/// A linear law f = force - stiffness y in place of a friction pair's law.
struct SlipSpring {
    Eigen::Matrix2d stiffness = Eigen::Matrix2d::Zero();  ///< kg
    Eigen::Vector2d force = Eigen::Vector2d::Zero();      ///< N s

    bool is_in_matrix() const { return !stiffness.isZero(0.0); }
    Eigen::Vector2d at(const Eigen::Vector2d& y) const { return force - stiffness * y; }
};

/// y = g u of the pair's rows.
Eigen::Vector2d slip_of(const ConstraintRows& constraints, int pair, const Eigen::VectorXd& velocity);

/// The pair's impulse at y if its budget were infinite, N s.
Eigen::Vector2d unlimited_at(const ConstraintRows& constraints, int pair, const Eigen::Vector2d& y);

/// The pair's impulse at y, N s.
Eigen::Vector2d friction_at(const ConstraintRows& constraints, int pair, const Eigen::Vector2d& y);

/// The spring through the pair's impulse at y. With d = v / |v| and w = `impulse` / budget, projected onto
/// the unit disc, its stiffness where the pair slides is budget / (|v| give) (1 - (w d^T + d w^T) / 2): the
/// tangent where `impulse` is the law's, a secant to where the law has `impulse` otherwise.
SlipSpring spring_at(const ConstraintRows& constraints, int pair, const Eigen::Vector2d& y,
                     const Eigen::Vector2d& impulse);

/// The spring with the pair's impulse at y and its own stiffness.
SlipSpring through(const SlipSpring& spring, const ConstraintRows& constraints, int pair,
                   const Eigen::Vector2d& y);

/// Whether moving the spring to the pair's impulse, again and again, converges fast at y: its stiffness
/// differs little from the law's, relative to that and to the mass that slips.
bool is_near_law(const SlipSpring& spring, const ConstraintRows& constraints, int pair,
                 const Eigen::Vector2d& y);

/// Tangents at the slips from which the problem's pairs start.
std::vector<SlipSpring> starting_springs(const VelocityProblem& problem, const ConstraintRows& constraints);

/// Springs at a velocity, with the impulses of an iterate that was found with the springs before: the two
/// rows of each pair in `row_multipliers`.
std::vector<SlipSpring> springs_at(const ConstraintRows& constraints, const Eigen::VectorXd& row_multipliers,
                                   const Eigen::VectorXd& velocity);

}  // namespace arris
