// SPDX-License-Identifier: GPL-3.0-or-later
// Friction as springs that yield. With y = g u the two scaled slip rows of a pair and v = (lower - y) / give
// the impulse that its spring would have without a limit, the impulse is f = P(v), P the projection onto the
// disc of the budget. A base holds the tangent of this law in its matrix, as Newton's method does: stiff
// where the pair sticks, budget / |slip| across the slip where it slides.
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
    Eigen::Vector2d rim = Eigen::Vector2d::Zero();        ///< N s, the law's impulse where it slides; else 0

    bool is_in_matrix() const { return !stiffness.isZero(0.0); }
    Eigen::Vector2d at(const Eigen::Vector2d& y) const { return force - stiffness * y; }
};

/// y = g u of the pair's rows.
Eigen::Vector2d slip_of(const ConstraintRows& constraints, int pair, const Eigen::VectorXd& velocity);

/// The pair's impulse at y if its budget were infinite, N s.
Eigen::Vector2d unlimited_at(const ConstraintRows& constraints, int pair, const Eigen::Vector2d& y);

/// The pair's impulse at y, N s.
Eigen::Vector2d friction_at(const ConstraintRows& constraints, int pair, const Eigen::Vector2d& y);

/// The tangent of the pair's law at y.
SlipSpring tangent_at(const ConstraintRows& constraints, int pair, const Eigen::Vector2d& y);

/// The spring with the pair's impulse at y and its own stiffness.
SlipSpring through(const SlipSpring& spring, const ConstraintRows& constraints, int pair,
                   const Eigen::Vector2d& y);

/// Whether moving the spring to the pair's impulse, again and again, converges fast at y: its stiffness
/// differs little from the law's, relative to that and to the mass that slips.
bool is_near_law(const SlipSpring& spring, const ConstraintRows& constraints, int pair,
                 const Eigen::Vector2d& y);

/// Tangents at the slips from which the problem's pairs start.
std::vector<SlipSpring> starting_springs(const VelocityProblem& problem, const ConstraintRows& constraints);

/// Tangents at a velocity that was found with the springs `old`. A pair that slid and is now drawn back the
/// way it came is taken to stick: tangents would go to and fro between both directions.
std::vector<SlipSpring> springs_at(const ConstraintRows& constraints, const std::vector<SlipSpring>& old,
                                   const Eigen::VectorXd& velocity);

}  // namespace arris
