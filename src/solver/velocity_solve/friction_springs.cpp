// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/friction_springs.h"

#include "solver/velocity_solve/condensed_discs.h"

namespace arris {
namespace {

/// Greatest difference between the stiffnesses of a spring and of its law, as a share of the law's stiffness
/// plus the mass: about the factor by which one correction of the spring's force reduces the error.
constexpr double kNear = 0.25;

Eigen::Vector2d lower_of(const ConstraintRows& constraints, int pair)
{
    return {constraints.rows[2 * pair].lower, constraints.rows[2 * pair + 1].lower};
}

Eigen::Matrix2d stiffness_at(const ConstraintRows& constraints, int pair, const Eigen::Vector2d& y)
{
    return projection_slope(unlimited_at(constraints, pair, y), constraints.budgets[pair]) /
           constraints.rows[2 * pair].give;
}

}  // namespace

Eigen::Vector2d slip_of(const ConstraintRows& constraints, int pair, const Eigen::VectorXd& velocity)
{
    Eigen::Vector2d y = Eigen::Vector2d::Zero();
    for (int d = 0; d < 2; ++d)
        for (const auto& [coordinate, coefficient] : constraints.rows[2 * pair + d].entries)
            y[d] += coefficient * velocity[coordinate];
    return y;
}

Eigen::Vector2d unlimited_at(const ConstraintRows& constraints, int pair, const Eigen::Vector2d& y)
{
    return (lower_of(constraints, pair) - y) / constraints.rows[2 * pair].give;
}

Eigen::Vector2d friction_at(const ConstraintRows& constraints, int pair, const Eigen::Vector2d& y)
{
    return project_on_disc(unlimited_at(constraints, pair, y), constraints.budgets[pair]);
}

SlipSpring tangent_at(const ConstraintRows& constraints, int pair, const Eigen::Vector2d& y)
{
    SlipSpring spring;
    if (constraints.budgets[pair] > 0.0) spring.stiffness = stiffness_at(constraints, pair, y);
    return through(spring, constraints, pair, y);
}

SlipSpring through(const SlipSpring& spring, const ConstraintRows& constraints, int pair,
                   const Eigen::Vector2d& y)
{
    const Eigen::Vector2d unlimited = unlimited_at(constraints, pair, y);
    const bool is_sliding = unlimited.norm() > constraints.budgets[pair];
    const Eigen::Vector2d impulse = project_on_disc(unlimited, constraints.budgets[pair]);
    return {spring.stiffness, impulse + spring.stiffness * y,
            is_sliding ? impulse : Eigen::Vector2d(0.0, 0.0)};
}

bool is_near_law(const SlipSpring& spring, const ConstraintRows& constraints, int pair,
                 const Eigen::Vector2d& y)
{
    const Eigen::Matrix2d law = stiffness_at(constraints, pair, y);
    return (spring.stiffness - law).norm() <= kNear * (law.norm() + constraints.masses[pair]);
}

std::vector<SlipSpring> starting_springs(const VelocityProblem& problem, const ConstraintRows& constraints)
{
    std::vector<SlipSpring> springs;
    for (int pair = 0; pair < constraints.pair_count(); ++pair) {
        Eigen::Vector2d y;  // the slip is g u - lower of the problem's row; in its scale
        for (int d = 0; d < 2; ++d)
            y[d] = (problem.friction[pair].last[d] + problem.friction[pair].slip[d].lower) /
                   constraints.rows[2 * pair].scale;
        springs.push_back(tangent_at(constraints, pair, y));
    }
    return springs;
}

std::vector<SlipSpring> springs_at(const ConstraintRows& constraints, const std::vector<SlipSpring>& old,
                                   const Eigen::VectorXd& velocity)
{
    std::vector<SlipSpring> springs;
    for (int pair = 0; pair < constraints.pair_count(); ++pair) {
        Eigen::Vector2d y = slip_of(constraints, pair, velocity);
        if (unlimited_at(constraints, pair, y).dot(old[pair].rim) < 0.0) y = lower_of(constraints, pair);
        springs.push_back(tangent_at(constraints, pair, y));
    }
    return springs;
}

}  // namespace arris
