// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/cloth/mesh_topology.h"
#include "geometry/surgery/cloth_surgery.h"
#include "solver/eol/cloth_stars.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// The edges that are far too long or too short for their cells, the worst first: at most a bounded number,
/// as one step remeshes only a part of the cloth, and no more long ones than vertices are left to make.
/// Leaves out refused edges that still wait. Empty where too few edges miss for a new mesh to be worth it,
/// and without remeshing.
std::vector<std::array<VertexId, 2>> find_misfits(const Scene& scene, const State& state,
                                                  const MeshTopology& topology);

/// Updates `State::refused_edges` at the end of a part that began with these misfits, before `state.step`
/// counts it. An edge that is still there was refused. After its n-th refusal it is tried again 2^n times
/// kRemeshPeriod steps later, n at most 5: a guard often refuses until the cloth has moved. `stars` belong to
/// the state.
void note_refused_edges(const std::vector<std::array<VertexId, 2>>& misfits, const ClothStars& stars,
                        State& state);

}  // namespace arris
