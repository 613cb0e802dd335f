// SPDX-License-Identifier: GPL-3.0-or-later
// Carries velocity and history of the cloth over to a changed mesh. A new vertex on the surface gets the
// interpolated state, which changes nothing. Where an edge or vertex has gone, or a vertex has become or
// ceased to be EOL, the velocity around it is fitted: the nearest that the new mesh can have with the same
// momentum (physics/system/velocity_fit.h).
#pragma once

#include <limits>

#include "solver/mesh_change/conform.h"
#include "solver/mesh_change/patch_fit.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// The state on the new mesh: positions, velocities, history, and the contacts and anchors whose vertices
/// still exist. `stars` belong to `before`, `stars_after` to the new mesh. Unfinished where a patch's strain
/// (TransferReport) stays above `most_strain`.
State transfer(const Scene& scene, const State& before, const ClothStars& stars,
               const ConformedMesh& conformed, const ClothStars& stars_after, TransferReport& report,
               double most_strain = std::numeric_limits<double>::infinity());

}  // namespace arris
