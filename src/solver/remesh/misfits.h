// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/cloth/mesh_topology.h"
#include "geometry/surgery/cloth_surgery.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// The edges that are far too long or too short for their cells, the worst first: at most a bounded number,
/// as one step remeshes only a part of the cloth, and no more long ones than vertices are left to make. Empty
/// where too few edges miss for a new mesh to be worth it, and without remeshing.
std::vector<std::array<VertexId, 2>> find_misfits(const Scene& scene, const State& state,
                                                  const MeshTopology& topology);

}  // namespace arris
