// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "solver/velocity_solve/forward_columns.h"
#include "solver/velocity_solve/velocity_solve.h"

namespace arris {

/// A row g^T u >= lower over the coordinates that can move, scaled to a largest |g| of 1. Its gap is in m/s
/// and its multiplier an impulse in N s, whatever the scale of the given row.
struct ScaledRow {
    SparseVector entries;     ///< g, by ascending coordinate; empty where the row constrains nothing
    double lower = 0.0;       ///< m/s
    double scale = 1.0;       ///< given row = scale * g; given multiplier = multiplier / scale
    double compliance = 1.0;  ///< g^T D^-1 g, D = diag A, 1/kg: gap opened by a unit impulse without coupling
    double cap = 0.0;         ///< largest multiplier, N s
    int group = 0;
};

/// The rows of a problem. With multipliers in [0, cap] the problem always has an answer. Where the rows
/// cannot all be met, the answer minimises the energy plus the sum of cap * violation (exact L1 penalty, e.g.
/// Nocedal and Wright 2006, sec. 17.2). The rows that are not met have multipliers at their caps.
struct ConstraintRows {
    std::vector<ScaledRow> rows;  ///< one per row of the problem
    std::vector<int> impossible;  ///< rows without a coordinate that can move, where 0 < lower
    double least_speed = 0.0;     ///< m/s: least scale of relative errors
    bool is_finite = true;        ///< false with a NaN, or a bound of +infinity, which nothing can meet
};

/// `free_speed` is `estimate_free_speed` of this problem; unused without rows. Coefficients below round-off
/// of the row's largest one, fixed coordinates included, count as 0.
ConstraintRows scale_rows(const VelocityProblem& problem, double free_speed);

/// Largest speed, m/s, without bounds and rows, within an order of magnitude. Caps are relative to this
/// speed, as the constrained speed may vanish. Depends only on A, b and the fixed coordinates; costs a few
/// products with A.
double estimate_free_speed(const VelocityProblem& problem);

/// g^T u - lower.
double gap(const ScaledRow& row, const Eigen::VectorXd& velocity);

}  // namespace arris
