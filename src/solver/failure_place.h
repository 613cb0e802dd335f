// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/contact/proposal.h"
#include "solver/model/state.h"
#include "solver/model/step_report.h"
#include "solver/workspace.h"

namespace arris {

/// Completes the report of a failed attempt at a step: where it failed, and at which obstacles. `violations`
/// and `overrun` are those of the last round. An infeasible step of which nothing is named yet gets the
/// names, too.
void name_failure(const State& state, const Workspace& work, const Violations& violations,
                  const std::vector<Overrun>& overrun, StepReport& report);

}  // namespace arris
