// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/velocity_solve.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

#include "solver/model/stopwatch.h"
#include "solver/velocity_solve/contact_newton.h"

namespace arris {
namespace {

bool is_finite(const VelocityProblem& problem)
{
    const Eigen::SparseMatrix<double>& matrix = *problem.matrix;
    if (!Eigen::Map<const Eigen::VectorXd>(matrix.valuePtr(), matrix.nonZeros()).allFinite()) return false;
    if (!problem.rhs->allFinite()) return false;
    for (int i = 0; i < problem.lower.size(); ++i)  // -infinity is no bound; NaN and +infinity cannot be met
        if (!problem.is_fixed[i] && !(problem.lower[i] < std::numeric_limits<double>::infinity()))
            return false;
    return true;
}

void assert_shapes([[maybe_unused]] const VelocityProblem& problem)
{
    assert(problem.matrix != nullptr && problem.rhs != nullptr);
    assert(problem.matrix->rows() == problem.rhs->size() && problem.matrix->cols() == problem.rhs->size());
    assert(problem.lower.size() == problem.rhs->size());
    assert(static_cast<Eigen::Index>(problem.is_fixed.size()) == problem.rhs->size());
}

}  // namespace

VelocitySolution make_zero_solution(const VelocityProblem& problem)
{
    VelocitySolution solution;
    solution.velocity = solution.multipliers = Eigen::VectorXd::Zero(problem.rhs->size());
    solution.row_multipliers = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(problem.rows.size()));
    solution.friction.assign(problem.friction.size(), Eigen::Vector2d::Zero());
    solution.slip = solution.unlimited = solution.friction;
    solution.budgets.assign(problem.friction.size(), 0.0);
    return solution;
}

struct VelocitySolver::Cache {
    Factorization factorization;
    ConstraintRows constraints;
    std::optional<double> free_speed;     ///< m/s, from the last solve's A, b
    std::optional<ContactNewton> newton;  ///< of the last solve, for `resume`
    std::optional<ContactAnswer> answer;  ///< of the last solve

    /// False where rows are not finite.
    bool scale(const VelocityProblem& problem)
    {
        if ((!problem.rows.empty() || !problem.friction.empty()) && !free_speed)
            free_speed = estimate_free_speed(problem);
        constraints = scale_rows(problem, free_speed.value_or(0.0));
        return constraints.is_finite;
    }

    VelocitySolution keep(VelocitySolution solution)
    {
        answer.reset();
        if (solution.status == SolveStatus::Certified || solution.status == SolveStatus::Infeasible)
            answer = newton->answer();
        else
            newton.reset();
        return solution;
    }
};

VelocitySolver::VelocitySolver() : cache_(std::make_unique<Cache>()) {}
VelocitySolver::~VelocitySolver() = default;
VelocitySolver::VelocitySolver(VelocitySolver&&) noexcept = default;
VelocitySolver& VelocitySolver::operator=(VelocitySolver&&) noexcept = default;

VelocitySolution VelocitySolver::solve(const VelocityProblem& problem, const Settings& settings)
{
    Stopwatch watch;
    assert_shapes(problem);
    cache_->newton.reset();
    cache_->free_speed.reset();
    const std::optional<ContactAnswer> last = std::exchange(cache_->answer, std::nullopt);
    VelocitySolution solution = make_zero_solution(problem);
    if (!is_finite(problem) || !cache_->scale(problem)) {
        solution.status = SolveStatus::NotFinite;
        solution.kkt_residual = std::numeric_limits<double>::quiet_NaN();
    } else if (std::find(problem.is_fixed.begin(), problem.is_fixed.end(), 0) == problem.is_fixed.end()) {
        solution.infeasible_rows = cache_->constraints.impossible;  // nothing can move
        solution.status = solution.infeasible_rows.empty() ? SolveStatus::Certified : SolveStatus::Infeasible;
    } else {
        cache_->factorization.analyse(*problem.matrix, problem.places);
        cache_->newton.emplace(problem, cache_->constraints, cache_->factorization, settings);
        const bool is_repeat = problem.is_repeat && last;
        solution = cache_->keep(is_repeat ? cache_->newton->run_from(*last) : cache_->newton->run());
    }
    solution.solve_seconds = watch.lap() - solution.factorise_seconds;
    return solution;
}

VelocitySolution VelocitySolver::resume(const VelocityProblem& problem, const Settings& settings)
{
    if (!cache_->newton) return solve(problem, settings);
    Stopwatch watch;
    assert_shapes(problem);
    assert(2 * problem.friction.size() + problem.rows.size() >= cache_->constraints.rows.size() &&
           "rows are only appended");
    const std::vector<double> budgets = cache_->constraints.budgets;
    VelocitySolution solution = make_zero_solution(problem);
    if (!cache_->scale(problem)) {
        cache_->newton.reset();
        solution.status = SolveStatus::NotFinite;
        solution.kkt_residual = std::numeric_limits<double>::quiet_NaN();
    } else {
        cache_->constraints.budgets = budgets;
        solution = cache_->keep(cache_->newton->resume(settings));
    }
    solution.solve_seconds = watch.lap() - solution.factorise_seconds;
    return solution;
}

}  // namespace arris
