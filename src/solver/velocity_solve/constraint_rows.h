// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "solver/velocity_solve/forward_columns.h"
#include "solver/velocity_solve/velocity_solve.h"

namespace arris {

/// A row g^T u >= lower over the coordinates that can move, scaled to a largest |g| of 1: its gap is in m/s,
/// its multiplier an impulse in N s, whatever the scale of what was given.
struct ScaledRow {
    SparseVector entries;     ///< g, by ascending coordinate; empty: this row constrains nothing
    double lower = 0.0;       ///< m/s
    double scale = 1.0;       ///< the row given is this times g: multiplier given = multiplier / scale
    double compliance = 1.0;  ///< g^T D^-1 g, D = diag A, 1/kg: what a unit impulse does at once
    double cap = 0.0;         ///< of the multiplier, N s
    int group = 0;
};

/// The rows of a problem. With multipliers in [0, cap] the problem always has an answer: where the rows
/// cannot all be met it is that of the energy plus the sum of cap * violation (exact L1 penalty, e.g. Nocedal
/// and Wright 2006, sec. 17.2), and the rows that are not met are those whose multiplier stands at its cap.
struct ConstraintRows {
    std::vector<ScaledRow> rows;  ///< one each row of the problem
    std::vector<int> impossible;  ///< no coordinate of them can move, and 0 < lower
    double least_speed = 0.0;     ///< m/s: errors are never taken relative to less
    bool is_finite = true;        ///< false: a NaN, or a bound of +infinity, which nothing can meet
};

/// `free_speed`: as `estimate_free_speed` of the same problem; unused without rows. Coefficients below
/// round-off of the row's largest, those of fixed coordinates included, count as 0.
ConstraintRows scale_rows(const VelocityProblem& problem, double free_speed);

/// How fast, in m/s, anything would move without bounds and rows, within an order of magnitude: caps are
/// relative to it, so that they do not vanish where the constraints bring everything to rest. A function of
/// A, b and what is fixed alone; costs a few products with A.
double estimate_free_speed(const VelocityProblem& problem);

/// g^T u - lower.
double gap(const ScaledRow& row, const Eigen::VectorXd& velocity);

}  // namespace arris
