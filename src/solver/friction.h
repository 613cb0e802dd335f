// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

#include "solver/friction/friction_pairs.h"
#include "solver/friction/friction_sweeps.h"
#include "solver/workspace.h"

namespace arris {

/// The parts of a step that friction reads.
RubbingCloth rubbing_cloth(const Scene& scene, const State& state, const Workspace& work);

/// Solves `work.problem` with `solve`, which sets `work.solution`, until the friction budgets agree with its
/// impulses. Stores each contact's friction in `work.contacts`, and the outcome in `report`.
void solve_with_friction(const Scene& scene, const State& state,
                         const std::function<const VelocitySolution&()>& solve, Workspace& work,
                         StepReport& report);

}  // namespace arris
