// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/velocity_solve.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "solver/model/stopwatch.h"
#include "solver/velocity_solve/active_set_search.h"

namespace arris {
namespace {

/// One search for the constraints that press.
struct SearchAttempt {
    double softening;    ///< factor of the rows' gives
    bool has_row_guess;  ///< starts with the rows expected to press
};

/// Tried in this order. Where very many rows depend on each other, a wrong guess may be worse than none, and
/// the search for stiff springs may not end within its budget. Softer ones still give way by less than 0.1 to
/// 1 % of the free speed, and the check of the whole path decides whether that is near enough.
constexpr SearchAttempt kAttempts[] = {{1.0, true}, {1.0, false}, {100.0, true}, {1000.0, true}};

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
    return solution;
}

struct VelocitySolver::Cache {
    Factorization factorization;
    ConstraintRows constraints;
    double softening = 1.0;            ///< of the last solve
    std::optional<double> free_speed;  ///< m/s, from the last solve's A, b
    std::optional<BaseInUse> in_use;   ///< of the last solve, for `resume`

    /// False where rows are not finite.
    bool scale(const VelocityProblem& problem)
    {
        if ((!problem.rows.empty() || !problem.friction.empty()) && !free_speed)
            free_speed = estimate_free_speed(problem);
        constraints = scale_rows(problem, free_speed.value_or(0.0), softening);
        return constraints.is_finite;
    }
};

VelocitySolver::VelocitySolver() : cache_(std::make_unique<Cache>()) {}
VelocitySolver::~VelocitySolver() = default;
VelocitySolver::VelocitySolver(VelocitySolver&&) noexcept = default;
VelocitySolver& VelocitySolver::operator=(VelocitySolver&&) noexcept = default;

VelocitySolution VelocitySolver::solve(const VelocityProblem& problem, const Settings& settings)
{
    return solve_within(problem.most_factorisations, problem, settings);
}

VelocitySolution VelocitySolver::solve_within(int most_factorisations, const VelocityProblem& problem,
                                              const Settings& settings)
{
    Stopwatch watch;
    assert_shapes(problem);
    cache_->in_use.reset();
    cache_->free_speed.reset();
    cache_->softening = 1.0;
    VelocitySolution solution = make_zero_solution(problem);
    if (!is_finite(problem) || !cache_->scale(problem)) {
        solution.status = SolveStatus::NotFinite;
        solution.kkt_residual = std::numeric_limits<double>::quiet_NaN();
    } else if (std::find(problem.is_fixed.begin(), problem.is_fixed.end(), 0) == problem.is_fixed.end()) {
        solution.infeasible_rows = cache_->constraints.impossible;  // nothing can move
        solution.status = solution.infeasible_rows.empty() ? SolveStatus::Certified : SolveStatus::Infeasible;
    } else {
        cache_->factorization.analyse(*problem.matrix);
        for (const SearchAttempt& attempt : kAttempts) {
            const bool is_first = &attempt == kAttempts;
            if (!is_first && (solution.status != SolveStatus::NotConverged || problem.rows.empty())) break;
            const int left = most_factorisations - solution.factorisations;
            if (!is_first && left <= 0) break;
            if (attempt.softening > cache_->softening) {
                cache_->softening = attempt.softening;
                cache_->scale(problem);
            }
            VelocitySolution found =
                ActiveSetSearch(problem, cache_->factorization, cache_->constraints, cache_->in_use, settings)
                    .run(attempt.has_row_guess, left);
            found.add_cost(solution);
            solution = std::move(found);
        }
    }
    solution.solve_seconds = watch.lap() - solution.factorise_seconds;
    return solution;
}

VelocitySolution VelocitySolver::resume(const VelocityProblem& problem, const Settings& settings)
{
    if (!cache_->in_use) return solve(problem, settings);
    Stopwatch watch;
    assert_shapes(problem);
    assert(2 * problem.friction.size() + problem.rows.size() >= cache_->constraints.rows.size() &&
           "rows are only appended");
    VelocitySolution solution = make_zero_solution(problem);
    if (!cache_->scale(problem)) {
        cache_->in_use.reset();
        solution.status = SolveStatus::NotFinite;
        solution.kkt_residual = std::numeric_limits<double>::quiet_NaN();
    } else {
        solution =
            ActiveSetSearch(problem, cache_->factorization, cache_->constraints, cache_->in_use, settings)
                .resume(problem.most_factorisations);
        const int left = problem.most_factorisations - solution.factorisations;
        if (solution.status == SolveStatus::NotConverged && left > 0) {  // from the beginning
            VelocitySolution again = solve_within(left, problem, settings);
            again.add_cost(solution);
            solution = std::move(again);
        }
    }
    solution.solve_seconds = watch.lap() - solution.factorise_seconds;
    return solution;
}

}  // namespace arris
