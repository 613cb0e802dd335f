// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/model_changes.h"

#include <algorithm>
#include <cmath>

#include "solver/velocity_solve/line_search.h"
#include "solver/velocity_solve/slip_law.h"

namespace arris {
namespace {

using Eigen::Vector2d;
using Eigen::VectorXd;

/// Distance from the wanted stiffness within which a pair's spring in the base serves.
constexpr double kNear = 0.4;

/// Stiffness of a bound where it is a spring, in units of its diagonal entry.
constexpr double kBoundStiffness = 1e8;

}  // namespace

ModelChanges find_changes(const ConstraintRows& constraints, const SpringBase& base, const Members& members,
                          const ContactState& wanted)
{
    const ContactState& has = base.state();
    ModelChanges changes;
    for (std::size_t i = 0; i < has.is_active.size(); ++i) {
        if (wanted.is_active[i] == has.is_active[i]) continue;
        ++changes.count;
        if (!members.has_bound(static_cast<int>(i))) changes.bounds.push_back(static_cast<int>(i));
    }
    for (int k = constraints.slip_count(); k < static_cast<int>(constraints.rows.size()); ++k) {
        if (wanted.is_pressing[k] == has.is_pressing[k]) continue;
        ++changes.count;
        if (!members.has_row(k)) changes.rows.push_back(k);
    }
    for (int p = 0; p < constraints.pair_count(); ++p) {
        if (distance(has.stiffness[p], wanted.stiffness[p], constraints.masses[p]) <= kNear) continue;
        changes.count += 2;
        if (!members.has_row(2 * p)) changes.rows.insert(changes.rows.end(), {2 * p, 2 * p + 1});
    }
    return changes;
}

ModelChanges find_first_changes(const ContactLaws& laws, const SpringBase& base, const Members& members,
                                const ContactIterate& from, const ContactPoint& step, int room)
{
    const VelocityProblem& problem = laws.problem();
    const ConstraintRows& constraints = laws.constraints();
    struct Change {
        double share;
        bool is_bound;
        int index;  ///< coordinate, or scaled row; of a pair the first one
    };
    std::vector<Change> changes;
    const ContactState& has = base.state();
    const auto enter = [&](double gap, double change, char is_on, bool is_bound, int index) {
        if ((gap + change < 0.0) == (is_on != 0)) return;
        const double share = std::abs(change) > 0.0 ? std::clamp(-gap / change, 0.0, 1.0) : 1.0;
        changes.push_back({share, is_bound, index});
    };
    for (int i = 0; i < step.velocity.size(); ++i)
        if (!problem.is_fixed[i] && std::isfinite(problem.lower[i]) && !members.has_bound(i) &&
            !has.is_active[i])
            enter(from.point.velocity[i] - problem.lower[i], step.velocity[i], 0, true, i);
    for (int k = constraints.slip_count(); k < static_cast<int>(constraints.rows.size()); ++k)
        if (!members.has_row(k) && !constraints.rows[k].entries.empty())
            enter(from.point.row_values[k] - constraints.rows[k].lower, step.row_values[k],
                  has.is_pressing[k], false, k);
    for (int p = 0; p < constraints.pair_count(); ++p) {
        if (members.has_row(2 * p) || !(constraints.budgets[p] > 0.0)) continue;
        for (const double share : {0.01, 0.1, 0.3, 1.0}) {
            const Vector2d y =
                from.point.row_values.segment<2>(2 * p) + share * step.row_values.segment<2>(2 * p);
            const Eigen::Matrix2d stiffness =
                slip_stiffness(unlimited_at(constraints, p, y), from.impulses.segment<2>(2 * p),
                               constraints.budgets[p], constraints.rows[2 * p].compliance);
            if (distance(has.stiffness[p], stiffness, constraints.masses[p]) <= kNear) continue;
            changes.push_back({share, false, 2 * p});
            break;
        }
    }
    std::stable_sort(changes.begin(), changes.end(),
                     [](const Change& a, const Change& b) { return a.share < b.share; });
    ModelChanges first;
    for (const Change& change : changes) {
        const bool is_pair = !change.is_bound && change.index < constraints.slip_count();
        room -= is_pair ? 2 : 1;
        if (room < 0) break;
        if (change.is_bound)
            first.bounds.push_back(change.index);
        else
            first.rows.push_back(change.index);
        if (is_pair) first.rows.push_back(change.index + 1);
    }
    return first;
}

double find_share(const ContactLaws& laws, const ContactPoint& from, const ContactPoint& step)
{
    const VelocityProblem& problem = laws.problem();
    const ConstraintRows& constraints = laws.constraints();
    const double at_start = step.velocity.dot(from.product - *problem.rhs),
                 growth = step.velocity.dot(step.product);
    struct Spring {
        double gap, change, stiffness;
    };
    std::vector<Spring> springs;
    const auto enter = [&](double gap, double change, double stiffness) {
        if (gap < 0.0 || gap + change < 0.0) springs.push_back({gap, change, stiffness});
    };
    for (int k = constraints.slip_count(); k < static_cast<int>(constraints.rows.size()); ++k) {
        const ScaledRow& row = constraints.rows[k];
        if (!row.entries.empty())
            enter(from.row_values[k] - row.lower, step.row_values[k], 1.0 / row.compliance);
    }
    const VectorXd diagonal = problem.matrix->diagonal();
    for (int i = 0; i < step.velocity.size(); ++i)
        if (!problem.is_fixed[i] && std::isfinite(problem.lower[i]))
            enter(from.velocity[i] - problem.lower[i], step.velocity[i], kBoundStiffness * diagonal[i]);
    return search_share([&](double share) {
        double slope = at_start + share * growth;
        for (const Spring& spring : springs)
            slope += spring.stiffness * spring.change * std::min(spring.gap + share * spring.change, 0.0);
        for (int p = 0; p < constraints.pair_count(); ++p) {
            if (!(constraints.budgets[p] > 0.0)) continue;
            const Vector2d change = step.row_values.segment<2>(2 * p),
                           y = from.row_values.segment<2>(2 * p) + share * change;
            slope -= change.dot(project_on_disc(unlimited_at(constraints, p, y), constraints.budgets[p]));
        }
        return slope;
    });
}

}  // namespace arris
