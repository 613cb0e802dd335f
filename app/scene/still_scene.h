// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "app/scene/run_config.h"
#include "geometry/cloth/mesh_topology.h"

namespace arris {

/// Whether nothing will ever move the cloth: no load acts, nothing that holds or meets it moves, it has no
/// velocity, and it starts flat and unstrained.
bool stays_still(const RunConfig& config, const MeshTopology& topology);

}  // namespace arris
