// SPDX-License-Identifier: GPL-3.0-or-later
// How far material flows through EOL vertices in a step, and that no face beside them loses most of what it
// has, or turns over. A strain that changes more than one linearisation can follow is seen in the energy, and
// linearised again (relinearization.h): a flow that is fast but steady, as over an edge, needs no shorter
// step.
#pragma once

#include "solver/model/state.h"
#include "solver/model/time_integration.h"
#include "solver/workspace.h"

namespace arris {

/// In how many equal parts a step of `dt` (s) is better made: so that in none of them more material flows
/// than cells usually have to give. A function of the state, not more than 4.
int find_flow_parts(const Scene& scene, const State& state, double dt);

/// Whether every face at an EOL vertex keeps its orientation, with enough of the material that it has at the
/// step's start for its strain to mean something; `work.overrun` says at which vertices one does not. Whether
/// what is linear in the step follows is another question, to which the energy's balance has the answer.
bool has_material_left(const std::vector<Vec2>& material, Workspace& work);

/// The material side of the linearisation in `work.linearization`, which must have one, at q^ of
/// `work.expansion` and at the extrapolated state. Neither is where the step will end: vertices that would
/// leave too little material there go back on their way, in the world and in the material together, in
/// `work.expansion` too. False where even that does not do, as where something is not finite.
bool linearise_flow(const State& state, Workspace& work);

/// X' = X~ + gamma V' of the velocity solved. False where the mesh has not that much material: `work.overrun`
/// says over which vertices.
bool propose_flow(Workspace& work);

}  // namespace arris
