// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "app/scene/parts/run_config.h"
#include "app/scene/warnings/warnings.h"
#include "geometry/cloth/mesh_topology.h"

namespace arris {

/// Warns of layers too thick for the cells of the mesh, and of layers that start too near to each other.
void check_layers(const RunConfig& config, const MeshTopology& topology, Warnings& warnings);

}  // namespace arris
