// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/primal_prediction.h"

#include <algorithm>
#include <cmath>

#include "solver/velocity_solve/nlopt_outcome.h"
#include "solver/velocity_solve/symmetric_product.h"

namespace arris {
namespace {

/// More evaluations find few further bounds: 10 and 25 give nearly equal run times, and 100 cost as much as a
/// factorisation.
constexpr int kEvaluations = 25;

/// 1/2 x^T D^-1/2 A D^-1/2 x + x^T D^-1/2 g / unit, x = D^1/2 (u - start) / unit, g the gradient at start.
struct Objective {
    const VelocityProblem* problem;
    Eigen::VectorXd scale;   ///< D^-1/2
    Eigen::VectorXd linear;  ///< D^-1/2 g / unit
};

double evaluate(const std::vector<double>& x, std::vector<double>& gradient, void* data)
{
    const Objective& objective = *static_cast<const Objective*>(data);
    const Eigen::Map<const Eigen::VectorXd> point(x.data(), static_cast<Eigen::Index>(x.size()));
    const Eigen::VectorXd product = objective.scale.cwiseProduct(
        symmetric_product(*objective.problem->matrix, objective.scale.cwiseProduct(point)));
    const double value = 0.5 * point.dot(product) + point.dot(objective.linear);
    if (!std::isfinite(value)) throw nlopt::forced_stop();
    if (!gradient.empty())
        Eigen::Map<Eigen::VectorXd>(gradient.data(), point.size()) = product + objective.linear;
    return value;
}

Eigen::VectorXd inverse_root_of_diagonal(const Eigen::SparseMatrix<double>& matrix)
{
    const Eigen::VectorXd diagonal = matrix.diagonal();
    Eigen::VectorXd scale = Eigen::VectorXd::Ones(diagonal.size());
    for (int i = 0; i < diagonal.size(); ++i)
        if (diagonal[i] > 0.0) scale[i] = 1.0 / std::sqrt(diagonal[i]);
    return scale;
}

Eigen::VectorXd within_bounds(const VelocityProblem& problem, Eigen::VectorXd velocity)
{
    for (int i = 0; i < velocity.size(); ++i)
        velocity[i] = problem.is_fixed[i] ? 0.0 : std::max(velocity[i], problem.lower[i]);
    return velocity;
}

/// Runs NLopt on the step from `start`; returns the velocity reached.
Eigen::VectorXd descend(const VelocityProblem& problem, const Eigen::VectorXd& start, int& evaluations)
{
    const Eigen::VectorXd scale = inverse_root_of_diagonal(*problem.matrix);
    const Eigen::VectorXd gradient = symmetric_product(*problem.matrix, start) - *problem.rhs;
    const double unit = scale.cwiseProduct(gradient).lpNorm<Eigen::Infinity>() / kTypicalUnknown;
    if (!(unit > 0.0) || !std::isfinite(unit)) return start;

    const auto size = static_cast<std::size_t>(start.size());
    std::vector<double> x(size, 0.0), lower(size, 0.0), upper(size, 0.0);
    for (std::size_t i = 0; i < size; ++i) {
        if (problem.is_fixed[i]) continue;
        lower[i] = (problem.lower[i] - start[i]) / scale[i] / unit;
        upper[i] = HUGE_VAL;
    }
    Objective objective = {&problem, scale, scale.cwiseProduct(gradient) / unit};
    nlopt::opt optimizer(nlopt::LD_LBFGS, static_cast<unsigned>(size));
    optimizer.set_vector_storage(kStoredVectors);
    optimizer.set_lower_bounds(lower);
    optimizer.set_upper_bounds(upper);
    optimizer.set_min_objective(evaluate, &objective);
    optimizer.set_maxeval(kEvaluations);
    improve(optimizer, x);
    evaluations += optimizer.get_numevals();
    return start + unit * scale.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(x.data(), start.size()));
}

}  // namespace

ActivePrediction predict_active_bounds(const VelocityProblem& problem, const Eigen::VectorXd& start)
{
    ActivePrediction prediction;
    const Eigen::VectorXd velocity =
        descend(problem, within_bounds(problem, start), prediction.nlopt_evaluations);
    const Eigen::VectorXd gradient = symmetric_product(*problem.matrix, velocity) - *problem.rhs;
    const Eigen::VectorXd diagonal = problem.matrix->diagonal();
    prediction.is_active.assign(static_cast<std::size_t>(velocity.size()), 0);
    for (int i = 0; i < velocity.size(); ++i)
        prediction.is_active[i] =
            !problem.is_fixed[i] && diagonal[i] * (velocity[i] - problem.lower[i]) <= gradient[i];
    return prediction;
}

ActivePrediction predict_active_bounds(const VelocityProblem& problem, const ConstraintRows& constraints,
                                       const Iterate& iterate)
{
    if (constraints.rows.empty()) return predict_active_bounds(problem, iterate.velocity);
    Eigen::VectorXd rhs = *problem.rhs;
    for (std::size_t k = 0; k < constraints.rows.size(); ++k)
        for (const auto& [coordinate, coefficient] : constraints.rows[k].entries)
            rhs[coordinate] += coefficient * iterate.row_multipliers[static_cast<Eigen::Index>(k)];
    VelocityProblem pushed = problem;
    pushed.rhs = &rhs;
    return predict_active_bounds(pushed, iterate.velocity);
}

}  // namespace arris
