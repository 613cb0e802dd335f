// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/newton_share.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <vector>

#include "solver/velocity_solve/friction_springs.h"
#include "solver/velocity_solve/symmetric_product.h"

namespace arris {

double find_newton_share(const VelocityProblem& problem, const ConstraintRows& constraints,
                         const Eigen::VectorXd& from, const Eigen::VectorXd& to)
{
    constexpr int kBisections = 40;
    const Eigen::VectorXd way = to - from;
    const double slope = way.dot(symmetric_product(*problem.matrix, from) - *problem.rhs),
                 curvature = way.dot(symmetric_product(*problem.matrix, way));
    std::vector<std::array<double, 3>> springs;  // gap at the start, its change, 1 / give
    for (std::size_t k = constraints.slip_count(); k < constraints.rows.size(); ++k) {
        const ScaledRow& row = constraints.rows[k];
        if (row.entries.empty()) continue;
        const double start = gap(row, from, 0.0), end = gap(row, to, 0.0);
        if (start < 0.0 || end < 0.0) springs.push_back({start, end - start, 1.0 / row.give});
    }
    std::vector<std::tuple<int, Eigen::Vector2d, Eigen::Vector2d>> slips;  // y at the start, its change
    for (int p = 0; p < constraints.pair_count(); ++p)
        slips.emplace_back(p, slip_of(constraints, p, from), slip_of(constraints, p, way));
    const auto slope_at = [&](double share) {
        double sum = slope + share * curvature;
        for (const auto& [start, change, stiffness] : springs)
            sum += stiffness * change * std::min(start + share * change, 0.0);
        for (const auto& [pair, start, change] : slips)
            sum -= change.dot(friction_at(constraints, pair, start + share * change));
        return sum;
    };
    double low = 0.0, high = 1.0;
    if (!(slope_at(high) > 0.0)) return 1.0;
    for (int k = 0; k < kBisections; ++k) {
        const double middle = 0.5 * (low + high);
        (slope_at(middle) > 0.0 ? high : low) = middle;
    }
    return high;
}

std::vector<int> find_newton_rows(const ConstraintRows& constraints, const Eigen::VectorXd& multipliers,
                                  const Eigen::VectorXd& point)
{
    std::vector<int> rows;
    std::map<int, std::pair<double, int>> worst;  // by group
    for (int k = constraints.slip_count(); k < static_cast<int>(constraints.rows.size()); ++k) {
        const ScaledRow& row = constraints.rows[k];
        const double here = row.entries.empty() ? 0.0 : gap(row, point, 0.0);
        if (!(here < 0.0)) continue;
        if (multipliers[k] > 0.0 || constraints.pair_count() > 0) {
            rows.push_back(k);
            continue;
        }
        const double depth = -here / std::sqrt(row.compliance);
        const auto [at, is_new] = worst.try_emplace(row.group, depth, k);
        if (!is_new && depth > at->second.first) at->second = {depth, k};
    }
    for (const auto& [group, row] : worst) rows.push_back(row.second);
    std::sort(rows.begin(), rows.end());
    return rows;
}

}  // namespace arris
