// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/sheet_opening.h"

#include <Eigen/Geometry>
#include <utility>

namespace arris {

namespace {

int count_loops(const ObstacleTopology& topology, const std::vector<int>& border)
{
    std::vector<char> is_open(topology.edges.size(), 0);
    for (const int e : border) is_open[e] = 1;
    int loops = 0;
    for (const int first : border) {
        if (!std::exchange(is_open[first], 0)) continue;
        ++loops;
        std::vector<int> next = {first};
        while (!next.empty()) {
            const int e = next.back();
            next.pop_back();
            for (const int p : topology.edges[e].points)
                for (int k = 0; k < topology.edge_count_at(p); ++k)
                    if (const int other = topology.edge_at(p, k); std::exchange(is_open[other], 0))
                        next.push_back(other);
        }
    }
    return loops;
}

}  // namespace

std::vector<SheetOpening> find_sheet_openings(const ObstacleMesh& mesh, const ObstacleTopology& topology)
{
    const std::size_t count = topology.is_solid.size();
    std::vector<SheetOpening> all(count);
    std::vector<std::vector<int>> borders(count);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const auto& [a, b, c] = mesh.faces[f];
        all[topology.component[f]].area +=
            0.5 * (mesh.points[b] - mesh.points[a]).cross(mesh.points[c] - mesh.points[a]).norm();
    }
    for (int e = 0; e < topology.surface_edge_count; ++e) {
        const auto& [points, faces] = topology.edges[e];
        if (faces[1] >= 0) continue;
        const int c = topology.component[faces[0]];
        borders[c].push_back(e);
        all[c].border_length += (mesh.points[points[1]] - mesh.points[points[0]]).norm();
    }
    std::vector<SheetOpening> openings;
    for (std::size_t c = 0; c < count; ++c) {
        if (topology.is_solid[c]) continue;
        all[c].border_edges = static_cast<int>(borders[c].size());
        all[c].loops = count_loops(topology, borders[c]);
        openings.push_back(all[c]);
    }
    return openings;
}

}  // namespace arris
