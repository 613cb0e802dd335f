// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/violators.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace arris {
namespace {

/// Values nearer to 0 are rounding, and tell no sign: of a gap, as a share of the largest speed; of a
/// multiplier, as a share of the terms that are summed into it.
constexpr double kSignTolerance = 1e-13;

/// The greatest error in the set's rows: the violation of free ones, or the gap of pressing ones.
double error_of_members(const ConstraintRows& constraints, const Iterate& iterate, const WorkingSet& set)
{
    double error = 0.0;
    for (std::size_t k = constraints.slip_count(); k < constraints.rows.size(); ++k) {
        if (!set.contains_row(static_cast<int>(k))) continue;
        const double multiplier = iterate.row_multipliers[static_cast<Eigen::Index>(k)];
        const double left = gap(constraints.rows[k], iterate.velocity, multiplier);
        error = std::max(error, multiplier > 0.0 ? std::abs(left) : -left);
    }
    return error;
}

/// Violation by which rows are compared, scaled to unit compliance.
double weighed_violation(const ScaledRow& row, const Eigen::VectorXd& velocity)
{
    return -gap(row, velocity, 0.0) / std::sqrt(row.compliance);
}

std::vector<int> find_rows(const PinnedBase& base, const Iterate& iterate, const WorkingSet& set,
                           double margin)
{
    const ConstraintRows& constraints = *base.constraints;
    std::map<int, std::pair<double, int>> worst;  // by group
    for (int k = constraints.slip_count(); k < static_cast<int>(constraints.rows.size()); ++k) {
        const ScaledRow& row = constraints.rows[k];
        if (row.entries.empty() || set.contains_row(k) || base.is_pressing[k]) continue;
        if (gap(row, iterate.velocity, 0.0) >= -margin) continue;
        const double violation = weighed_violation(row, iterate.velocity);
        const auto [at, is_new] = worst.try_emplace(row.group, violation, k);
        if (!is_new && violation > at->second.first) at->second = {violation, k};
    }
    std::vector<int> rows;
    for (const auto& [group, candidate] : worst) rows.push_back(candidate.second);
    std::sort(rows.begin(), rows.end());
    return rows;
}

/// Pairs outside the set whose impulse is not the law's, and would not soon be by corrections of their
/// springs.
std::vector<int> find_pairs(const PinnedBase& base, const Iterate& iterate, const WorkingSet& set)
{
    const ConstraintRows& constraints = *base.constraints;
    const double same = kSameFriction * constraints.largest_budget();
    std::vector<int> pairs;
    for (int p = 0; p < constraints.pair_count(); ++p) {
        if (set.contains_row(2 * p)) continue;
        const Eigen::Vector2d y = slip_of(constraints, p, iterate.velocity);
        const double error = (base.slips[p].at(y) - friction_at(constraints, p, y)).norm();
        if (!(error <= same) && !is_near_law(base.slips[p], constraints, p, y)) pairs.push_back(p);
    }
    return pairs;
}

}  // namespace

Violators find_violators(const PinnedBase& base, const Iterate& iterate, const WorkingSet& set)
{
    const VelocityProblem& problem = *base.problem;
    const double margin = kSignTolerance * iterate.velocity.lpNorm<Eigen::Infinity>();
    Violators violators;
    for (int i = 0; i < iterate.velocity.size(); ++i) {
        if (problem.is_fixed[i] || set.contains(i)) continue;
        const bool is_right = iterate.is_active[i]
                                  ? iterate.gradient[i] >= -kSignTolerance * iterate.magnitude[i]
                                  : iterate.velocity[i] >= problem.lower[i] - margin;
        if (!is_right) violators.coordinates.push_back(i);
    }
    const double least = kSignTolerance * base.constraints->least_speed;
    const double error = error_of_members(*base.constraints, iterate, set);
    const double row_margin = std::max({margin, least, 2.0 * error});
    violators.rows = find_rows(base, iterate, set, row_margin);
    for (int k = 0; k < static_cast<int>(base.is_pressing.size()); ++k)
        if (base.is_pressing[k] && !set.contains_row(k) &&
            gap(base.constraints->rows[k], iterate.velocity, 0.0) > row_margin)
            violators.pulling.push_back(k);
    violators.pairs = find_pairs(base, iterate, set);
    return violators;
}

void keep_worst_coordinates(const PinnedBase& base, const Iterate& iterate, int count,
                            std::vector<int>& coordinates)
{
    const VelocityProblem& problem = *base.problem;
    const Eigen::VectorXd diagonal = problem.matrix->diagonal();
    const auto energy = [&](int i) {
        const double gap = problem.lower[i] - iterate.velocity[i];
        return iterate.is_active[i] ? iterate.gradient[i] * iterate.gradient[i] / diagonal[i]
                                    : diagonal[i] * gap * gap;
    };
    std::nth_element(coordinates.begin(), coordinates.begin() + count, coordinates.end(),
                     [&](int a, int b) { return std::pair(-energy(a), a) < std::pair(-energy(b), b); });
    coordinates.resize(static_cast<std::size_t>(count));
}

void keep_worst_rows(const PinnedBase& base, const Iterate& iterate, int count, std::vector<int>& rows)
{
    const std::vector<ScaledRow>& all = base.constraints->rows;
    const auto violation = [&](int k) { return weighed_violation(all[k], iterate.velocity); };
    std::nth_element(rows.begin(), rows.begin() + count, rows.end(),
                     [&](int a, int b) { return std::pair(-violation(a), a) < std::pair(-violation(b), b); });
    rows.resize(static_cast<std::size_t>(count));
}

}  // namespace arris
