// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/model/scene.h"
#include "solver/model/state.h"
#include "solver/model/step_report.h"
#include "solver/workspace.h"

namespace arris {

/// Swaps the accepted proposal in `work` into `state`, at `end` (s), and reports what presses. Where the step
/// has failed the state stays as it was.
void commit(const Scene& scene, double end, Workspace& work, State& state, StepReport& report);

}  // namespace arris
