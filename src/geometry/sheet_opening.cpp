// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/sheet_opening.h"

#include <Eigen/Geometry>

namespace arris {

std::vector<SheetOpening> find_sheet_openings(const ObstacleMesh& mesh, const ObstacleTopology& topology)
{
    const std::size_t count = topology.is_solid.size();
    // The area vectors of a closed surface add up to nothing: those of a sheet to that of a lid on its
    // border.
    std::vector<Vec3> lids(count, Vec3::Zero());
    std::vector<double> areas(count, 0.0);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const auto& [a, b, c] = mesh.faces[f];
        const Vec3 doubled = (mesh.points[b] - mesh.points[a]).cross(mesh.points[c] - mesh.points[a]);
        lids[topology.component[f]] += doubled;
        areas[topology.component[f]] += doubled.norm();
    }
    std::vector<int> border_edges(count, 0);
    for (int e = 0; e < topology.surface_edge_count; ++e) {
        const std::array<int, 2>& beside = topology.edges[e].faces;
        if (beside[1] < 0) ++border_edges[topology.component[beside[0]]];
    }
    std::vector<SheetOpening> openings;
    for (std::size_t c = 0; c < count; ++c)
        if (topology.is_solid[c] == 0) openings.push_back({border_edges[c], lids[c].norm() / areas[c]});
    return openings;
}

}  // namespace arris
