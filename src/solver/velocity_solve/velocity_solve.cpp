// SPDX-License-Identifier: GPL-3.0-or-later
// The working-set method. A base pins the bounds expected active and factorises once. Violated bounds and
// rows, and pins with a negative multiplier, form a working set U. NLopt solves the dense problem condensed
// on U, and one backward solve gives the velocity. New violators join U until there are none. Rows expected
// active start in U and are never part of a base, as a penalty would cost the factor its accuracy. Finite: U
// only grows within a base, the dense pivoting is finite, and the number of bases is bounded. If the guess is
// too far off for a small U, NLopt on the sparse problem predicts the next base's guess. Whatever happened,
// the certificate judges the answer.
#include "solver/velocity_solve/velocity_solve.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

#include "solver/model/stopwatch.h"
#include "solver/velocity_solve/factorization.h"
#include "solver/velocity_solve/kkt_certificate.h"
#include "solver/velocity_solve/primal_prediction.h"
#include "solver/velocity_solve/violators.h"
#include "solver/velocity_solve/working_set.h"

namespace arris {
namespace {

/// Answers certified at 1e-9 can still differ in soft modes; below this residual they do not.
constexpr double kAccurate = 1e-12;

/// KKT residual at which infeasible rows are reported. Larger than the tolerance for velocities, as capped
/// multipliers are a thousand times larger than others.
constexpr double kNaming = 1e-6;

constexpr int kRefinements = 2;

/// Corrections of a dense problem with rows: each removes wrong signs due to round-off in S.
constexpr int kCorrections = 3;

/// Size of U beyond which a new factorisation is cheaper than the dense work; the last extension may exceed
/// this by half. If the violators exceed kHopeless times this number, solving for the worst of them does not
/// pay.
constexpr int kWorkingSetCap = 400;
constexpr int kHopeless = 3;

/// Bases that may end by exceeding the cap; after them U may grow to kLargestWorkingSet.
constexpr int kCappedBases = 6;
constexpr int kLargestWorkingSet = 2000;
constexpr int kMostBases = 10;

/// Largest number of rows in U. Rows do not count towards the cap, as no factorisation takes them over.
constexpr int kMostRows = 3000;

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

std::vector<char> active_by_guess(const VelocityProblem& problem)
{
    std::vector<char> is_active(problem.is_fixed.size(), 0);
    for (const int i : problem.guess) {
        assert(i >= 0 && i < problem.rhs->size());
        is_active[i] = !problem.is_fixed[i] && std::isfinite(problem.lower[i]);
    }
    return is_active;
}

VelocitySolution nothing(const VelocityProblem& problem)
{
    VelocitySolution solution;
    solution.velocity = solution.multipliers = Eigen::VectorXd::Zero(problem.rhs->size());
    solution.row_multipliers = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(problem.rows.size()));
    return solution;
}

std::vector<int> pressing_rows(const Iterate& iterate)
{
    std::vector<int> rows;
    for (int k = 0; k < iterate.row_multipliers.size(); ++k)
        if (iterate.row_multipliers[k] > 0.0) rows.push_back(k);
    return rows;
}

/// A factorised base with its working set and current iterate.
struct BaseInUse {
    PinnedBase base;
    WorkingSet set;
    Iterate iterate;

    explicit BaseInUse(PinnedBase solved) : base(std::move(solved)), set(base), iterate(base.iterate) {}
    BaseInUse(const BaseInUse&) = delete;  // the set refers to the base
    BaseInUse& operator=(const BaseInUse&) = delete;
};

}  // namespace

struct VelocitySolver::Cache {
    Factorization factorization;
    ConstraintRows constraints;
    std::optional<double> free_speed;  ///< m/s, from the last solve's A, b
    std::optional<BaseInUse> in_use;   ///< of the last solve, for `resume`

    /// False where rows are not finite.
    bool scale(const VelocityProblem& problem)
    {
        if (!problem.rows.empty() && !free_speed) free_speed = estimate_free_speed(problem);
        constraints = scale_rows(problem, free_speed.value_or(0.0));
        return constraints.is_finite;
    }
};

namespace {

/// One solve: its rounds and the best answer so far.
class Search {
  public:
    Search(const VelocityProblem& problem, Factorization& factorization, const ConstraintRows& constraints,
           std::optional<BaseInUse>& in_use, double tolerance)
        : problem_(problem),
          factorization_(factorization),
          constraints_(constraints),
          in_use_(in_use),
          tolerance_(tolerance)
    {
        best_ = nothing(problem);
        best_.kkt_residual = std::numeric_limits<double>::infinity();
    }

    VelocitySolution run()
    {
        is_active_ = active_by_guess(problem_);
        rows_ = rows_of_guess();
        return run_bases();
    }

    /// Goes on from the base in use, which belongs to this problem with fewer rows.
    VelocitySolution resume();

  private:
    VelocitySolution run_bases();
    void run_base(int cap);
    void run_rounds(int cap);
    bool start_rows();
    void rebase_by_prediction();
    void rebase_with_changed(const Violators& violators);
    bool finish();
    void refine();
    bool certify();
    std::vector<int> rows_of_guess() const;
    std::vector<int> find_infeasible_rows() const;

    const VelocityProblem& problem_;
    Factorization& factorization_;
    const ConstraintRows& constraints_;
    std::optional<BaseInUse>& in_use_;
    double tolerance_;
    VelocitySolution best_;        ///< row multipliers belong to the scaled rows until the end
    std::vector<char> is_active_;  ///< pins of the next base
    std::vector<int> rows_;        ///< rows with which the next base's working set starts
    bool has_rebased_for_accuracy_ = false;
    bool is_over_ = false;
};

std::vector<int> Search::rows_of_guess() const
{
    std::vector<int> rows;
    for (const int k : problem_.row_guess) {
        assert(k >= 0 && k < static_cast<int>(constraints_.rows.size()));
        const bool is_known = in_use_ && in_use_->set.contains_row(k);
        if (!is_known && !constraints_.rows[k].entries.empty()) rows.push_back(k);
    }
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    return rows;
}

VelocitySolution Search::run_bases()
{
    for (int base = 0; base < kMostBases && !is_over_; ++base)
        run_base(base < kCappedBases ? kWorkingSetCap : kLargestWorkingSet);
    best_.infeasible_rows = find_infeasible_rows();
    for (std::size_t k = 0; k < constraints_.rows.size(); ++k)
        best_.row_multipliers[static_cast<Eigen::Index>(k)] /= constraints_.rows[k].scale;
    if (best_.infeasible_rows.empty()) {
        if (best_.kkt_residual <= tolerance_) best_.status = SolveStatus::Certified;
    } else if (best_.kkt_residual <= std::max(tolerance_, kNaming)) {
        best_.status = SolveStatus::Infeasible;
    }
    return best_;
}

VelocitySolution Search::resume()
{
    PinnedBase& base = in_use_->base;
    base.problem = &problem_;
    base.iterate.row_multipliers = best_.row_multipliers;
    in_use_->set.see_new_rows();
    in_use_->iterate = base.iterate;
    rows_ = rows_of_guess();
    if (start_rows()) run_rounds(kWorkingSetCap);
    return run_bases();
}

/// Ends with `is_over_`, or with the next base's pins in `is_active_`.
void Search::run_base(int cap)
{
    Stopwatch watch;
    in_use_.reset();
    is_over_ = !factorization_.factorise(*problem_.matrix, find_pinned(problem_, is_active_));
    best_.factorise_seconds += watch.lap();
    ++best_.factorisations;
    if (is_over_) return;  // not positive definite: NotConverged

    PinnedBase base = solve_pinned(problem_, constraints_, is_active_, factorization_);
    if (!base.iterate.velocity.allFinite()) {
        best_.status = SolveStatus::NotFinite;
        is_over_ = true;
        return;
    }
    in_use_.emplace(std::move(base));
    if (start_rows()) run_rounds(cap);
}

/// Solves for the working set with the rows expected active. False: the next base goes without these rows.
bool Search::start_rows()
{
    in_use_->set.extend({}, rows_);
    rows_.clear();
    if (in_use_->set.size() == 0) return true;
    if (in_use_->set.solve(in_use_->iterate, best_.nlopt_evaluations)) return true;
    is_active_ = in_use_->base.iterate.is_active;
    return false;
}

void Search::run_rounds(int cap)
{
    auto& [base, set, iterate] = *in_use_;
    for (;;) {  // ends: U grows by at least one member per round, up to the cap
        Violators violators = find_violators(base, iterate, set);
        if (violators.empty()) {
            if (finish()) return;
            continue;
        }
        const int count = static_cast<int>(violators.coordinates.size()),
                  row_count = static_cast<int>(violators.rows.size());
        const int room = cap + cap / 2 - set.coordinate_count(), row_room = kMostRows - set.row_count();
        if (count > kHopeless * cap) return rebase_by_prediction();
        if (count > 0 && set.coordinate_count() >= cap) return rebase_with_changed(violators);
        if (row_count > 0 && row_room == 0) return rebase_with_changed(violators);
        if (count > room) keep_worst_coordinates(base, iterate, room, violators.coordinates);
        if (row_count > row_room) keep_worst_rows(base, iterate, row_room, violators.rows);
        set.extend(violators.coordinates, violators.rows);
        if (!set.solve(iterate, best_.nlopt_evaluations)) return rebase_by_prediction();
    }
}

void Search::rebase_by_prediction()
{
    const Iterate& iterate = in_use_->iterate;
    ActivePrediction prediction = predict_active_bounds(problem_, constraints_, iterate);
    best_.nlopt_evaluations += prediction.nlopt_evaluations;
    is_active_ = std::move(prediction.is_active);
    rows_ = pressing_rows(iterate);
}

/// Most of the work is done: the remaining violators change sides without a solve for them.
void Search::rebase_with_changed(const Violators& violators)
{
    is_active_ = in_use_->iterate.is_active;
    for (const int i : violators.coordinates) is_active_[i] = !is_active_[i];
    rows_ = pressing_rows(in_use_->iterate);
}

/// No violator is left: accepts, refines, or factorises once more with exactly these bounds pinned. False
/// where refinement has revealed new violators.
bool Search::finish()
{
    auto& [base, set, iterate] = *in_use_;
    is_over_ = certify();
    refine();
    for (int step = 0; step < kCorrections && set.row_count() > 0 && !is_over_; ++step) {
        if (!set.correct(iterate)) break;
        refine();
    }
    if (is_over_) return true;
    if (set.row_count() > 0 && !find_violators(base, iterate, set).empty()) return false;
    is_active_ = iterate.is_active;
    rows_ = pressing_rows(iterate);
    const bool is_new_base = set.row_count() == 0 ? set.size() > 0 : is_active_ != base.iterate.is_active;
    is_over_ = !is_new_base || (has_rebased_for_accuracy_ && best_.kkt_residual <= tolerance_);
    has_rebased_for_accuracy_ = true;
    return true;
}

void Search::refine()
{
    for (int step = 0; step < kRefinements && !is_over_; ++step) {
        if (!in_use_->set.refine(in_use_->iterate)) break;
        is_over_ = certify();
    }
}

/// Keeps the iterate if it is the best so far; true where it is accurate enough.
bool Search::certify()
{
    const Iterate& iterate = in_use_->iterate;
    Eigen::VectorXd multipliers = Eigen::VectorXd::Zero(iterate.velocity.size());
    for (int i = 0; i < multipliers.size(); ++i)
        if (iterate.is_active[i]) multipliers[i] = std::max(iterate.gradient[i], 0.0);
    const double residual =
        kkt_residual(problem_, constraints_, iterate.velocity, multipliers, iterate.row_multipliers);
    if (residual < best_.kkt_residual) {
        best_.kkt_residual = residual;
        best_.velocity = iterate.velocity;
        best_.multipliers = std::move(multipliers);
        best_.row_multipliers = iterate.row_multipliers;
    }
    return residual <= kAccurate;
}

/// Rows at their cap that are violated by more than the certificate allows, and rows without a movable
/// coordinate.
std::vector<int> Search::find_infeasible_rows() const
{
    std::vector<int> infeasible = constraints_.impossible;
    const double slack =
        tolerance_ * std::max(best_.velocity.lpNorm<Eigen::Infinity>(), constraints_.least_speed);
    for (std::size_t k = 0; k < constraints_.rows.size(); ++k) {
        const ScaledRow& row = constraints_.rows[k];
        if (row.entries.empty() || best_.row_multipliers[static_cast<Eigen::Index>(k)] < row.cap) continue;
        if (gap(row, best_.velocity) < -slack) infeasible.push_back(static_cast<int>(k));
    }
    std::sort(infeasible.begin(), infeasible.end());
    return infeasible;
}

}  // namespace

VelocitySolver::VelocitySolver() : cache_(std::make_unique<Cache>()) {}
VelocitySolver::~VelocitySolver() = default;
VelocitySolver::VelocitySolver(VelocitySolver&&) noexcept = default;
VelocitySolver& VelocitySolver::operator=(VelocitySolver&&) noexcept = default;

VelocitySolution VelocitySolver::solve(const VelocityProblem& problem, const Settings& settings)
{
    Stopwatch watch;
    assert_shapes(problem);
    cache_->in_use.reset();
    cache_->free_speed.reset();
    VelocitySolution solution = nothing(problem);
    if (!is_finite(problem) || !cache_->scale(problem)) {
        solution.status = SolveStatus::NotFinite;
        solution.kkt_residual = std::numeric_limits<double>::quiet_NaN();
    } else if (std::find(problem.is_fixed.begin(), problem.is_fixed.end(), 0) == problem.is_fixed.end()) {
        solution.infeasible_rows = cache_->constraints.impossible;  // nothing can move
        solution.status = solution.infeasible_rows.empty() ? SolveStatus::Certified : SolveStatus::Infeasible;
    } else {
        cache_->factorization.analyse(*problem.matrix);
        solution =
            Search(problem, cache_->factorization, cache_->constraints, cache_->in_use, settings.tolerance)
                .run();
    }
    solution.solve_seconds = watch.lap() - solution.factorise_seconds;
    return solution;
}

VelocitySolution VelocitySolver::resume(const VelocityProblem& problem, const Settings& settings)
{
    if (!cache_->in_use) return solve(problem, settings);
    Stopwatch watch;
    assert_shapes(problem);
    assert(problem.rows.size() >= cache_->constraints.rows.size() && "rows are only appended");
    VelocitySolution solution = nothing(problem);
    if (!cache_->scale(problem)) {
        cache_->in_use.reset();
        solution.status = SolveStatus::NotFinite;
        solution.kkt_residual = std::numeric_limits<double>::quiet_NaN();
    } else {
        solution =
            Search(problem, cache_->factorization, cache_->constraints, cache_->in_use, settings.tolerance)
                .resume();
    }
    solution.solve_seconds = watch.lap() - solution.factorise_seconds;
    return solution;
}

}  // namespace arris
