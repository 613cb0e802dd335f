// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/model/scene.h"
#include "solver/model/state.h"
#include "solver/model/step_report.h"
#include "solver/retry_policy.h"
#include "solver/workspace.h"

namespace arris {

/// Whether the weighed proposal pushes energy in, or has much that the equations did not foresee: then the
/// forces are to be linearised again, at the velocity found (`work.expansion`), and true means solve again.
/// Where that is no way out, `report.status` says so; with the last attempt the least that there was is
/// taken.
bool enforce_energy_balance(const Scene& scene, const State& state, Attempt attempt, bool may_solve_again,
                            Workspace& work, StepReport& report);

/// Where a step has failed after all, but had a velocity that raised no energy before its forces were
/// linearised again: true where it is to be solved for once more.
bool restore_least_rise(Workspace& work, StepReport& report);

/// Where the velocity solved, of which `work.proposal` has all, would take more material than there is: the
/// forces are to be linearised again as far on the way to it as there is, and true means solve again. What q^
/// took through a feature that stops it is cloth stretched over that, which seems to pull its material along.
bool linearise_nearer(Workspace& work, StepReport& report);

}  // namespace arris
