// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/pinned_base.h"

#include <cmath>

#include "solver/velocity_solve/symmetric_product.h"

namespace arris {

void evaluate_gradient(const VelocityProblem& problem, const ConstraintRows& constraints, Iterate& iterate)
{
    SymmetricProduct product = symmetric_product_with_magnitude(*problem.matrix, iterate.velocity);
    iterate.gradient = std::move(product.value) - *problem.rhs;
    iterate.magnitude = std::move(product.magnitude) + problem.rhs->cwiseAbs();
    for (std::size_t k = 0; k < constraints.rows.size(); ++k) {
        const double multiplier = iterate.row_multipliers[static_cast<Eigen::Index>(k)];
        if (multiplier <= 0.0) continue;
        for (const auto& [coordinate, coefficient] : constraints.rows[k].entries) {
            iterate.gradient[coordinate] -= coefficient * multiplier;
            iterate.magnitude[coordinate] += std::abs(coefficient * multiplier);
        }
    }
}

std::vector<char> find_pinned(const VelocityProblem& problem, const std::vector<char>& is_active)
{
    std::vector<char> is_pinned = is_active;
    for (std::size_t i = 0; i < is_pinned.size(); ++i) is_pinned[i] = is_active[i] || problem.is_fixed[i];
    return is_pinned;
}

PinnedBase solve_pinned(const VelocityProblem& problem, const ConstraintRows& constraints,
                        const std::vector<char>& is_active, const Factorization& factorization)
{
    PinnedBase base = {&problem, &constraints, &factorization, find_pinned(problem, is_active), {}, {}};
    Eigen::VectorXd held = Eigen::VectorXd::Zero(problem.rhs->size());
    for (int i = 0; i < held.size(); ++i)
        if (is_active[i]) held[i] = problem.lower[i];
    Eigen::VectorXd rhs = *problem.rhs - symmetric_product(*problem.matrix, held);
    for (int i = 0; i < held.size(); ++i)
        if (base.is_pinned[i]) rhs[i] = 0.0;

    base.forward = factorization.solve_forward(rhs);
    base.iterate = {factorization.solve_backward(base.forward) + held,
                    is_active,
                    Eigen::VectorXd::Zero(static_cast<Eigen::Index>(constraints.rows.size())),
                    {},
                    {}};
    evaluate_gradient(problem, constraints, base.iterate);
    return base;
}

}  // namespace arris
