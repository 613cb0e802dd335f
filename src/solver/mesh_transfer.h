// SPDX-License-Identifier: GPL-3.0-or-later
// What the cloth carries over a change of its mesh. A new vertex in the surface has what the surface had
// there, which changes nothing; where an edge or vertex went, or a vertex became or ceased to be EOL, the
// velocity around it is the nearest that the new mesh can have, with the same momentum
// (physics/velocity_fit.h).
#pragma once

#include "solver/conform.h"
#include "solver/patch_fit.h"
#include "solver/scene.h"
#include "solver/state.h"

namespace arris {

/// The state on the new mesh: positions, velocities, history, and of contacts and anchors those whose
/// vertices are still there. Unfinished where it is to stop on a strain and has.
State transfer(const Scene& scene, const State& before, const ConformedMesh& conformed,
               TransferReport& report, OnStrain on_strain = OnStrain::GoOn);

}  // namespace arris
