// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/model/planned_step.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"
#include "solver/model/step_report.h"
#include "solver/workspace.h"

namespace arris {

/// Swaps the accepted proposal in `work` into `state`, whose time becomes `end` (s), and reports which
/// contacts press. The last part of the planned step counts that step, and lets cell lengths follow. A failed
/// part leaves the state unchanged.
void commit(const Scene& scene, const PlannedStep& planned, double end, Workspace& work, State& state,
            StepReport& report);

}  // namespace arris
