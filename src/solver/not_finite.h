// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/model/state.h"
#include "solver/model/step_report.h"
#include "solver/workspace.h"

namespace arris {

/// Stages of a step whose results are checked to be finite before the next stage uses them.
enum class CheckedStage { Start, Move, Contacts, Solve, Proposal };

/// The first number of a stage's results that is not finite: what it is, and of which vertex, pin or
/// obstacle. `state` belongs to the step's mesh. Start: the state itself. Solve: A, b, bounds and contacts of
/// a problem that the velocity solve refused, or else its velocity. Linear in the number of vertices and
/// contacts; Solve, which runs only after a failure, also in the size of A.
NotFinite find_not_finite(CheckedStage stage, const State& state, const Workspace& work);

/// Records what `find_not_finite` finds, which ends the attempt. False where all numbers are finite.
bool note_not_finite(CheckedStage stage, const State& state, const Workspace& work, StepReport& report);

}  // namespace arris
