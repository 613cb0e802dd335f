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

    /// Smallest angle, degrees, between a face at the border and the flat lid that the border would have. 0
    /// for a flat sheet, 55 to 70 for tetrahedra without a face, 90 for a box without a lid.
    double least_lid_angle = 180.0;
    double upright_area =
        0.0;  ///< m^2, of faces parallel to the lid or at right angles to it, within 5 degrees

    /// Whether the sheet has one hole, and looks like a solid without a face. Either its border is short for
    /// its area: length^2 / area is 4 pi for a disk, 2 pi for a hemisphere, 3.2 for a cube without a lid. Or
    /// all faces at the border stand up from the lid, and the lid has at most six edges, or the rest is a
    /// prism: a table top without its upper side. Bowls are taken for sheets.
    bool looks_solid() const
    {
        constexpr double kSteep = 50.0;  // 45 of three sides of a cube that meet in a corner
        const bool is_short = border_length * border_length < 5.0 * area;
        const bool is_face = border_edges <= 6 || upright_area > 0.9 * area;
        return loops == 1 && (is_short || (least_lid_angle > kSteep && is_face));
    }
};

/// One entry for each sheet, in the order of the topology's components. Linear in the mesh size.
std::vector<SheetOpening> find_sheet_openings(const ObstacleMesh& mesh, const ObstacleTopology& topology);

}  // namespace arris
