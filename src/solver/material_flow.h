// SPDX-License-Identifier: GPL-3.0-or-later
// How far material flows through EOL vertices in a step, and that no face beside them loses most of what it
// has, or turns over. A strain that changes more than one linearisation can follow is seen in the energy, and
// linearised again (relinearization.h): a flow that is fast but steady, as over an edge, needs no shorter
// step.
#pragma once

#include "solver/state.h"
#include "solver/time_integration.h"
#include "solver/workspace.h"

namespace arris {

/// In how many equal parts a step of `dt` (s) is better made: so that in none of them more material flows
/// than cells usually have to give. A function of the state, not more than 4.
int find_flow_parts(const Scene& scene, const State& state, double dt);

/// The material side of the linearisation in `work.at`, which must have one; `end` is where the step ends
/// with v^. False where the mesh has not that much material: `work.overrun` says over which vertices.
bool linearise_flow(const State& state, const MovingCloth& end, Workspace& work);

/// X' = X~ + gamma V' of the velocity solved. False alike.
bool propose_flow(Workspace& work);

}  // namespace arris
