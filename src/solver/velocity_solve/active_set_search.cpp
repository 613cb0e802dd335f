// SPDX-License-Identifier: GPL-3.0-or-later
// The working-set method. A base pins the bounds expected active and factorises once. Violated bounds and
// rows, and pins with a negative multiplier, form a working set U. NLopt solves the dense problem condensed
// on U, and one backward solve gives the velocity. New violators join U until there are none. Few rows
// expected active start in U. Many become springs in the matrix of the base (Newton's method for the
// springs): then no dense problem is as large as their number. Few springs that pull join U, which takes
// them out; many make a new base. All bases together are bounded, and so is the dense work. If the guess is
// too far off for a small U, NLopt on the sparse problem predicts the next base's guess. Whatever happened,
// the certificate judges the answer.
#include "solver/velocity_solve/active_set_search.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "solver/model/stopwatch.h"
#include "solver/velocity_solve/kkt_certificate.h"
#include "solver/velocity_solve/newton_share.h"
#include "solver/velocity_solve/primal_prediction.h"

namespace arris {
namespace {

/// Answers certified at 1e-9 can still differ in soft modes; below this residual they do not.
constexpr double kAccurate = 1e-12;

/// KKT residual at which infeasible rows are reported. Larger than the tolerance for velocities, as the
/// multipliers of rows that cannot be met are far larger than others.
constexpr double kNaming = 1e-6;

constexpr int kRefinements = 2;

/// Size of U beyond which a new factorisation is cheaper than the dense work; the last extension may exceed
/// this by half. If the violators exceed kHopeless times this number, solving for the worst of them does not
/// pay.
constexpr int kWorkingSetCap = 400;
constexpr int kHopeless = 3;

/// Bases that may end by exceeding the cap; in kLastBases more U may grow to kLargestWorkingSet. Newton's
/// method for the friction of a stack of five layers takes up to 17 bases.
constexpr int kCappedBases = 20, kCappedBasesWithFriction = 40;
constexpr int kLastBases = 10;
constexpr int kLargestWorkingSet = 2000;

/// Largest number of rows in U; if more press, they become part of the base.
constexpr int kMostRows = 600;

/// Rows that start in U: at most this number, and this share of the vertices. More become part of the base.
constexpr int kFewRows = 150;
constexpr double kFewShare = 0.01;

/// Bases in which all may change at once (Newton's method): friction's springs in all that have a cap, and
/// rows in kRowBases. After them, a row that has pulled in one is not part of a later one: U decides about
/// it.
constexpr int kRowBases = 4;

/// Share of a Newton step below which all of it is taken: changed bounds make it rise from the start.
constexpr double kLeastShare = 1e-6;

/// Friction pairs, or rows that change sides, that may join U at a time, and rows that may start in U beside
/// pairs: so many that the dense work, about kMemberFlops times the third power of their number, is that of
/// another base.
constexpr double kMemberFlops = 50.0;
constexpr int kLeastMembers = 10, kMostMembers = 150;

/// Floating-point operations on dense problems in one solve: as many as this number of factorisations take,
/// and kLeastFlops, about a second's work.
constexpr double kMostFactorisations = 30.0;
constexpr double kLeastFlops = 2e9;

/// Number of rows that U takes more cheaply than a base from the start.
double few_rows(const VelocityProblem& problem)
{
    return std::max<double>(kFewRows, kFewShare / 3.0 * static_cast<double>(problem.lower.size()));
}

int capped_bases(const VelocityProblem& problem)
{
    return problem.friction.empty() ? kCappedBases : kCappedBasesWithFriction;
}

/// Number of friction pairs, or of rows, that U takes more cheaply than a base.
int few_members(const Factorization& factorization)
{
    const int few = static_cast<int>(std::cbrt(factorization.flops() / kMemberFlops));
    return std::clamp(few, kLeastMembers, kMostMembers);
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

std::vector<int> pressing_rows(const ConstraintRows& constraints, const Iterate& iterate)
{
    std::vector<int> rows;
    for (int k = constraints.slip_count(); k < iterate.row_multipliers.size(); ++k)
        if (iterate.row_multipliers[k] > 0.0) rows.push_back(k);
    return rows;
}

}  // namespace

bool wants_rows_in_matrix(const VelocityProblem& problem, std::size_t pressing)
{
    return static_cast<double>(pressing) > few_rows(problem);
}

ActiveSetSearch::ActiveSetSearch(const VelocityProblem& problem, Factorization& factorization,
                                 const ConstraintRows& constraints, std::optional<BaseInUse>& in_use,
                                 const Settings& settings)
    : problem_(problem),
      factorization_(factorization),
      constraints_(constraints),
      in_use_(in_use),
      settings_(settings)
{
    best_ = make_zero_solution(problem);
    best_.kkt_residual = std::numeric_limits<double>::infinity();
    best_.row_multipliers = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(constraints.rows.size()));
    has_pulled_.assign(constraints.rows.size(), 0);
    is_pressing_.assign(constraints.rows.size(), 0);
    slips_ = starting_springs(problem, constraints);
    best_exact_.assign(problem.friction.size(), 0);
    budget_ = {kLeastFlops + kMostFactorisations * factorization.flops(), &settings};
}

VelocitySolution ActiveSetSearch::run(bool has_row_guess, int most_factorisations)
{
    is_active_ = active_by_guess(problem_);
    if (has_row_guess) choose_rows(rows_of_guess());
    return run_bases(most_factorisations);
}

std::vector<int> ActiveSetSearch::rows_of_guess() const
{
    std::vector<int> rows;
    for (const int guessed : problem_.row_guess) {
        const int k = constraints_.slip_count() + guessed;
        assert(guessed >= 0 && k < static_cast<int>(constraints_.rows.size()));
        if (!constraints_.rows[k].entries.empty()) rows.push_back(k);
    }
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    return rows;
}

VelocitySolution ActiveSetSearch::run_bases(int most_factorisations)
{
    const int capped = capped_bases(problem_), most = std::min(capped + kLastBases, most_factorisations);
    for (int base = 0; base < most && budget_.flops > 0.0 && !is_over_; ++base)
        run_base(base < capped ? kWorkingSetCap : kLargestWorkingSet);
    if (in_use_) in_use_->measure_lag();
    best_.infeasible_rows = find_infeasible_rows(constraints_, best_.row_multipliers);
    for (std::size_t k = 0; k < constraints_.rows.size(); ++k)
        best_.row_multipliers[static_cast<Eigen::Index>(k)] /= constraints_.rows[k].scale;
    for (int p = 0; p < constraints_.pair_count(); ++p) {
        const double scale = constraints_.rows[2 * p].scale;
        const Eigen::Vector2d y = slip_of(constraints_, p, best_.velocity);
        const auto& [first, second] = problem_.friction[p].slip;
        best_.friction[p] = best_.row_multipliers.segment<2>(2 * p);
        best_.slip[p] = scale * y - Eigen::Vector2d(first.lower, second.lower);
        // The law is solved for the impulse: 1 / give would magnify the slip's round-off.
        constexpr double kInside = 1.0 - 1e-9;
        const bool sticks =
            best_exact_[p] && best_.friction[p].norm() < kInside * constraints_.budgets[p] / scale;
        best_.unlimited[p] =
            sticks ? best_.friction[p] : Eigen::Vector2d(unlimited_at(constraints_, p, y) / scale);
    }
    best_.row_multipliers =
        best_.row_multipliers.tail(static_cast<Eigen::Index>(problem_.rows.size())).eval();
    if (best_.infeasible_rows.empty()) {
        if (best_.kkt_residual <= settings_.tolerance) best_.status = SolveStatus::Certified;
    } else if (best_.kkt_residual <= std::max(settings_.tolerance, kNaming)) {
        best_.status = SolveStatus::Infeasible;
    }
    return best_;
}

VelocitySolution ActiveSetSearch::resume(int most_factorisations)
{
    PinnedBase& base = in_use_->base;
    base.problem = &problem_;
    base.is_pressing.resize(constraints_.rows.size(), 0);
    base.iterate.row_multipliers.conservativeResizeLike(best_.row_multipliers);
    base.iterate.has_let_go.resize(constraints_.rows.size(), 0);
    in_use_->set.see_new_rows();
    rows_ = in_use_->move_springs();
    in_use_->iterate = base.iterate;
    is_pressing_ = base.is_pressing;  // new rows are found as violators
    if (start_rows()) run_rounds(kWorkingSetCap);
    return run_bases(most_factorisations);
}

/// Ends with `is_over_`, or with the next base's pins in `is_active_` and its rows chosen.
void ActiveSetSearch::run_base(int cap)
{
    settings_.stop_if_interrupted();
    Stopwatch watch;
    in_use_.reset();
    std::optional<PinnedBase> base =
        solve_pinned(problem_, constraints_, is_active_, is_pressing_, slips_, factorization_);
    best_.factorise_seconds += watch.lap();
    ++best_.factorisations;
    is_over_ = !base;  // not positive definite: NotConverged
    if (is_over_) return;
    if (!base->iterate.velocity.allFinite()) {
        best_.status = SolveStatus::NotFinite;
        is_over_ = true;
        return;
    }
    in_use_.emplace(std::move(*base));
    if (start_rows()) run_rounds(cap);
}

/// Divides the rows expected to press between the next base and its working set.
void ActiveSetSearch::choose_rows(const std::vector<int>& expected)
{
    rows_.clear();
    is_pressing_.assign(constraints_.rows.size(), 0);
    const double few = problem_.friction.empty() ? few_rows(problem_) : few_members(factorization_);
    const bool is_few = static_cast<double>(expected.size()) <= few;
    for (const int k : expected) {
        if (!is_few && !has_pulled_[k] && has_room_for(*problem_.matrix, constraints_.rows[k]))
            is_pressing_[k] = 1;
        else if (static_cast<int>(rows_.size()) < kMostRows)  // the others join when they are violated
            rows_.push_back(k);
    }
}

/// Solves for the working set with the rows expected active. False: the next base goes without these rows.
bool ActiveSetSearch::start_rows()
{
    in_use_->set.extend({}, rows_);
    rows_.clear();
    if (in_use_->set.size() == 0) return true;
    if (in_use_->set.solve(in_use_->iterate, best_.nlopt_evaluations, budget_)) return true;
    is_active_ = in_use_->base.iterate.is_active;
    return false;
}

void ActiveSetSearch::run_rounds(int cap)
{
    PinnedBase& base = in_use_->base;
    WorkingSet& set = in_use_->set;
    Iterate& iterate = in_use_->iterate;
    for (;;) {  // ends: U grows by at least one member per round, up to the cap
        Violators violators = find_violators(base, iterate, set);
        if (violators.empty()) {
            if (finish()) return;
            continue;
        }
        if (has_many_changes(violators)) return rebase_with_violated_rows(violators);
        violators.rows.insert(violators.rows.end(), violators.pulling.begin(), violators.pulling.end());
        const int count = static_cast<int>(violators.coordinates.size()),
                  row_count = static_cast<int>(violators.rows.size()),
                  pair_count = static_cast<int>(violators.pairs.size());
        const int room = cap + cap / 2 - set.coordinate_count(), row_room = kMostRows - set.row_count();
        if (count > kHopeless * cap) return rebase_by_prediction();
        if (count > 0 && set.coordinate_count() >= cap) return rebase_with_changed(violators);
        if (row_count + pair_count > 0 && row_room <= 0) return rebase_with_changed(violators);
        if (count > room) keep_worst_coordinates(base, iterate, room, violators.coordinates);
        if (row_count > 0 && row_count > row_room)  // pairs may have left no room: then no row is violated
            keep_worst_rows(base, iterate, row_room, violators.rows);
        for (const int pair : violators.pairs)
            violators.rows.insert(violators.rows.end(), {2 * pair, 2 * pair + 1});
        set.extend(violators.coordinates, violators.rows);
        if (set.solve(iterate, best_.nlopt_evaluations, budget_)) continue;
        return violators.pulling.empty() ? rebase_by_prediction() : rebase_with_violated_rows(violators);
    }
}

/// The next base has the rows that press now, and the springs of friction at the present velocity.
void ActiveSetSearch::start_from_iterate()
{
    const Iterate& iterate = in_use_->iterate;
    choose_rows(pressing_rows(constraints_, iterate));
    newton_point_ = iterate.velocity;
    slips_ = springs_at(constraints_, iterate.row_multipliers, newton_point_);
}

void ActiveSetSearch::rebase_by_prediction()
{
    const Iterate& iterate = in_use_->iterate;
    ActivePrediction prediction = predict_active_bounds(problem_, constraints_, iterate);
    best_.nlopt_evaluations += prediction.nlopt_evaluations;
    is_active_ = std::move(prediction.is_active);
    start_from_iterate();
}

/// Whether so many friction pairs are far from their springs, or so many rows change sides at a base that has
/// rows, that another base costs less than U.
bool ActiveSetSearch::has_many_changes(const Violators& violators) const
{
    const std::vector<char>& in_base = in_use_->base.is_pressing;
    const int few = few_members(factorization_), pairs = static_cast<int>(violators.pairs.size()),
              rows = static_cast<int>(violators.rows.size() + violators.pulling.size());
    if (best_.factorisations <= capped_bases(problem_) && pairs > few) return true;
    if (rows <= few) return false;
    const bool has_rows = std::find(in_base.begin(), in_base.end(), 1) != in_base.end();
    return !violators.pulling.empty() || (best_.factorisations <= kRowBases && has_rows);
}

/// Newton's step: all rows violated now press in the next base. With friction it goes as far as the energy
/// falls. Rows alone need no line search: what pulls is soon left to U.
void ActiveSetSearch::rebase_with_violated_rows(const Violators& violators)
{
    const Iterate& iterate = in_use_->iterate;
    double share = 1.0;
    if (!problem_.friction.empty() && newton_point_.size() > 0)
        share = find_newton_share(problem_, constraints_, newton_point_, iterate.velocity);
    if (share < 1.0 && share > kLeastShare)
        newton_point_ += share * (iterate.velocity - newton_point_);
    else
        newton_point_ = iterate.velocity;
    slips_ = springs_at(constraints_, iterate.row_multipliers, newton_point_);
    const std::vector<int> violated = find_newton_rows(constraints_, iterate.row_multipliers, newton_point_);
    if (best_.factorisations > kRowBases)
        for (const int k : violators.pulling) has_pulled_[k] = 1;
    flip_bounds(violators.coordinates);
    choose_rows(violated);
}

/// The next base pins what is active now, except that these coordinates change sides.
void ActiveSetSearch::flip_bounds(const std::vector<int>& coordinates)
{
    is_active_ = in_use_->iterate.is_active;
    for (const int i : coordinates) is_active_[i] = !is_active_[i];
}

/// Most of the work is done: the remaining violators change sides without a solve for them.
void ActiveSetSearch::rebase_with_changed(const Violators& violators)
{
    flip_bounds(violators.coordinates);
    start_from_iterate();
}

/// No violator is left: accepts, refines, or factorises once more with exactly these bounds pinned. False
/// where refinement has revealed new violators.
bool ActiveSetSearch::finish()
{
    PinnedBase& base = in_use_->base;
    WorkingSet& set = in_use_->set;
    Iterate& iterate = in_use_->iterate;
    is_over_ = certify();
    refine();
    if (is_over_) return true;
    if (set.row_count() > 0 && !find_violators(base, iterate, set).empty()) return false;
    is_active_ = iterate.is_active;
    start_from_iterate();
    const bool is_new_base = set.row_count() == 0 ? set.size() > 0 : is_active_ != base.iterate.is_active;
    is_over_ = !is_new_base || (has_rebased_for_accuracy_ && best_.kkt_residual <= settings_.tolerance);
    has_rebased_for_accuracy_ = true;
    return true;
}

void ActiveSetSearch::refine()
{
    for (int step = 0; step < kRefinements && !is_over_; ++step) {
        if (!in_use_->set.refine(in_use_->iterate)) break;
        is_over_ = certify();
    }
}

/// Keeps the iterate if it is the best so far; true where it is accurate enough.
bool ActiveSetSearch::certify()
{
    const Iterate& iterate = in_use_->iterate;
    Eigen::VectorXd multipliers = Eigen::VectorXd::Zero(iterate.velocity.size());
    for (int i = 0; i < multipliers.size(); ++i)
        if (iterate.is_active[i]) multipliers[i] = std::max(iterate.gradient[i], 0.0);
    Eigen::VectorXd row_multipliers = iterate.row_multipliers.cwiseMax(0.0);
    const int slips = constraints_.slip_count();  // friction may push both ways
    row_multipliers.head(slips) = iterate.row_multipliers.head(slips);
    const double residual =
        kkt_residual(problem_, constraints_, iterate.velocity, multipliers, row_multipliers);
    if (residual < best_.kkt_residual) {
        best_.kkt_residual = residual;
        best_.velocity = iterate.velocity;
        best_.multipliers = std::move(multipliers);
        best_.row_multipliers = std::move(row_multipliers);
        best_exact_ = iterate.is_exact;
    }
    return residual <= kAccurate;
}

}  // namespace arris
