// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/sheet_opening.h"

#include <Eigen/Geometry>
#include <utility>

namespace arris {

namespace {

/// Clears `is_open` along the loop of border edges connected to `first`.
void close_loop(const ObstacleTopology& topology, int first, std::vector<char>& is_open)
{
    std::vector<int> next = {first};
    is_open[first] = 0;
    while (!next.empty()) {
        const int e = next.back();
        next.pop_back();
        for (const int p : topology.edges[e].points)
            for (int k = 0; k < topology.edge_count_at(p); ++k)
                if (const int other = topology.edge_at(p, k); std::exchange(is_open[other], 0))
                    next.push_back(other);
    }
}

}  // namespace

std::vector<SheetOpening> find_sheet_openings(const ObstacleMesh& mesh, const ObstacleTopology& topology)
{
    std::vector<SheetOpening> all(topology.is_solid.size());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const auto& [a, b, c] = mesh.faces[f];
        all[topology.component[f]].area +=
            0.5 * (mesh.points[b] - mesh.points[a]).cross(mesh.points[c] - mesh.points[a]).norm();
    }
    std::vector<char> is_open(topology.edges.size(), 0);
    for (int e = 0; e < topology.surface_edge_count; ++e) {
        const auto& [points, faces] = topology.edges[e];
        if (faces[1] >= 0) continue;
        is_open[e] = 1;
        SheetOpening& opening = all[topology.component[faces[0]]];
        ++opening.border_edges;
        opening.border_length += (mesh.points[points[1]] - mesh.points[points[0]]).norm();
    }
    for (int e = 0; e < topology.surface_edge_count; ++e) {
        if (!is_open[e]) continue;
        close_loop(topology, e, is_open);
        ++all[topology.component[topology.edges[e].faces[0]]].loops;
    }
    std::vector<SheetOpening> openings;
    for (std::size_t c = 0; c < all.size(); ++c)
        if (!topology.is_solid[c]) openings.push_back(all[c]);
    return openings;
}

}  // namespace arris
