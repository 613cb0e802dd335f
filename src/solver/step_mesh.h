// SPDX-License-Identifier: GPL-3.0-or-later
// The mesh that a step is made on, and what is made of it.
#pragma once

#include "solver/scene.h"
#include "solver/state.h"
#include "solver/step_report.h"
#include "solver/workspace.h"

namespace arris {

/// The state to step from to `end` (s): `state` as it is, or in `work` on a mesh with EOL vertices where
/// features press. Prepared.
State& conform(const Scene& scene, double end, State& state, Workspace& work, StepReport& report);

/// Terms and elements of the scene's cloth as it is, made anew in `work` where they are not those of the
/// state's mesh.
void prepare(const Scene& scene, const State& state, Workspace& work);

}  // namespace arris
