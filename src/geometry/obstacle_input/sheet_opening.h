// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/obstacle/obstacle_mesh.h"
#include "geometry/obstacle/obstacle_topology.h"

namespace arris {

/// The border of one open component (sheet) of an obstacle.
struct SheetOpening {
    int border_edges = 0, loops = 0;  ///< number of border edges, and of closed loops that they form
    double border_length = 0.0;       ///< m
    double area = 0.0;                ///< m^2

    /// Whether the sheet has one hole and a border that is short for its area, as a solid with a missing lid
    /// has. length^2 / area is 4 pi for a disk, 2 pi for a hemisphere, 3.2 for a cube without a lid.
    bool looks_solid() const { return loops == 1 && border_length * border_length < 5.0 * area; }
};

/// One entry for each sheet, in the order of the topology's components. Linear in the mesh size.
std::vector<SheetOpening> find_sheet_openings(const ObstacleMesh& mesh, const ObstacleTopology& topology);

}  // namespace arris
