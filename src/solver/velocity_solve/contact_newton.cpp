// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/contact_newton.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "solver/model/stopwatch.h"
#include "solver/velocity_solve/kkt_certificate.h"
#include "solver/velocity_solve/newton_step.h"

namespace arris {
namespace {

using Eigen::VectorXd;

/// Answers certified at 1e-9 can still differ in soft modes; below the first residual they do not. With
/// friction they differ by more than the second, as budgets agree with their law to kAgreement.
constexpr double kAccurate = 1e-12, kAccurateWithFriction = 1e-10;

/// KKT residual at which infeasible rows are reported. Larger than the tolerance for velocities, as the
/// multipliers of rows that cannot be met are far larger than others.
constexpr double kNaming = 1e-6;

/// Flops of dense work on k members, in units of k^3: a new factor is cheaper where its flops are fewer. With
/// 1 a third more time, with 8 the same as with 4.
constexpr double kMemberFlops = 4.0;
constexpr int kLeastMembers = 20, kMostMembers = 500;

/// Relative step below which the iteration converges: budgets of friction follow the forces.
constexpr double kFollow = 1e-2;

/// Error of friction's law at which budgets agree.
constexpr double kAgreement = 2e-5;
constexpr int kMostMoves = 40;

constexpr int kMostIterations = 150;

double largest(const VectorXd& values)
{
    return values.lpNorm<Eigen::Infinity>();
}

void add_new(const std::vector<int>& from, std::vector<int>& to)
{
    for (const int k : from)
        if (std::find(to.begin(), to.end(), k) == to.end()) to.push_back(k);
}

/// Members that may join at a time.
int most_at_once(const Members& members)
{
    constexpr int kFew = 32;
    return std::max(kFew, members.size() / 2);
}

}  // namespace

ContactNewton::ContactNewton(const VelocityProblem& problem, ConstraintRows& constraints,
                             Factorization& factorization, const Settings& settings)
    : problem_(problem),
      constraints_(constraints),
      factorization_(factorization),
      settings_(&settings),
      laws_(problem, constraints),
      accurate_(laws_.has_budget_law() ? kAccurateWithFriction : kAccurate),
      base_(problem, constraints, factorization),
      best_(make_zero_solution(problem)),
      best_residual_(std::numeric_limits<double>::infinity())
{
    const double affordable = std::cbrt(factorization.flops() / kMemberFlops);
    most_members_ = std::clamp(static_cast<int>(affordable), kLeastMembers, kMostMembers);
}

VelocitySolution ContactNewton::run()
{
    work_ = {problem_.most_work * unit_of_work(), settings_};
    at_ = laws_.start_from_guess();
    if (!factorise()) return finish();
    std::optional<NewtonStep> step = find_step(laws_, base_, *members_, work_, at_);
    if (!step) return finish();
    best_.nlopt_evaluations += step->nlopt_evaluations;
    if (!step->is_finite) {
        best_.status = SolveStatus::NotFinite;
        return finish();
    }
    at_.point = reference_ = std::move(step->change);
    return iterate();
}

VelocitySolution ContactNewton::run_from(const ContactAnswer& last)
{
    if (last.state.is_pressing.size() != constraints_.rows.size() ||
        last.budgets.size() != constraints_.budgets.size() || last.velocity.size() != problem_.rhs->size())
        return run();
    work_ = {problem_.most_work * unit_of_work(), settings_};
    at_ = laws_.start_from(last);
    reference_ = at_.point;
    if (!factorise()) return finish();
    return iterate();
}

VelocitySolution ContactNewton::resume(const Settings& settings)
{
    settings_ = &settings;
    base_.see_new_rows();
    if (members_) members_->see_new_rows();
    laws_.append_rows(at_);
    best_ = make_zero_solution(problem_);
    best_residual_ = std::numeric_limits<double>::infinity();
    now_ = {};
    moves_ = {};
    if (!members_) return run();
    work_ = {problem_.most_work * unit_of_work(), settings_};
    reference_ = at_.point;
    return iterate();
}

VelocitySolution ContactNewton::iterate()
{
    now_.is_agreed = !laws_.has_budget_law();
    for (now_.iterations = 0; now_.iterations < kMostIterations; ++now_.iterations) {
        settings_->stop_if_interrupted();
        laws_.evaluate(acting(), at_);
        if (!now_.is_agreed && agree_budgets()) laws_.evaluate(acting(), at_);
        if (now_.is_agreed && certify()) break;
        if (!choose_base()) break;
        std::optional<NewtonStep> step = find_step(laws_, base_, *members_, work_, at_);
        if (!step || !step->is_finite) break;
        best_.nlopt_evaluations += step->nlopt_evaluations;
        take(std::move(step->change));
    }
    return finish();
}

/// By scaled row: whether the linear model has it.
std::vector<char> ContactNewton::acting() const
{
    std::vector<char> acts = base_.state().is_pressing;
    for (std::size_t k = 0; k < acts.size(); ++k) acts[k] = acts[k] || members_->has_row(static_cast<int>(k));
    return acts;
}

/// Whether budgets may still move. The last iterations are for the answer with those that are then found,
/// which is certain: with fixed budgets the energy is convex.
bool ContactNewton::may_move() const
{
    return moves_.count() < kMostMoves && 3 * now_.iterations < 2 * kMostIterations;
}

/// True where budgets have moved.
bool ContactNewton::agree_budgets()
{
    constexpr double kSmall = 1e-3;  // relative step with which budgets may count as agreed
    if (!(now_.relative_step <= kFollow) || !now_.is_long_step) return false;
    const LawfulBudgets lawful = laws_.find_budgets(at_);
    now_.is_agreed = (lawful.error <= kAgreement && now_.relative_step <= kSmall) || !may_move();
    if (now_.is_agreed) return false;
    laws_.budgets() = moves_.next(laws_.budgets(), lawful.budgets);
    now_.is_steady = false;
    return true;
}

/// Keeps the point if it is the best so far; true where it is accurate enough, or no better one comes.
bool ContactNewton::certify()
{
    constexpr double kNearlyBalanced = 1e-8;  // residual at which a certificate is tried
    constexpr double kBetter = 0.8;           // ratio of residuals
    constexpr int kPatience = 2;
    constexpr double kOff = 3.0;  // times kAgreement: refining has spoiled what agreed
    const double scale = largest(*problem_.rhs) + largest(at_.point.product) + largest(at_.multipliers);
    double unbalanced = 0.0;
    VectorXd bounds = VectorXd::Zero(at_.residual.size());
    for (int i = 0; i < bounds.size(); ++i)
        if (at_.wanted.is_active[i])
            bounds[i] = -at_.residual[i];
        else
            unbalanced = std::max(unbalanced, std::abs(at_.residual[i]));
    if (!(unbalanced <= kNearlyBalanced * scale)) return false;
    const double residual = kkt_residual(problem_, constraints_, at_.point.velocity, bounds, at_.multipliers);
    const LawfulBudgets lawful = laws_.has_budget_law() ? laws_.find_budgets(at_) : LawfulBudgets();
    const ModelChanges changes = find_changes(constraints_, base_, *members_, at_.wanted);
    now_.without_better =
        residual < kBetter * best_residual_ || changes.fresh() > 0 ? 0 : now_.without_better + 1;
    if (residual < best_residual_) {
        best_residual_ = residual;
        const VelocitySolution cost = std::exchange(best_, laws_.make_solution(at_));
        best_.add_cost(cost);
        best_.kkt_residual = residual;
        best_.infeasible_rows = find_infeasible_rows(constraints_, at_.multipliers);
        best_.law_residual = lawful.error;
        best_.law_worst = lawful.worst;
    }
    const bool is_accurate = residual <= accurate_ && changes.bounds.empty();
    if (!is_accurate && now_.without_better < kPatience) return false;
    if (!laws_.has_budget_law() || !may_move()) return true;
    now_.is_agreed = lawful.error <= kOff * kAgreement;
    if (!now_.is_agreed) {
        best_residual_ = std::numeric_limits<double>::infinity();
        now_.without_better = 0;
    }
    return now_.is_agreed;
}

bool ContactNewton::is_converging() const
{
    return now_.is_steady && now_.is_long_step && now_.relative_step < kFollow;
}

/// Whether the iterations left at the present rate would cost more than a new factor, after which few are
/// left.
bool ContactNewton::is_slow()
{
    constexpr double kAfter = 1.0;  // work, in factorisations' worth, of the iterations after a new factor
    constexpr double kSlow = 0.9;   // ratio of steps at which no end is near
    const bool is_measured = is_converging() && now_.last_step < kFollow && now_.relative_step > accurate_;
    const double spent = (now_.last_work - work_.flops) / unit_of_work(),
                 rate = now_.relative_step / now_.last_step;
    now_.last_work = work_.flops;
    now_.last_step = now_.relative_step;
    if (!is_measured) return false;
    const double left =
        rate < kSlow ? std::log(accurate_ / now_.relative_step) / std::log(rate) : kMostIterations;
    return left * spent > 1.0 + kAfter;
}

/// Takes in what differs from the base, or makes a new base. False where that is not possible.
bool ContactNewton::choose_base()
{
    if (is_slow()) return factorise();
    if (is_converging()) want_missed_pairs();
    now_.is_steady = true;
    ModelChanges changes = find_changes(constraints_, base_, *members_, at_.wanted);
    add_new(now_.joining.bounds, changes.bounds);
    add_new(now_.joining.rows, changes.rows);
    now_.joining = {};
    if (now_.stalled > 1 || changes.count > most_changes() ||
        members_->size() + changes.fresh() > 2 * most_changes()) {
        now_.stalled = 0;
        return factorise();
    }
    members_->extend(changes.bounds, changes.rows);
    now_.has_fresh_members = changes.fresh() > 0;
    return true;
}

/// Pairs whose forces the last linear model has missed most become members: their springs in the base are
/// what slows convergence.
void ContactNewton::want_missed_pairs()
{
    constexpr double kShare = 0.1;  // of the largest miss
    constexpr std::size_t kMost = 64;
    double most = 0.0;
    for (int p = 0; p < constraints_.pair_count(); ++p)
        if (!members_->has_row(2 * p)) most = std::max(most, at_.missed[p]);
    std::vector<int> rows;
    for (int p = 0; p < constraints_.pair_count(); ++p)
        if (at_.missed[p] > kShare * most && !members_->has_row(2 * p))
            rows.insert(rows.end(), {2 * p, 2 * p + 1});
    if (rows.size() <= kMost) now_.joining.rows = std::move(rows);
}

/// Flops of a factorisation. Of a tiny matrix it takes longer than its flops say.
double ContactNewton::unit_of_work() const
{
    constexpr double kLeastFlops = 1e6;
    return std::max(factorization_.flops(), kLeastFlops);
}

/// A base of the wanted state. What has no room in the matrix becomes a member.
bool ContactNewton::factorise()
{
    if (!work_.spend(factorization_.flops())) return false;
    Stopwatch watch;
    const bool is_done = base_.factorise(at_.wanted);
    best_.factorise_seconds += watch.lap();
    ++best_.factorisations;
    members_.reset();
    if (!is_done) return false;
    now_.has_fresh_members = now_.is_steady = false;
    members_.emplace(base_, problem_, constraints_, work_);
    const ModelChanges missing = find_changes(constraints_, base_, *members_, at_.wanted);
    without_room_ = missing.count;
    members_->extend(missing.bounds, missing.rows);
    return true;
}

/// Goes the whole step, if its changes have room beside the base, but not too often in a row. Else goes from
/// the last reference as far as the energy falls.
void ContactNewton::take(ContactPoint step)
{
    constexpr int kMostExcursions = 8;
    constexpr double kSettled = 1e-3;  // relative step after which the point is a new reference
    constexpr double kStalled = 1e-3, kShort = 0.1;
    double share = 1.0;
    if (now_.excursions >= kMostExcursions || !fits(step)) {
        step.add(1.0, at_.point);
        step.add(-1.0, reference_);
        at_.point = reference_;
        share = find_share(laws_, at_.point, step);
        if (share < kShort)
            now_.joining =
                find_first_changes(laws_, base_, *members_, at_, step,
                                   std::min(most_at_once(*members_), 2 * most_changes() - members_->size()));
        now_.stalled = share < kStalled && now_.joining.fresh() == 0 ? now_.stalled + 1 : 0;
        now_.excursions = 0;
        reference_.add(share, step);
    } else {
        ++now_.excursions;
    }
    at_.point.add(share, step);
    if (share < 1.0) at_.multipliers.setConstant(std::numeric_limits<double>::quiet_NaN());
    now_.is_long_step = share >= kShort;
    const double moved = largest(step.velocity);
    now_.relative_step = moved > 0.0 ? moved / laws_.speed_at(at_.point) : 0.0;
    if (now_.relative_step <= kFollow)  // sums carry the round-off of larger steps
        at_.point = laws_.make_point(std::move(at_.point.velocity));
    if (share == 1.0 && now_.relative_step <= kSettled && !now_.has_fresh_members) {
        reference_ = at_.point;
        now_.excursions = 0;
    }
}

/// Whether the changes at the end of a step have room.
bool ContactNewton::fits(const ContactPoint& step) const
{
    ContactPoint end = at_.point;
    end.add(1.0, step);
    ContactState state = at_.wanted;
    const double round_off = kSignTolerance * laws_.speed_at(end);
    for (int i = 0; i < end.velocity.size(); ++i)
        if (!problem_.is_fixed[i] && !state.is_active[i])
            state.is_active[i] = end.velocity[i] < problem_.lower[i] - round_off;
    laws_.set_rows_at(end, acting(), at_.impulses, state);
    const ModelChanges changes = find_changes(constraints_, base_, *members_, state);
    return changes.count <= most_changes() && members_->size() + changes.fresh() <= 2 * most_changes() &&
           changes.fresh() <= most_at_once(*members_);
}

VelocitySolution ContactNewton::finish()
{
    best_.budget_moves = moves_.count();
    best_.work = problem_.most_work - work_.flops / unit_of_work();
    if (best_residual_ < std::numeric_limits<double>::infinity()) {
        if (best_.infeasible_rows.empty()) {
            if (best_.kkt_residual <= settings_->tolerance) best_.status = SolveStatus::Certified;
        } else if (best_.kkt_residual <= std::max(settings_->tolerance, kNaming)) {
            best_.status = SolveStatus::Infeasible;
        }
    } else {
        best_.kkt_residual = best_residual_;
    }
    return best_;
}

}  // namespace arris
