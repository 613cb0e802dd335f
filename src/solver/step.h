// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "physics/forces/energies.h"
#include "solver/model/planned_step.h"
#include "solver/model/scene.h"
#include "solver/model/settings.h"
#include "solver/model/state.h"
#include "solver/model/step_report.h"
#include "solver/workspace.h"

namespace arris {

/// The state at time 0: the cloth lies as in `mesh` and moves at `velocity` (m/s); pinned vertices move with
/// their pins.
State make_state(const Scene& scene, ClothMesh mesh, const Vec3& velocity);
State make_state(const Scene& scene, ClothMesh mesh, std::vector<Vec3> velocity);

/// Makes the part of a planned step from the state's time to `end` (s, after that time). Leaves the state
/// unchanged unless the report's status is Done. (At time 0, `state.active` may be set even so.) Call
/// `restart` first where the input jumps at the part's start. Throws Interrupted.
StepReport make_part(const Scene& scene, const Settings& settings, const PlannedStep& planned, double end,
                     State& state, Workspace& work, Attempt attempt);

/// Makes a planned step from the state's time to `end` (s) in one part.
StepReport step(const Scene& scene, const Settings& settings, double end, State& state, Workspace& work,
                Attempt attempt = Attempt::Ordinary);

/// Rebuilds terms and elements in `work` where they do not belong to the state's mesh.
void prepare(const Scene& scene, const State& state, Workspace& work);

/// Drops the integrator's history, so that the next step is implicit Euler. For a jump of the input.
void restart(State& state);

}  // namespace arris
