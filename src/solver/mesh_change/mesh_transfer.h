// SPDX-License-Identifier: GPL-3.0-or-later
// What the cloth carries over a change of its mesh. A new vertex in the surface has what the surface had
// there, which changes nothing; where an edge or vertex went, or a vertex became or ceased to be EOL, the
// velocity around it is the nearest that the new mesh can have, with the same momentum
// (physics/velocity_fit.h).
#pragma once

#include <limits>

#include "solver/mesh_change/conform.h"
#include "solver/mesh_change/patch_fit.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// The state on the new mesh: positions, velocities, history, and of contacts and anchors those whose
/// vertices are still there. `stars` are those of `before`, `stars_after` of the new mesh. Unfinished where a
/// patch stays strained by more than `most_strain`, as a share of what moves it.
State transfer(const Scene& scene, const State& before, const ClothStars& stars,
               const ConformedMesh& conformed, const ClothStars& stars_after, TransferReport& report,
               double most_strain = std::numeric_limits<double>::infinity());

}  // namespace arris
