// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "solver/friction/friction_pairs.h"
#include "solver/friction/friction_sweeps.h"
#include "solver/retry_policy.h"
#include "solver/workspace.h"

namespace arris {

/// Residual of friction, relative to the largest budget, above which friction is far from Coulomb's law.
inline constexpr double kFarFromLaw = 0.1;

/// The parts of a step that friction reads.
RubbingCloth rubbing_cloth(const Scene& scene, const State& state, const Workspace& work);

/// Solves `work.problem` with `solve`, which sets `work.solution`, until the friction budgets agree with its
/// impulses. Stores each contact's friction in `work.contacts`, and the outcome in `report`. Where they come
/// to no agreement the last certified solution is used: if it is off by at most kFarFromLaw, or the attempt
/// is the last.
void solve_with_friction(const Scene& scene, const State& state, Attempt attempt,
                         const std::function<const VelocitySolution&()>& solve, Workspace& work,
                         StepReport& report);

}  // namespace arris
