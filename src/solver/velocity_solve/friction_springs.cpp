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

/// Of the spring at y with this impulse. The pair's budget is positive.
Eigen::Matrix2d stiffness_at(const ConstraintRows& constraints, int pair, const Eigen::Vector2d& y,
                             const Eigen::Vector2d& impulse)
{
    const double give = constraints.rows[2 * pair].give, budget = constraints.budgets[pair];
    const Eigen::Vector2d v = unlimited_at(constraints, pair, y);
    const double size = v.norm();
    if (size <= budget) return Eigen::Matrix2d::Identity() / give;
    const Eigen::Vector2d d = v / size, w = project_on_disc(impulse, budget) / budget;
    return budget / (size * give) *
           (Eigen::Matrix2d::Identity() - 0.5 * (w * d.transpose() + d * w.transpose()));
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

SlipSpring spring_at(const ConstraintRows& constraints, int pair, const Eigen::Vector2d& y,
                     const Eigen::Vector2d& impulse)
{
    SlipSpring spring;
    const double budget = constraints.budgets[pair];
    if (budget > 0.0) spring.stiffness = stiffness_at(constraints, pair, y, impulse);
    return through(spring, constraints, pair, y);
}

SlipSpring through(const SlipSpring& spring, const ConstraintRows& constraints, int pair,
                   const Eigen::Vector2d& y)
{
    return {spring.stiffness, friction_at(constraints, pair, y) + spring.stiffness * y};
}

bool is_near_law(const SlipSpring& spring, const ConstraintRows& constraints, int pair,
                 const Eigen::Vector2d& y)
{
    const Eigen::Matrix2d law =
        projection_slope(unlimited_at(constraints, pair, y), constraints.budgets[pair]) /
        constraints.rows[2 * pair].give;
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
        springs.push_back(spring_at(constraints, pair, y, friction_at(constraints, pair, y)));
    }
    return springs;
}

std::vector<SlipSpring> springs_at(const ConstraintRows& constraints, const Eigen::VectorXd& row_multipliers,
                                   const Eigen::VectorXd& velocity)
{
    std::vector<SlipSpring> springs;
    for (int pair = 0; pair < constraints.pair_count(); ++pair)
        springs.push_back(spring_at(constraints, pair, slip_of(constraints, pair, velocity),
                                    row_multipliers.segment<2>(2 * pair)));
    return springs;
}

}  // namespace arris
