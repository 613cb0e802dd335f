// SPDX-License-Identifier: GPL-3.0-or-later
//
// The working-set method. A base pins the bounds expected active and factorises once. Where its solution
// violates a bound, or a pin pulls, those few coordinates form a working set U; NLopt solves the dense
// problem condensed on U; one backward solve gives the velocity; new violators join U, until there are none.
// Finite: U only grows within a base, the dense problem's pivoting is finite, and the number of bases is
// bounded. When the guess is too far off for a small U, NLopt on the sparse problem predicts a new guess
// instead, and the next base starts from it. Whatever happened on the way, the certificate judges what comes
// out.
#include "solver/velocity_solve.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "solver/factorization.h"
#include "solver/kkt_certificate.h"
#include "solver/primal_prediction.h"
#include "solver/stopwatch.h"
#include "solver/working_set.h"

namespace arris {
namespace {

/// Signs are trusted down to this share of the largest speed, or of the terms a multiplier is the sum of.
constexpr double kSignTolerance = 1e-13;

/// Two answers certified at 1e-9 can differ in soft modes: below this they no longer do.
constexpr double kAccurate = 1e-12;

constexpr int kRefinements = 2;

/// Members of U beyond which a new factorisation is cheaper than the dense work; the last extension may
/// exceed it by half. With more violators than kHopeless caps the worst of them are not worth solving for.
constexpr int kWorkingSetCap = 400;
constexpr int kHopeless = 3;

/// Bases that may end by exceeding the cap; after them U may grow to kLargestWorkingSet.
constexpr int kCappedBases = 6;
constexpr int kLargestWorkingSet = 2000;
constexpr int kMostBases = 10;

bool is_finite(const VelocityProblem& problem)
{
    const Eigen::SparseMatrix<double>& matrix = *problem.matrix;
    if (!Eigen::Map<const Eigen::VectorXd>(matrix.valuePtr(), matrix.nonZeros()).allFinite()) return false;
    if (!problem.rhs->allFinite()) return false;
    for (int i = 0; i < problem.lower.size();
         ++i)  // -infinity is no bound; NaN and +infinity are none that can be met
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

std::vector<char> active_by_guess(const VelocityProblem& problem)
{
    std::vector<char> is_active(problem.is_fixed.size(), 0);
    for (const int i : problem.guess) {
        assert(i >= 0 && i < problem.rhs->size());
        is_active[i] = !problem.is_fixed[i] && std::isfinite(problem.lower[i]);
    }
    return is_active;
}

/// Free coordinates below their bound and active ones that pull, outside `set`. NaN counts as a violation.
std::vector<int> find_violators(const VelocityProblem& problem, const Iterate& iterate, const WorkingSet& set)
{
    const double margin = kSignTolerance * iterate.velocity.lpNorm<Eigen::Infinity>();
    std::vector<int> violators;
    for (int i = 0; i < iterate.velocity.size(); ++i) {
        if (problem.is_fixed[i] || set.contains(i)) continue;
        const bool is_right = iterate.is_active[i]
                                  ? iterate.gradient[i] >= -kSignTolerance * iterate.magnitude[i]
                                  : iterate.velocity[i] >= problem.lower[i] - margin;
        if (!is_right) violators.push_back(i);
    }
    return violators;
}

/// The `count` violators whose correction alone would change the energy most: lambda^2 / A_ii or A_ii gap^2.
void keep_worst(const VelocityProblem& problem, const Iterate& iterate, int count,
                std::vector<int>& violators)
{
    const Eigen::VectorXd diagonal = problem.matrix->diagonal();
    const auto energy = [&](int i) {
        const double gap = problem.lower[i] - iterate.velocity[i];
        return iterate.is_active[i] ? iterate.gradient[i] * iterate.gradient[i] / diagonal[i]
                                    : diagonal[i] * gap * gap;
    };
    std::nth_element(violators.begin(), violators.begin() + count, violators.end(),
                     [&](int a, int b) { return std::pair(-energy(a), a) < std::pair(-energy(b), b); });
    violators.resize(static_cast<std::size_t>(count));
}

/// One solve: the rounds, and the best answer met so far.
class Search {
  public:
    Search(const VelocityProblem& problem, Factorization& factorization, double tolerance)
        : problem_(problem), factorization_(factorization), tolerance_(tolerance)
    {
        best_.velocity = best_.multipliers = Eigen::VectorXd::Zero(problem.rhs->size());
        best_.kkt_residual = std::numeric_limits<double>::infinity();
    }

    VelocitySolution run()
    {
        is_active_ = active_by_guess(problem_);
        for (int base = 0; base < kMostBases && !is_over_; ++base)
            run_base(base < kCappedBases ? kWorkingSetCap : kLargestWorkingSet);
        if (best_.kkt_residual <= tolerance_) best_.status = SolveStatus::Certified;
        return best_;
    }

  private:
    void run_base(int cap);
    void rebase_by_prediction(const Eigen::VectorXd& start);
    void rebase_with_changed(const Iterate& iterate, const std::vector<int>& violators);
    void finish(Iterate& iterate, const WorkingSet& set);
    bool certify(const Iterate& iterate);

    const VelocityProblem& problem_;
    Factorization& factorization_;
    double tolerance_;
    VelocitySolution best_;
    std::vector<char> is_active_;  ///< what the next base pins
    bool has_rebased_for_accuracy_ = false;
    bool is_over_ = false;
};

/// Ends with `is_over_`, or with the next base's pins in `is_active_`.
void Search::run_base(int cap)
{
    Stopwatch watch;
    is_over_ = !factorization_.factorise(*problem_.matrix, find_pinned(problem_, is_active_));
    best_.factorise_seconds += watch.lap();
    ++best_.factorisations;
    if (is_over_) return;  // not positive definite: NotConverged

    const PinnedBase base = solve_pinned(problem_, is_active_, factorization_);
    if (!base.iterate.velocity.allFinite()) {
        best_.status = SolveStatus::NotFinite;
        is_over_ = true;
        return;
    }
    WorkingSet set(base);
    Iterate iterate = base.iterate;
    for (;;) {  // ends: U grows by at least one each time, up to the cap
        std::vector<int> violators = find_violators(problem_, iterate, set);
        if (violators.empty()) return finish(iterate, set);
        const int count = static_cast<int>(violators.size()), room = cap + cap / 2 - set.size();
        if (count > kHopeless * cap) return rebase_by_prediction(iterate.velocity);
        if (set.size() >= cap) return rebase_with_changed(iterate, violators);
        if (count > room) keep_worst(problem_, iterate, room, violators);
        set.extend(violators);
        if (!set.solve(iterate, best_.nlopt_evaluations)) return rebase_by_prediction(iterate.velocity);
    }
}

void Search::rebase_by_prediction(const Eigen::VectorXd& start)
{
    ActivePrediction prediction = predict_active_bounds(problem_, start);
    best_.nlopt_evaluations += prediction.nlopt_evaluations;
    is_active_ = std::move(prediction.is_active);
}

/// The working set has done most of the work: what is left may change sides untried.
void Search::rebase_with_changed(const Iterate& iterate, const std::vector<int>& violators)
{
    is_active_ = iterate.is_active;
    for (const int i : violators) is_active_[i] = !is_active_[i];
}

/// No violator is left: accept, or refine, or factorise once more with exactly these bounds pinned.
void Search::finish(Iterate& iterate, const WorkingSet& set)
{
    is_active_ = iterate.is_active;
    is_over_ = certify(iterate);
    for (int step = 0; step < kRefinements && !is_over_; ++step) {
        if (!set.refine(iterate)) break;
        is_over_ = certify(iterate);
    }
    if (is_over_) return;
    const bool is_new_base = set.size() > 0;
    is_over_ = !is_new_base || (has_rebased_for_accuracy_ && best_.kkt_residual <= tolerance_);
    has_rebased_for_accuracy_ = true;
}

/// Keeps the iterate where it is the best so far; true where it is as accurate as it needs to be.
bool Search::certify(const Iterate& iterate)
{
    Eigen::VectorXd multipliers = Eigen::VectorXd::Zero(iterate.velocity.size());
    for (int i = 0; i < multipliers.size(); ++i)
        if (iterate.is_active[i]) multipliers[i] = std::max(iterate.gradient[i], 0.0);
    const double residual = kkt_residual(problem_, iterate.velocity, multipliers);
    if (residual < best_.kkt_residual) {
        best_.kkt_residual = residual;
        best_.velocity = iterate.velocity;
        best_.multipliers = std::move(multipliers);
    }
    return residual <= kAccurate;
}

}  // namespace

struct VelocitySolver::Cache {
    Factorization factorization;
};

VelocitySolver::VelocitySolver() : cache_(std::make_unique<Cache>()) {}
VelocitySolver::~VelocitySolver() = default;
VelocitySolver::VelocitySolver(VelocitySolver&&) noexcept = default;
VelocitySolver& VelocitySolver::operator=(VelocitySolver&&) noexcept = default;

VelocitySolution VelocitySolver::solve(const VelocityProblem& problem, const Settings& settings)
{
    Stopwatch watch;
    assert_shapes(problem);
    VelocitySolution solution;
    solution.velocity = solution.multipliers = Eigen::VectorXd::Zero(problem.rhs->size());
    if (!is_finite(problem)) {
        solution.status = SolveStatus::NotFinite;
        solution.kkt_residual = std::numeric_limits<double>::quiet_NaN();
    } else if (std::find(problem.is_fixed.begin(), problem.is_fixed.end(), 0) == problem.is_fixed.end()) {
        solution.status = SolveStatus::Certified;  // nothing can move
    } else {
        cache_->factorization.analyse(*problem.matrix);
        solution = Search(problem, cache_->factorization, settings.tolerance).run();
    }
    solution.solve_seconds = watch.lap() - solution.factorise_seconds;
    return solution;
}

}  // namespace arris
