// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <boost/container/static_vector.hpp>
#include <utility>
#include <vector>

#include "solver/velocity_solve/velocity_solve.h"

namespace arris {

/// (coordinate, coefficient); no memory of its own, as there are many.
using RowEntries = boost::container::static_vector<std::pair<int, double>, ConstraintRow::kMostEntries>;

/// A row g^T u >= lower over the coordinates that can move, scaled to a largest |g| of 1. Its gap is in m/s
/// and its multiplier an impulse in N s, whatever the scale of the given row.
struct ScaledRow {
    RowEntries entries;       ///< g, by ascending coordinate; empty where the row constrains nothing
    double lower = 0.0;       ///< m/s: the given one, and the way that the expected multiplier presses
    double scale = 1.0;       ///< given row = scale * g; given multiplier = multiplier / scale
    double mobility = 1.0;    ///< g^T D^-1 g, D = diag A, 1/kg: gap opened by a unit impulse without coupling
    double spring = 0.0;      ///< 1/kg: part of `compliance` that is the row's own
    double compliance = 0.0;  ///< 1/kg: speed by which the row gives way to a unit multiplier
    int group = 0;
};

/// The rows of a problem. Each is a stiff spring that only pushes: multiplier = max(0, lower - g^T u) /
/// compliance. The problem is then min 1/2 u^T A u - b^T u + sum_k max(0, lower_k - g_k^T u)^2 / (2
/// compliance_k). It is strictly convex, so it has one answer, however many rows repeat or contradict each
/// other. Rows that can be met give way by less than 1e-5 of the free speed.
struct ConstraintRows {
    std::vector<ScaledRow> rows;  ///< two per friction pair, then one per row of the problem
    std::vector<double> budgets;  ///< N s, in the scale of the rows, one per friction pair
    std::vector<double> masses;   ///< kg, likewise
    std::vector<int>
        impossible;  ///< rows of the problem that ask for too much of what can move, or for motion of nothing
    double least_speed = 0.0;  ///< m/s: least scale of relative errors
    double unmet_speed = 0.0;  ///< m/s: a row that gives way by more cannot be met
    bool is_finite = true;     ///< false with a NaN, or a bound of +infinity, which nothing can meet

    int pair_count() const { return static_cast<int>(budgets.size()); }
    int slip_count() const { return 2 * pair_count(); }  ///< index of the problem's first row
};

/// Whether coefficients are finite, and the bound, too, or -infinity; of a pair, whether all its numbers are.
bool is_well_formed(const ConstraintRow& row);
bool is_well_formed(const FrictionPair& pair);

/// `free_speed` is `estimate_free_speed` of this problem; unused without rows. Coefficients below round-off
/// of the row's largest one, fixed coordinates included, count as 0.
ConstraintRows scale_rows(const VelocityProblem& problem, double free_speed);

/// Largest speed, m/s, without bounds and rows, within an order of magnitude. What cannot be
/// met is relative to this speed, as the constrained speed may vanish. Depends only on A, b and the fixed
/// coordinates; costs a few products with A.
double estimate_free_speed(const VelocityProblem& problem);

/// g^T u - lower + compliance * multiplier: 0 for a row that presses.
double gap(const ScaledRow& row, const Eigen::VectorXd& velocity, double multiplier);

/// The problem's rows that give way further than rows that can be met, and rows without a movable coordinate,
/// ascending. `multipliers`: of the scaled rows.
std::vector<int> find_infeasible_rows(const ConstraintRows& constraints, const Eigen::VectorXd& multipliers);

}  // namespace arris
