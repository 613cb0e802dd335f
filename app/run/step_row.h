// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "app/files/csv_table.h"
#include "app/scene/run_config.h"
#include "solver/contact/audit.h"
#include "solver/model/state.h"
#include "solver/model/step_report.h"
#include "solver/workspace.h"

namespace arris {

/// The row of steps.csv for the step that has led to `state`. `work` holds the elements of the state's mesh,
/// `audited` the audit of the state, where there was one. Not set: the row's CPU seconds and `is_halved`.
StepRow make_step_row(const RunConfig& config, const State& state, const Workspace& work,
                      const Audit& audited, const StepReport& report);

/// The report of a step that was made in two parts: where the second part has led, and what both have cost
/// and lost.
StepReport join_parts(const StepReport& opening, StepReport rest);

}  // namespace arris
