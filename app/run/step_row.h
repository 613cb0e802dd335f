// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "app/files/csv_table.h"
#include "app/scene/parts/run_config.h"
#include "solver/contact/audit.h"
#include "solver/model/state.h"
#include "solver/model/step_report.h"
#include "solver/workspace.h"

namespace arris {

/// The row of steps.csv for the step that ended at `state`. `work` holds the elements of the state's mesh.
/// `audited` is the audit of the state, or empty without an audit. The row's number, CPU time, `is_halved`
/// and `max_strain` are left unset.
StepRow make_step_row(const RunConfig& config, const State& state, const Workspace& work,
                      const Audit& audited, const StepReport& report);

/// Joins the reports of a step's opening and rest: counts of the state from the rest; dt, energy rise, cost,
/// yielded and rewound from both.
StepReport join_parts(const StepReport& opening, StepReport rest);

}  // namespace arris
