// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/obstacle/obstacle_mesh.h"
#include "geometry/obstacle/obstacle_topology.h"

namespace arris {

/// An open component of an obstacle: a sheet.
struct SheetOpening {
    int border_edges = 0, loops = 0;  ///< that these make
    double border_length = 0.0;       ///< m
    double area = 0.0;                ///< m^2

    /// Has one hole, and a border that is short for its area: length^2 / area is 4 pi of a disk, 2 pi of half
    /// a sphere, 3.2 of a lidless cube.
    bool looks_solid() const { return loops == 1 && border_length * border_length < 5.0 * area; }
};

/// All of them, in the order of the topology's components. Linear in the mesh.
std::vector<SheetOpening> find_sheet_openings(const ObstacleMesh& mesh, const ObstacleTopology& topology);

}  // namespace arris
