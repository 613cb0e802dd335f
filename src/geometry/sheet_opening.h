// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/obstacle_mesh.h"
#include "geometry/obstacle_topology.h"

namespace arris {

/// An open component of an obstacle: a sheet.
struct SheetOpening {
    int border_edges = 0;
    double share =
        0.0;  ///< what its border spans by its own area: 1 flat, .5 half a sphere, .2 a lidless cube
};

/// All of them, in the order of the topology's components. Linear in the mesh.
std::vector<SheetOpening> find_sheet_openings(const ObstacleMesh& mesh, const ObstacleTopology& topology);

}  // namespace arris
