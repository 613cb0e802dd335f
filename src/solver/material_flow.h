// SPDX-License-Identifier: GPL-3.0-or-later
// Flow of material through EOL vertices in a step. No face beside them may turn over or lose more than
// kMostFaceTaken of its material. A strain that changes more than one linearisation can follow raises the
// energy, and forces are then linearised again (relinearization.h). So a fast but steady flow, as over an
// edge, needs no shorter step.
#pragma once

#include "solver/model/state.h"
#include "solver/model/time_integration.h"
#include "solver/workspace.h"

namespace arris {

/// Number of equal parts, at most 4, in which a step of `dt` (s) is made. No part then takes more material
/// than cells usually have to give. Depends only on the state.
int find_flow_parts(const Scene& scene, const State& state, double dt);

/// EOL vertices of faces that would turn over in `dt` (s), or keep too little of their material at the step's
/// start for a meaningful strain: one entry a face. `material`: of all vertices at the step's end, m. `mesh`
/// belongs to the step's start. Whether one linearisation can follow the flow is judged by the energy balance
/// instead.
std::vector<Overrun> find_overrun(const std::vector<Vec2>& material, const std::vector<EolCoordinates>& eol,
                                  const MeshCache& mesh, double dt);

/// Fills the flow of `work.linearization`, which must exist, at q^ (from `work.expansion`) and at the
/// extrapolated state. The step ends at neither. So vertices that would leave too little material there go
/// back on their way, both in the world and in the material, also in `work.expansion`. Returns the
/// vertices for which even this leaves too little, as where a value is not finite.
std::vector<Overrun> linearise_flow(const State& state, Workspace& work);

/// Proposes X' = X~ + gamma V' of the solved velocity. Returns the vertices of faces with too little
/// material.
std::vector<Overrun> propose_flow(Workspace& work);

}  // namespace arris
