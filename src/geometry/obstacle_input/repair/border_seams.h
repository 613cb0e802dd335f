// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/obstacle/obstacle_mesh.h"
#include "geometry/obstacle/obstacle_topology.h"

namespace arris {

/// Border edges that run along another border edge without sharing its points: faces that were meant to be
/// joined, or are joined in another program by "merge vertices by distance".
struct BorderSeams {
    int edges = 0;              ///< border edges that have such a neighbour
    double widest = 0.0;        ///< m: greatest distance of their ends from the neighbour's
    Vec3 place = Vec3::Zero();  ///< middle of the first one, m
};

/// Finds border edges whose two ends are each within 5e-4 of the mesh's size, and 0.05 of the edge, of the
/// ends of another, but not within 1e-6 of the size, where vertices are welded.
BorderSeams find_border_seams(const ObstacleMesh& mesh, const ObstacleTopology& topology);

}  // namespace arris
