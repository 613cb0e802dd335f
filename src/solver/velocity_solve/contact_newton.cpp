// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/contact_newton.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "solver/model/stopwatch.h"
#include "solver/velocity_solve/friction_springs.h"
#include "solver/velocity_solve/kkt_certificate.h"
#include "solver/velocity_solve/line_search.h"
#include "solver/velocity_solve/symmetric_product.h"

namespace arris {
namespace {

using Eigen::Vector2d;
using Eigen::VectorXd;

/// Answers certified at 1e-9 can still differ in soft modes; below this residual they do not.
constexpr double kAccurate = 1e-12;

/// KKT residual at which infeasible rows are reported. Larger than the tolerance for velocities, as the
/// multipliers of rows that cannot be met are far larger than others.
constexpr double kNaming = 1e-6;

/// Values nearer to 0 are round-off, and tell no sign: of a gap, as a share of the largest speed.
constexpr double kSignTolerance = 1e-13;

/// Distance from a bound, as a share of the largest speed, at which a linear model has held it: the give of
/// the stiff springs that stand for bounds, with a margin.
constexpr double kHeld = 1e-7;

/// Stiffness of a bound where it is a spring, in units of its diagonal entry: in dense problems and line
/// searches.
constexpr double kBoundStiffness = 1e8;

/// Flops of dense work on k members, in units of k^3: a new factor is cheaper where its flops are fewer. With
/// 1 a third more time, with 8 the same as with 4.
constexpr double kMemberFlops = 4.0;
constexpr int kLeastMembers = 20, kMostMembers = 500;

/// Relative step below which budgets of friction follow the forces, and error of friction's law at which they
/// agree.
constexpr double kFollow = 1e-2, kAgreement = 5e-5;
constexpr int kMostMoves = 40;

/// Distance from the wanted stiffness within which a pair's spring in the base serves, at first.
constexpr double kNear = 0.4;

constexpr int kMostIterations = 150;

double largest(const VectorXd& values)
{
    return values.lpNorm<Eigen::Infinity>();
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

}  // namespace

ContactNewton::ContactNewton(const VelocityProblem& problem, ConstraintRows& constraints,
                             Factorization& factorization, const Settings& settings)
    : problem_(problem),
      constraints_(constraints),
      factorization_(factorization),
      settings_(settings),
      diagonal_(problem.matrix->diagonal()),
      base_(problem, constraints, factorization),
      best_(make_zero_solution(problem)),
      best_residual_(std::numeric_limits<double>::infinity())
{
    const double affordable = std::cbrt(factorization.flops() / kMemberFlops);
    most_members_ = std::clamp(static_cast<int>(affordable), kLeastMembers, kMostMembers);
}

ContactNewton::Point ContactNewton::make_point(VectorXd velocity) const
{
    Point point = {
        std::move(velocity), {}, VectorXd::Zero(static_cast<Eigen::Index>(constraints_.rows.size()))};
    point.product = symmetric_product(*problem_.matrix, point.velocity);
    for (Eigen::Index k = 0; k < point.row_values.size(); ++k)
        for (const auto& [coordinate, coefficient] : constraints_.rows[k].entries)
            point.row_values[k] += coefficient * point.velocity[coordinate];
    return point;
}

/// The linear model of the guess, at u = 0.
void ContactNewton::start_from_guess()
{
    point_ = make_point(VectorXd::Zero(problem_.rhs->size()));
    reference_ = {};
    multipliers_ = VectorXd::Zero(static_cast<Eigen::Index>(constraints_.rows.size()));
    const int pairs = constraints_.pair_count(), first = constraints_.slip_count();
    wanted_ = {active_by_guess(problem_), std::vector<char>(constraints_.rows.size(), 0), {}};
    for (const int guessed : problem_.row_guess) {
        const ScaledRow& row = constraints_.rows[first + guessed];
        if (row.entries.empty()) continue;
        wanted_.is_pressing[first + guessed] = 1;
        multipliers_[first + guessed] = row.lower / row.give;
    }
    VectorXd slips = VectorXd::Zero(first);  // C u of the pairs at the slips predicted
    for (int p = 0; p < pairs; ++p) {
        for (int d = 0; d < 2; ++d)
            slips[2 * p + d] = (problem_.friction[p].last[d] + problem_.friction[p].slip[d].lower) /
                               constraints_.rows[2 * p].scale;
        const Vector2d impulse = friction_at(constraints_, p, slips);
        wanted_.stiffness.push_back(slip_stiffness(unlimited_at(constraints_, p, slips), impulse,
                                                   constraints_.budgets[p], constraints_.rows[2 * p].give));
        multipliers_.segment<2>(2 * p) = impulse + wanted_.stiffness[p] * slips.segment<2>(2 * p);
    }
    impulses_ = multipliers_.head(first);
    residual_ = *problem_.rhs;
    for (Eigen::Index k = 0; k < multipliers_.size(); ++k)
        for (const auto& [coordinate, coefficient] : constraints_.rows[k].entries)
            residual_[coordinate] += coefficient * multipliers_[k];
}

VelocitySolution ContactNewton::run()
{
    work_ = {problem_.most_work * unit_of_work(), &settings_};
    start_from_guess();
    if (!factorise()) return finish();
    std::optional<Point> step = direction();
    if (!step) {
        if (!is_finite_) best_.status = SolveStatus::NotFinite;
        return finish();
    }
    point_ = std::move(*step);
    reference_ = point_;
    return iterate();
}

VelocitySolution ContactNewton::run_from(const ContactAnswer& last)
{
    const std::size_t rows = constraints_.rows.size(), pairs = constraints_.budgets.size();
    if (last.state.is_pressing.size() != rows || last.budgets.size() != pairs ||
        last.velocity.size() != problem_.rhs->size())
        return run();
    work_ = {problem_.most_work * unit_of_work(), &settings_};
    wanted_ = last.state;
    VectorXd velocity = last.velocity;
    for (int i = 0; i < velocity.size(); ++i) {
        if (problem_.is_fixed[i] || !std::isfinite(problem_.lower[i])) wanted_.is_active[i] = 0;
        if (problem_.is_fixed[i]) velocity[i] = 0.0;
        if (wanted_.is_active[i]) velocity[i] = problem_.lower[i];
    }
    impulses_.resize(constraints_.slip_count());
    for (std::size_t p = 0; p < pairs; ++p) {
        const double scale = constraints_.rows[2 * p].scale;
        if (constraints_.budgets[p] > 0.0 || last.budgets[p] > 0.0)
            constraints_.budgets[p] = scale * last.budgets[p];
        impulses_.segment<2>(2 * static_cast<Eigen::Index>(p)) = scale * last.impulses[p];
    }
    multipliers_ =
        VectorXd::Constant(static_cast<Eigen::Index>(rows), std::numeric_limits<double>::quiet_NaN());
    point_ = make_point(std::move(velocity));
    reference_ = point_;
    if (!factorise()) return finish();
    return iterate();
}

VelocitySolution ContactNewton::resume()
{
    work_ = {problem_.most_work * unit_of_work(), &settings_};
    const int first_slip = constraints_.slip_count();
    base_.see_new_rows();
    if (members_) members_->see_new_rows();
    const auto rows = static_cast<Eigen::Index>(constraints_.rows.size());
    const Eigen::Index known = multipliers_.size();
    multipliers_.conservativeResize(rows);
    multipliers_.tail(rows - known).setZero();
    wanted_.is_pressing.resize(constraints_.rows.size(), 0);
    assert(impulses_.size() == first_slip);
    (void)first_slip;
    best_ = make_zero_solution(problem_);
    best_residual_ = std::numeric_limits<double>::infinity();
    without_better_ = excursions_ = stalled_ = 0;
    is_agreed_ = false;
    moves_ = {};
    point_ = make_point(point_.velocity);
    reference_ = point_;
    if (!members_) return run();
    return iterate();
}

VelocitySolution ContactNewton::iterate()
{
    is_agreed_ = !has_law();
    for (int iteration = 0; iteration < kMostIterations; ++iteration) {
        settings_.stop_if_interrupted();
        evaluate();
        if (!is_agreed_ && agree_budgets()) evaluate();
        if (is_agreed_ && certify()) return finish();
        if (!choose_base()) return finish();
        std::optional<Point> step = direction();
        if (!step) return finish();
        take(std::move(*step));
    }
    return finish();
}

/// Multipliers by their laws at u, the residual, and the linear model there. A multiplier that the last
/// linear model gave stays, where the law's differs by round-off: that of a speed times the spring's
/// stiffness.
void ContactNewton::evaluate()
{
    const double speed = std::max(largest(point_.velocity), constraints_.least_speed);
    const auto is_round_off = [&](double difference, const ScaledRow& row) {
        return difference <= kSignTolerance * speed / row.give;
    };
    missed_.resize(constraints_.pair_count());
    for (int p = 0; p < constraints_.pair_count(); ++p) {
        const Vector2d unlimited = unlimited_at(constraints_, p, point_.row_values),
                       law = project_on_disc(unlimited, constraints_.budgets[p]);
        auto impulse = multipliers_.segment<2>(2 * p);
        missed_[p] = (impulse - law).norm();
        const bool sticks = unlimited.norm() <= constraints_.budgets[p];
        if (!sticks || !is_round_off((impulse - law).norm(), constraints_.rows[2 * p])) impulse = law;
    }
    for (int k = constraints_.slip_count(); k < static_cast<int>(constraints_.rows.size()); ++k) {
        const ScaledRow& row = constraints_.rows[k];
        // A row acts only where the linear model has it. Others join first.
        const bool acts = members_->has_row(k) || base_.state().is_pressing[k];
        const double law = acts ? std::max(row.lower - point_.row_values[k], 0.0) / row.give : 0.0;
        const bool presses = law > 0.0 && multipliers_[k] > 0.0;
        if (!presses || !is_round_off(std::abs(multipliers_[k] - law), row)) multipliers_[k] = law;
    }
    residual_ = *problem_.rhs - point_.product;
    for (Eigen::Index k = 0; k < multipliers_.size(); ++k) {
        if (!(std::abs(multipliers_[k]) > 0.0)) continue;
        for (const auto& [coordinate, coefficient] : constraints_.rows[k].entries)
            residual_[coordinate] += coefficient * multipliers_[k];
    }
    for (int i = 0; i < residual_.size(); ++i) {
        if (problem_.is_fixed[i]) residual_[i] = 0.0;
        if (problem_.is_fixed[i] || !std::isfinite(problem_.lower[i])) continue;
        const bool is_held =
            wanted_.is_active[i] && std::abs(point_.velocity[i] - problem_.lower[i]) <= kHeld * speed;
        if (is_held)  // by the last linear model: its multiplier is -residual
            wanted_.is_active[i] = !(residual_[i] > kSignTolerance * diagonal_[i] * speed);
        else
            wanted_.is_active[i] = point_.velocity[i] < problem_.lower[i] - kSignTolerance * speed;
    }
    set_model_at(point_, wanted_);
}

/// Rows and pairs of the linear model at a point.
void ContactNewton::set_model_at(const Point& point, ContactState& state) const
{
    std::map<int, std::pair<double, int>>
        worst;  // by group: of rows that repeat each other, one at a time joins
    for (int k = constraints_.slip_count(); k < static_cast<int>(constraints_.rows.size()); ++k) {
        const ScaledRow& row = constraints_.rows[k];
        const bool acts = members_->has_row(k) || base_.state().is_pressing[k];
        const double depth = row.entries.empty() ? 0.0 : row.lower - point.row_values[k];
        state.is_pressing[k] = acts && depth > 0.0;
        if (acts || !(depth > kSignTolerance * constraints_.least_speed)) continue;
        const double weighed = depth / std::sqrt(row.compliance);
        const auto [at, is_new] = worst.try_emplace(row.group, weighed, k);
        if (!is_new && weighed > at->second.first) at->second = {weighed, k};
    }
    for (const auto& [group, row] : worst) state.is_pressing[row.second] = 1;
    for (int p = 0; p < constraints_.pair_count(); ++p)
        state.stiffness[p] =
            slip_stiffness(unlimited_at(constraints_, p, point.row_values), impulses_.segment<2>(2 * p),
                           constraints_.budgets[p], constraints_.rows[2 * p].give);
}

/// Budgets by the law at the present velocity, and by how much the forces differ from the law with these,
/// relative to the largest budget.
VectorXd ContactNewton::law_budgets(double& error)
{
    const std::vector<double> by_law = problem_.law(make_solution());
    VectorXd budgets(constraints_.pair_count());
    double greatest = 0.0, largest_budget = 0.0;
    for (int p = 0; p < constraints_.pair_count(); ++p) {
        const double scale = constraints_.rows[2 * p].scale;
        const bool can_move =
            !constraints_.rows[2 * p].entries.empty() || !constraints_.rows[2 * p + 1].entries.empty();
        budgets[p] = can_move ? scale * std::max(by_law[p], 0.0) : 0.0;
        const Vector2d by_new = project_on_disc(unlimited_at(constraints_, p, point_.row_values), budgets[p]);
        greatest = std::max(greatest, (multipliers_.segment<2>(2 * p) - by_new).norm() / scale);
        largest_budget = std::max(largest_budget, budgets[p] / scale);
    }
    // Impulses that round-off of the speed makes are no friction.
    const double floor = kSignTolerance * largest(point_.product);
    error = greatest > floor ? greatest / std::max(largest_budget, greatest) : 0.0;
    return budgets;
}

/// True where budgets have moved.
bool ContactNewton::agree_budgets()
{
    constexpr double kSmall = 1e-3;  // relative step with which budgets may count as agreed
    if (!(relative_step_ <= kFollow) || !is_whole_step_) return false;
    double error = 0.0;
    const VectorXd wanted = law_budgets(error);
    if ((error <= kAgreement && relative_step_ <= kSmall) || moves_.count() >= kMostMoves) {
        is_agreed_ = true;
        return false;
    }
    Eigen::Map<VectorXd> budgets(constraints_.budgets.data(), constraints_.pair_count());
    budgets = moves_.next(budgets, wanted);
    is_steady_ = false;
    return true;
}

/// Keeps the point if it is the best so far; true where it is accurate enough, or no better one comes.
bool ContactNewton::certify()
{
    constexpr double kNearlyBalanced = 1e-8;  // residual at which a certificate is tried
    constexpr int kPatience = 2;
    const double scale = largest(*problem_.rhs) + largest(point_.product);
    double unbalanced = 0.0;
    VectorXd multipliers = VectorXd::Zero(residual_.size());
    for (int i = 0; i < residual_.size(); ++i)
        if (wanted_.is_active[i])
            multipliers[i] = std::max(-residual_[i], 0.0);
        else
            unbalanced = std::max(unbalanced, std::abs(residual_[i]));
    if (!(unbalanced <= kNearlyBalanced * scale)) return false;
    const double residual = kkt_residual(problem_, constraints_, point_.velocity, multipliers, multipliers_);
    const Differences joining = find_differences(wanted_);
    if (residual < 0.8 * best_residual_ || !joining.bounds.empty() || !joining.rows.empty())
        without_better_ = 0;
    else
        ++without_better_;
    if (residual < best_residual_) {
        best_residual_ = residual;
        const VelocitySolution cost = std::exchange(best_, make_solution());
        best_.factorisations = cost.factorisations;
        best_.nlopt_evaluations = cost.nlopt_evaluations;
        best_.factorise_seconds = cost.factorise_seconds;
        best_.kkt_residual = residual;
        best_.infeasible_rows = find_infeasible_rows(constraints_, multipliers_);
        if (has_law()) law_budgets(best_.law_residual);
        answer_ = answer();
    }
    if (residual > kAccurate && without_better_ < kPatience) return false;
    if (!has_law() || moves_.count() >= kMostMoves) return true;
    double error = 0.0;
    law_budgets(error);
    constexpr double kOff = 4.0;
    is_agreed_ = error <= kOff * kAgreement;
    if (!is_agreed_) {
        best_residual_ = std::numeric_limits<double>::infinity();
        without_better_ = 0;
    }
    return is_agreed_;
}

ContactNewton::Differences ContactNewton::find_differences(const ContactState& wanted) const
{
    const ContactState& has = base_.state();
    Differences differences;
    for (std::size_t i = 0; i < has.is_active.size(); ++i) {
        if (wanted.is_active[i] == has.is_active[i]) continue;
        ++differences.count;
        if (!members_->has_bound(static_cast<int>(i))) differences.bounds.push_back(static_cast<int>(i));
    }
    for (int k = constraints_.slip_count(); k < static_cast<int>(constraints_.rows.size()); ++k) {
        if (wanted.is_pressing[k] == has.is_pressing[k]) continue;
        ++differences.count;
        if (!members_->has_row(k)) differences.rows.push_back(k);
    }
    for (int p = 0; p < constraints_.pair_count(); ++p) {
        if (distance(has.stiffness[p], wanted.stiffness[p], constraints_.masses[p]) <= kNear) continue;
        differences.count += 2;
        if (!members_->has_row(2 * p)) differences.rows.insert(differences.rows.end(), {2 * p, 2 * p + 1});
    }
    return differences;
}

/// Whether the iterations left at the present rate would cost more than a new factor, after which few are
/// left.
bool ContactNewton::is_slow()
{
    constexpr double kAfter = 1.0;  // work, in factorisations' worth, of the iterations after a new factor
    const double spent = (last_work_ - work_.flops) / unit_of_work(), rate = relative_step_ / last_step_;
    const bool is_steady = is_steady_ && is_whole_step_ && relative_step_ < kFollow && last_step_ < kFollow;
    last_work_ = work_.flops;
    last_step_ = relative_step_;
    is_steady_ = true;
    if (!is_steady || !(relative_step_ > kAccurate)) return false;
    const double left = rate < 0.9 ? std::log(kAccurate / relative_step_) / std::log(rate) : kMostIterations;
    return left * spent > 1.0 + kAfter;
}

/// Takes in what differs from the base, or makes a new base. False where that is not possible.
bool ContactNewton::choose_base()
{
    const bool was_steady = is_steady_ && is_whole_step_ && relative_step_ < kFollow;
    if (is_slow()) return factorise();
    if (was_steady) want_missed_pairs();
    Differences differences = find_differences(wanted_);
    const auto add = [](const std::vector<int>& from, std::vector<int>& to) {
        for (const int k : from)
            if (std::find(to.begin(), to.end(), k) == to.end()) to.push_back(k);
    };
    add(first_changes_.bounds, differences.bounds);
    add(first_changes_.rows, differences.rows);
    first_changes_ = {};
    const int fresh = static_cast<int>(differences.bounds.size() + differences.rows.size());
    if (stalled_ > 1 || differences.count > most_members_ + without_room_ ||
        members_->size() + fresh > 2 * (most_members_ + without_room_)) {
        stalled_ = 0;
        return factorise();
    }
    members_->extend(differences.bounds, differences.rows);
    has_fresh_members_ = fresh > 0;
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
        if (!members_->has_row(2 * p)) most = std::max(most, missed_[p]);
    std::vector<int> rows;
    for (int p = 0; p < constraints_.pair_count(); ++p)
        if (missed_[p] > kShare * most && !members_->has_row(2 * p))
            rows.insert(rows.end(), {2 * p, 2 * p + 1});
    if (rows.size() <= kMost) first_changes_.rows = std::move(rows);
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
    const bool is_done = base_.factorise(wanted_);
    best_.factorise_seconds += watch.lap();
    ++best_.factorisations;
    if (!is_done) return false;
    has_fresh_members_ = false;
    is_steady_ = false;
    members_.emplace(base_, problem_, constraints_);
    const Differences missing = find_differences(wanted_);
    without_room_ = missing.count;
    members_->extend(missing.bounds, missing.rows);
    return true;
}

MemberProblem ContactNewton::make_member_problem(const VectorXd&)
{
    MemberProblem problem;
    const ContactState& has = base_.state();
    std::vector<int> place_of_first(constraints_.budgets.size(), -1);
    for (int k = 0; k < members_->size(); ++k) {
        const auto [kind, index] = (*members_)[k];
        if (kind == Member::Kind::Slip) {
            if (index % 2 == 0) place_of_first[index / 2] = k;
        } else if (kind == Member::Kind::Row) {
            const ScaledRow& row = constraints_.rows[index];
            const double stiffness = has.is_pressing[index] ? 1.0 / row.give : 0.0;
            problem.rows.push_back({k, row.give, multipliers_[index], stiffness});
        } else {
            problem.bounds.push_back({k, bound_force(index)});
        }
    }
    for (int k = 0; k < members_->size(); ++k) {
        const auto [kind, index] = (*members_)[k];
        if (kind != Member::Kind::Slip || index % 2 == 0) continue;
        const int p = index / 2;
        problem.rubbing.push_back({{place_of_first[p], k},
                                   constraints_.rows[2 * p].give,
                                   constraints_.budgets[p],
                                   multipliers_.segment<2>(2 * p),
                                   has.stiffness[p],
                                   impulses_.segment<2>(2 * p)});
    }
    return problem;
}

/// The step to the solution of the base with its members, from the residual. Sets multipliers and impulses to
/// those of its linear model. Nothing where it is not finite.
std::optional<ContactNewton::Point> ContactNewton::direction()
{
    constexpr double kAccuracy = 0.05;  // of the members' forces, in units of the largest residual
    if (!work_.spend(4.0 * factorization_.nonzeros())) return std::nullopt;
    VectorXd rhs = residual_, to_bound = VectorXd::Zero(residual_.size());
    bool is_any_moved = false;
    double unbalanced = 0.0;
    for (int i = 0; i < rhs.size(); ++i) {
        if (members_->has_bound(i)) rhs[i] += bound_force(i);
        if (members_->has_bound(i) || problem_.is_fixed[i]) continue;
        if (!base_.is_pinned(i)) {
            unbalanced = std::max(unbalanced, std::abs(rhs[i]));
        } else {
            to_bound[i] = problem_.lower[i] - point_.velocity[i];
            is_any_moved = is_any_moved || std::abs(to_bound[i]) > 0.0;
        }
    }
    if (is_any_moved) rhs -= symmetric_product(base_.matrix(), to_bound);
    const VectorXd forward = base_.solve_forward(rhs);
    VectorXd change, forces;
    MemberProblem problem;
    if (members_->size() == 0) {
        change = base_.solve_backward(forward);
    } else {
        std::optional<MemberResponse> response =
            members_->respond(point_.velocity, point_.row_values, rhs, forward);
        if (!response) return std::nullopt;
        problem = make_member_problem(forward);
        problem.compliance = std::move(response->compliance);
        problem.offset = std::move(response->offset);
        problem.now = std::move(response->now);
        const std::optional<VectorXd> found =
            solve_members(problem, kAccuracy * unbalanced, work_, best_.nlopt_evaluations);
        if (!found) return std::nullopt;
        forces = *found;
        change = members_->change(forces, forward);
        const VectorXd moved = problem.offset + problem.compliance * forces;
        for (const RowMember& member : problem.rows)
            multipliers_[(*members_)[member.place].index] =
                forces[member.place] + member.force - member.base_stiffness * moved[member.place];
        for (const RubbingMember& pair : problem.rubbing)
            multipliers_.segment<2>((*members_)[pair.place[0]].index) =
                forces(pair.place) + pair.force - pair.base_stiffness * moved(pair.place);
    }
    change += to_bound;
    is_finite_ = change.allFinite();
    if (!is_finite_) return std::nullopt;
    Point step = make_point(std::move(change));
    const ContactState& has = base_.state();
    for (int p = 0; p < constraints_.pair_count(); ++p)
        if (!members_->has_row(2 * p))
            multipliers_.segment<2>(2 * p) -= has.stiffness[p] * step.row_values.segment<2>(2 * p);
    for (int k = constraints_.slip_count(); k < static_cast<int>(constraints_.rows.size()); ++k)
        if (has.is_pressing[k] && !members_->has_row(k))
            multipliers_[k] -= step.row_values[k] / constraints_.rows[k].give;
    impulses_ = multipliers_.head(constraints_.slip_count());
    for (const RubbingMember& pair : problem.rubbing)
        impulses_.segment<2>((*members_)[pair.place[0]].index) = pair.impulse;
    for (int i = 0; i < to_bound.size(); ++i)
        if (base_.is_pinned(i) && !members_->has_bound(i) && !problem_.is_fixed[i]) wanted_.is_active[i] = 1;
    for (const BoundMember& member : problem.bounds)
        wanted_.is_active[(*members_)[member.place].index] = forces[member.place] + member.force > 0.0;
    return step;
}

/// Goes the whole step, if its changes have room beside the base, but not too often in a row. Else goes from
/// the last reference as far as the energy falls.
void ContactNewton::take(Point step)
{
    constexpr int kMostExcursions = 8;
    constexpr double kSettled = 1e-3;  // relative step after which the point is a new reference
    constexpr double kStalled = 1e-3, kShort = 0.1;
    double share = 1.0;
    if (excursions_ >= kMostExcursions || !fits(step)) {
        step.add(1.0, point_);
        step.add(-1.0, reference_);
        point_ = reference_;
        share = search(step);
        if (share < kShort) want_first_changes(step);
        const bool has_none = first_changes_.bounds.empty() && first_changes_.rows.empty();
        stalled_ = share < kStalled && has_none ? stalled_ + 1 : 0;
        excursions_ = 0;
        reference_.add(share, step);
    } else {
        ++excursions_;
    }
    point_.add(share, step);
    if (share < 1.0) multipliers_.setConstant(std::numeric_limits<double>::quiet_NaN());
    is_whole_step_ = share >= kShort;
    relative_step_ = largest(step.velocity) / std::max(largest(point_.velocity), constraints_.least_speed);
    if (share == 1.0 && relative_step_ <= kSettled && !has_fresh_members_) {
        reference_ = point_;
        excursions_ = 0;
    }
}

/// Whether the changes at the end of a step have room.
bool ContactNewton::fits(const Point& step) const
{
    constexpr int kFewChanges = 32;
    Point end = point_;
    end.add(1.0, step);
    ContactState state = wanted_;
    const double speed = std::max(largest(end.velocity), constraints_.least_speed);
    for (int i = 0; i < end.velocity.size(); ++i)
        if (!problem_.is_fixed[i] && !state.is_active[i])
            state.is_active[i] = end.velocity[i] < problem_.lower[i] - kSignTolerance * speed;
    set_model_at(end, state);
    const Differences differences = find_differences(state);
    const int fresh = static_cast<int>(differences.bounds.size() + differences.rows.size());
    return differences.count <= most_members_ + without_room_ &&
           members_->size() + fresh <= 2 * (most_members_ + without_room_) &&
           fresh <= std::max(kFewChanges, members_->size() / 2);
}

/// Share of a step from the reference at which the energy is least.
double ContactNewton::search(const Point& step) const
{
    const double at_start = step.velocity.dot(point_.product - *problem_.rhs),
                 growth = step.velocity.dot(step.product);
    struct Spring {
        double gap, change, stiffness;
    };
    std::vector<Spring> springs;
    const auto enter = [&](double gap, double change, double stiffness) {
        if (gap < 0.0 || gap + change < 0.0) springs.push_back({gap, change, stiffness});
    };
    for (int k = constraints_.slip_count(); k < static_cast<int>(constraints_.rows.size()); ++k) {
        const ScaledRow& row = constraints_.rows[k];
        if (!row.entries.empty()) enter(point_.row_values[k] - row.lower, step.row_values[k], 1.0 / row.give);
    }
    for (int i = 0; i < step.velocity.size(); ++i)
        if (!problem_.is_fixed[i] && std::isfinite(problem_.lower[i]))
            enter(point_.velocity[i] - problem_.lower[i], step.velocity[i], kBoundStiffness * diagonal_[i]);
    return search_share([&](double share) {
        double slope = at_start + share * growth;
        for (const Spring& spring : springs)
            slope += spring.stiffness * spring.change * std::min(spring.gap + share * spring.change, 0.0);
        for (int p = 0; p < constraints_.pair_count(); ++p) {
            if (!(constraints_.budgets[p] > 0.0)) continue;
            const Vector2d lower(constraints_.rows[2 * p].lower, constraints_.rows[2 * p + 1].lower),
                change = step.row_values.segment<2>(2 * p);
            const Vector2d y = point_.row_values.segment<2>(2 * p) + share * change;
            slope -= change.dot(
                project_on_disc((lower - y) / constraints_.rows[2 * p].give, constraints_.budgets[p]));
        }
        return slope;
    });
}

/// Those changes on the way of a step that come first become members, as many as may join at a time.
void ContactNewton::want_first_changes(const Point& step)
{
    constexpr int kFewChanges = 32;
    struct Change {
        double share;
        bool is_bound;
        int index;  ///< coordinate, or scaled row; of a pair the first one
    };
    std::vector<Change> changes;
    const ContactState& has = base_.state();
    const auto enter = [&](double gap, double change, char is_on, bool is_bound, int index) {
        if ((gap + change < 0.0) == (is_on != 0)) return;
        const double share = std::abs(change) > 0.0 ? std::clamp(-gap / change, 0.0, 1.0) : 1.0;
        changes.push_back({share, is_bound, index});
    };
    for (int i = 0; i < step.velocity.size(); ++i)
        if (!problem_.is_fixed[i] && std::isfinite(problem_.lower[i]) && !members_->has_bound(i) &&
            !has.is_active[i])
            enter(point_.velocity[i] - problem_.lower[i], step.velocity[i], 0, true, i);
    for (int k = constraints_.slip_count(); k < static_cast<int>(constraints_.rows.size()); ++k)
        if (!members_->has_row(k) && !constraints_.rows[k].entries.empty())
            enter(point_.row_values[k] - constraints_.rows[k].lower, step.row_values[k], has.is_pressing[k],
                  false, k);
    for (int p = 0; p < constraints_.pair_count(); ++p) {
        if (members_->has_row(2 * p) || !(constraints_.budgets[p] > 0.0)) continue;
        for (const double share : {0.01, 0.1, 0.3, 1.0}) {
            VectorXd y = point_.row_values;
            y.segment<2>(2 * p) += share * step.row_values.segment<2>(2 * p);
            const Eigen::Matrix2d stiffness =
                slip_stiffness(unlimited_at(constraints_, p, y), impulses_.segment<2>(2 * p),
                               constraints_.budgets[p], constraints_.rows[2 * p].give);
            if (distance(has.stiffness[p], stiffness, constraints_.masses[p]) <= kNear) continue;
            changes.push_back({share, false, 2 * p});
            break;
        }
    }
    std::stable_sort(changes.begin(), changes.end(),
                     [](const Change& a, const Change& b) { return a.share < b.share; });
    int room = std::min(std::max(kFewChanges, members_->size() / 2),
                        2 * (most_members_ + without_room_) - members_->size());
    for (const Change& change : changes) {
        const bool is_pair = !change.is_bound && change.index < constraints_.slip_count();
        room -= is_pair ? 2 : 1;
        if (room < 0) break;
        if (change.is_bound)
            first_changes_.bounds.push_back(change.index);
        else
            first_changes_.rows.push_back(change.index);
        if (is_pair) first_changes_.rows.push_back(change.index + 1);
    }
}

/// The present point, in the problem's units.
VelocitySolution ContactNewton::make_solution() const
{
    VelocitySolution solution = make_zero_solution(problem_);
    solution.velocity = point_.velocity;
    const double round_off = kSignTolerance * largest(point_.velocity);
    for (int i = 0; i < residual_.size(); ++i) {
        if (!wanted_.is_active[i]) continue;
        solution.multipliers[i] = std::max(-residual_[i], 0.0);
        if (std::abs(solution.velocity[i] - problem_.lower[i]) <= round_off)
            solution.velocity[i] = problem_.lower[i];
    }
    const int first = constraints_.slip_count();
    for (std::size_t k = 0; k < problem_.rows.size(); ++k)
        solution.row_multipliers[static_cast<Eigen::Index>(k)] =
            std::max(multipliers_[static_cast<Eigen::Index>(first + k)], 0.0) /
            constraints_.rows[first + k].scale;
    for (int p = 0; p < constraints_.pair_count(); ++p) {
        const double scale = constraints_.rows[2 * p].scale;
        const Vector2d lower(problem_.friction[p].slip[0].lower, problem_.friction[p].slip[1].lower);
        solution.friction[p] = multipliers_.segment<2>(2 * p) / scale;
        solution.slip[p] = scale * point_.row_values.segment<2>(2 * p) - lower;
        // The law is solved for the impulse: 1 / give would magnify the slip's round-off.
        constexpr double kInside = 1.0 - 1e-9;
        const bool sticks = solution.friction[p].norm() < kInside * constraints_.budgets[p] / scale;
        solution.unlimited[p] = sticks ? solution.friction[p]
                                       : Vector2d(unlimited_at(constraints_, p, point_.row_values) / scale);
        solution.budgets[p] = constraints_.budgets[p] / scale;
    }
    return solution;
}

VelocitySolution ContactNewton::finish()
{
    best_.budget_moves = moves_.count();
    best_.work = problem_.most_work - work_.flops / unit_of_work();
    if (best_residual_ < std::numeric_limits<double>::infinity()) {
        if (best_.infeasible_rows.empty()) {
            if (best_.kkt_residual <= settings_.tolerance) best_.status = SolveStatus::Certified;
        } else if (best_.kkt_residual <= std::max(settings_.tolerance, kNaming)) {
            best_.status = SolveStatus::Infeasible;
        }
    }
    return best_;
}

ContactAnswer ContactNewton::answer() const
{
    ContactAnswer answer = {point_.velocity, wanted_, {}, {}};
    for (int p = 0; p < constraints_.pair_count(); ++p) {
        const double scale = constraints_.rows[2 * p].scale;
        answer.budgets.push_back(constraints_.budgets[p] / scale);
        answer.impulses.push_back(impulses_.segment<2>(2 * p) / scale);
    }
    return answer;
}

}  // namespace arris
