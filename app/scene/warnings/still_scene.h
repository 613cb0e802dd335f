// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "app/scene/parts/run_config.h"
#include "geometry/cloth/mesh_topology.h"

namespace arris {

/// Whether nothing moves the cloth during the run: no load acts, no pin or obstacle moves, and the cloth
/// starts flat, unstrained and without velocity.
bool stays_still(const RunConfig& config, const MeshTopology& topology);

}  // namespace arris
