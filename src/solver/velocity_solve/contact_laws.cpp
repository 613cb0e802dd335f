// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/contact_laws.h"

#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "solver/velocity_solve/slip_law.h"
#include "solver/velocity_solve/symmetric_product.h"

namespace arris {
namespace {

using Eigen::Vector2d;
using Eigen::VectorXd;

/// Distance from a bound, as a share of the largest speed, at which a linear model has held it: the
/// compliance of the stiff springs that stand for bounds, with a margin.
constexpr double kHeld = 1e-7;

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

ContactLaws::ContactLaws(const VelocityProblem& problem, ConstraintRows& constraints)
    : problem_(&problem), constraints_(&constraints)
{
}

Eigen::Map<VectorXd> ContactLaws::budgets() const
{
    return {constraints_->budgets.data(), constraints_->pair_count()};
}

double ContactLaws::speed_at(const ContactPoint& point) const
{
    return std::max(largest(point.velocity), constraints_->least_speed);
}

ContactPoint ContactLaws::make_point(VectorXd velocity) const
{
    ContactPoint point = {
        std::move(velocity), {}, VectorXd::Zero(static_cast<Eigen::Index>(constraints_->rows.size()))};
    point.product = symmetric_product(*problem_->matrix, point.velocity);
    for (Eigen::Index k = 0; k < point.row_values.size(); ++k)
        for (const auto& [coordinate, coefficient] : constraints_->rows[k].entries)
            point.row_values[k] += coefficient * point.velocity[coordinate];
    return point;
}

ContactIterate ContactLaws::start_from_guess() const
{
    ContactIterate at;
    at.point = make_point(VectorXd::Zero(problem_->rhs->size()));
    at.multipliers = VectorXd::Zero(static_cast<Eigen::Index>(constraints_->rows.size()));
    const int pairs = constraints_->pair_count(), first = constraints_->slip_count();
    at.wanted = {active_by_guess(*problem_), std::vector<char>(constraints_->rows.size(), 0), {}};
    for (const int guessed : problem_->row_guess) {
        const ScaledRow& row = constraints_->rows[first + guessed];
        if (row.entries.empty()) continue;
        at.wanted.is_pressing[first + guessed] = 1;
        at.multipliers[first + guessed] = row.lower / row.compliance;
    }
    for (int p = 0; p < pairs; ++p) {
        const FrictionPair& pair = problem_->friction[p];
        const ScaledRow& row = constraints_->rows[2 * p];
        const Vector2d slip =  // C u at the slip predicted
            Vector2d(pair.last[0] + pair.slip[0].lower, pair.last[1] + pair.slip[1].lower) / row.scale;
        const double budget = constraints_->budgets[p];
        const Vector2d unlimited = unlimited_at(*constraints_, p, slip),
                       impulse = project_on_disc(unlimited, budget);
        at.wanted.stiffness.push_back(slip_stiffness(unlimited, impulse, budget, row.compliance));
        at.multipliers.segment<2>(2 * p) = impulse + at.wanted.stiffness[p] * slip;
    }
    at.impulses = at.multipliers.head(first);
    at.residual = *problem_->rhs;
    for (Eigen::Index k = 0; k < at.multipliers.size(); ++k)
        for (const auto& [coordinate, coefficient] : constraints_->rows[k].entries)
            at.residual[coordinate] += coefficient * at.multipliers[k];
    return at;
}

ContactIterate ContactLaws::start_from(const ContactAnswer& answer) const
{
    ContactIterate at;
    at.wanted = answer.state;
    VectorXd velocity = answer.velocity;
    for (int i = 0; i < velocity.size(); ++i) {
        if (problem_->is_fixed[i] || !std::isfinite(problem_->lower[i])) at.wanted.is_active[i] = 0;
        if (problem_->is_fixed[i]) velocity[i] = 0.0;
        if (at.wanted.is_active[i]) velocity[i] = problem_->lower[i];
    }
    at.impulses.resize(constraints_->slip_count());
    for (std::size_t p = 0; p < answer.budgets.size(); ++p) {
        const double scale = constraints_->rows[2 * p].scale;
        constraints_->budgets[p] = scale * answer.budgets[p];
        at.impulses.segment<2>(2 * static_cast<Eigen::Index>(p)) = scale * answer.impulses[p];
    }
    at.multipliers = VectorXd::Constant(static_cast<Eigen::Index>(constraints_->rows.size()),
                                        std::numeric_limits<double>::quiet_NaN());
    at.point = make_point(std::move(velocity));
    return at;
}

void ContactLaws::append_rows(ContactIterate& at) const
{
    const auto rows = static_cast<Eigen::Index>(constraints_->rows.size());
    const Eigen::Index known = at.multipliers.size();
    at.multipliers.conservativeResize(rows);
    at.multipliers.tail(rows - known).setZero();
    at.wanted.is_pressing.resize(constraints_->rows.size(), 0);
    at.point = make_point(std::move(at.point.velocity));
}

void ContactLaws::evaluate(const std::vector<char>& acts, ContactIterate& at) const
{
    const double speed = speed_at(at.point);
    const auto is_round_off = [&](double difference, const ScaledRow& row) {
        return difference <= kSignTolerance * speed / row.compliance;
    };
    at.missed.resize(constraints_->pair_count());
    for (int p = 0; p < constraints_->pair_count(); ++p) {
        const Vector2d unlimited = unlimited_at(*constraints_, p, at.point.row_values.segment<2>(2 * p)),
                       law = project_on_disc(unlimited, constraints_->budgets[p]);
        auto impulse = at.multipliers.segment<2>(2 * p);
        at.missed[p] = (impulse - law).norm();
        const bool sticks = unlimited.norm() <= constraints_->budgets[p];
        if (!sticks || !is_round_off((impulse - law).norm(), constraints_->rows[2 * p])) impulse = law;
    }
    for (int k = constraints_->slip_count(); k < static_cast<int>(constraints_->rows.size()); ++k) {
        const ScaledRow& row = constraints_->rows[k];
        const double law = acts[k] ? std::max(row.lower - at.point.row_values[k], 0.0) / row.compliance : 0.0;
        const bool presses = law > 0.0 && at.multipliers[k] > 0.0;
        if (!presses || !is_round_off(std::abs(at.multipliers[k] - law), row)) at.multipliers[k] = law;
    }
    at.residual = *problem_->rhs - at.point.product;
    for (Eigen::Index k = 0; k < at.multipliers.size(); ++k) {
        if (!(std::abs(at.multipliers[k]) > 0.0)) continue;
        for (const auto& [coordinate, coefficient] : constraints_->rows[k].entries)
            at.residual[coordinate] += coefficient * at.multipliers[k];
    }
    for (int i = 0; i < at.residual.size(); ++i)
        if (problem_->is_fixed[i]) at.residual[i] = 0.0;
    set_bounds(at);
    set_rows_at(at.point, acts, at.impulses, at.wanted);
}

/// At its bound a coordinate is active unless its multiplier, -residual, pulls. The sign is judged as the
/// certificate does, against the largest multiplier: where there is no force, that of a coordinate is
/// round-off.
void ContactLaws::set_bounds(ContactIterate& at) const
{
    const double speed = speed_at(at.point), near = kSignTolerance * speed;
    const auto distance = [&](int i) { return at.point.velocity[i] - problem_->lower[i]; };
    const auto is_at_bound = [&](int i) {  // or was held there by the last linear model
        return std::abs(distance(i)) <= (at.wanted.is_active[i] ? kHeld * speed : near);
    };
    double impulse = at.multipliers.size() > 0 ? largest(at.multipliers) : 0.0;
    std::vector<int> bounded;
    for (int i = 0; i < at.residual.size(); ++i) {
        if (problem_->is_fixed[i] || !std::isfinite(problem_->lower[i])) continue;
        bounded.push_back(i);
        if (is_at_bound(i)) impulse = std::max(impulse, -at.residual[i]);
    }
    for (const int i : bounded)
        at.wanted.is_active[i] =
            is_at_bound(i) ? at.residual[i] <= kSignTolerance * impulse : distance(i) < 0.0;
}

void ContactLaws::set_rows_at(const ContactPoint& point, const std::vector<char>& acts,
                              const VectorXd& impulses, ContactState& state) const
{
    std::map<int, std::pair<double, int>> worst;  // by group
    for (int k = constraints_->slip_count(); k < static_cast<int>(constraints_->rows.size()); ++k) {
        const ScaledRow& row = constraints_->rows[k];
        const double depth = row.entries.empty() ? 0.0 : row.lower - point.row_values[k];
        state.is_pressing[k] = acts[k] && depth > 0.0;
        if (acts[k] || !(depth > kSignTolerance * constraints_->least_speed)) continue;
        const double weighed = depth / std::sqrt(row.mobility);
        const auto [at, is_new] = worst.try_emplace(row.group, weighed, k);
        if (!is_new && weighed > at->second.first) at->second = {weighed, k};
    }
    for (const auto& [group, row] : worst) state.is_pressing[row.second] = 1;
    for (int p = 0; p < constraints_->pair_count(); ++p)
        state.stiffness[p] = slip_stiffness(
            unlimited_at(*constraints_, p, point.row_values.segment<2>(2 * p)), impulses.segment<2>(2 * p),
            constraints_->budgets[p], constraints_->rows[2 * p].compliance);
}

LawfulBudgets ContactLaws::find_budgets(const ContactIterate& at) const
{
    const std::vector<double> by_law = problem_->law(make_solution(at));
    LawfulBudgets result = {VectorXd(constraints_->pair_count())};
    double greatest = 0.0, largest_budget = 0.0;
    for (int p = 0; p < constraints_->pair_count(); ++p) {
        const double scale = constraints_->rows[2 * p].scale;
        const bool can_move =
            !constraints_->rows[2 * p].entries.empty() || !constraints_->rows[2 * p + 1].entries.empty();
        const double budget = can_move ? scale * std::max(by_law[p], 0.0) : 0.0;
        const Vector2d by_new =
            project_on_disc(unlimited_at(*constraints_, p, at.point.row_values.segment<2>(2 * p)), budget);
        const double difference = (at.multipliers.segment<2>(2 * p) - by_new).norm() / scale;
        if (!(difference <= greatest)) {  // a NaN stays
            greatest = difference;
            result.worst = p;
        }
        result.budgets[p] = budget;
        largest_budget = std::max(largest_budget, budget / scale);
    }
    // Impulses that round-off of the speed makes are no friction.
    const double floor = kSignTolerance * largest(at.point.product);
    if (!(greatest <= floor)) result.error = greatest / std::max(largest_budget, greatest);
    return result;
}

VelocitySolution ContactLaws::make_solution(const ContactIterate& at) const
{
    VelocitySolution solution = make_zero_solution(*problem_);
    solution.velocity = at.point.velocity;
    const double round_off = kSignTolerance * largest(at.point.velocity);
    for (int i = 0; i < at.residual.size(); ++i) {
        if (!at.wanted.is_active[i]) continue;
        solution.multipliers[i] = -at.residual[i];
        if (std::abs(solution.velocity[i] - problem_->lower[i]) <= round_off)
            solution.velocity[i] = problem_->lower[i];
    }
    const int first = constraints_->slip_count();
    for (std::size_t k = 0; k < problem_->rows.size(); ++k) {
        const ScaledRow& scaled = constraints_->rows[first + k];
        const ConstraintRow& row = problem_->rows[k];
        // The force of a spring between vertices that are held is known.
        const bool is_between_held = scaled.entries.empty() && row.compliance > 0.0;
        solution.row_multipliers[static_cast<Eigen::Index>(k)] =
            is_between_held
                ? std::max(row.lower, 0.0) / row.compliance
                : std::max(at.multipliers[static_cast<Eigen::Index>(first + k)], 0.0) / scaled.scale;
    }
    for (int p = 0; p < constraints_->pair_count(); ++p) {
        const double scale = constraints_->rows[2 * p].scale;
        const Vector2d lower(problem_->friction[p].slip[0].lower, problem_->friction[p].slip[1].lower);
        solution.friction[p] = at.multipliers.segment<2>(2 * p) / scale;
        solution.slip[p] = scale * at.point.row_values.segment<2>(2 * p) - lower;
        // The law is solved for the impulse: 1 / compliance would magnify the slip's round-off.
        constexpr double kInside = 1.0 - 1e-9;
        const bool sticks = solution.friction[p].norm() < kInside * constraints_->budgets[p] / scale;
        solution.unlimited[p] =
            sticks ? solution.friction[p]
                   : Vector2d(unlimited_at(*constraints_, p, at.point.row_values.segment<2>(2 * p)) / scale);
        solution.budgets[p] = constraints_->budgets[p] / scale;
    }
    return solution;
}

ContactAnswer ContactLaws::make_answer(const ContactIterate& at) const
{
    ContactAnswer answer = {at.point.velocity, at.wanted, {}, {}};
    for (int p = 0; p < constraints_->pair_count(); ++p) {
        const double scale = constraints_->rows[2 * p].scale;
        answer.budgets.push_back(constraints_->budgets[p] / scale);
        answer.impulses.push_back(at.impulses.segment<2>(2 * p) / scale);
    }
    return answer;
}

}  // namespace arris
