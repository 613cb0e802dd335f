// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/base_in_use.h"

namespace arris {

std::vector<int> BaseInUse::move_springs()
{
    const ConstraintRows& constraints = *base.constraints;
    std::vector<int> stalled;
    if (base.slips.empty()) return stalled;
    for (int p = 0; p < constraints.pair_count(); ++p) {
        if (set.contains_row(2 * p)) continue;
        if (is_stalled[p]) stalled.insert(stalled.end(), {2 * p, 2 * p + 1});
        base.slips[p] = through(base.slips[p], constraints, p, slip_of(constraints, p, iterate.velocity));
    }
    solve_with_forces(base);
    return stalled;
}

void BaseInUse::measure_lag()
{
    constexpr double kFalling = 0.7;
    const ConstraintRows& constraints = *base.constraints;
    const double same = kSameFriction * constraints.largest_budget();
    for (int p = 0; p < constraints.pair_count(); ++p) {
        const Eigen::Vector2d y = slip_of(constraints, p, iterate.velocity);
        const double now = (base.slips[p].at(y) - friction_at(constraints, p, y)).norm();
        is_stalled[p] = now > same && now > kFalling * lag[p];
        lag[p] = now;
    }
}

}  // namespace arris
