// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <vector>

#include "geometry/obstacle/obstacle_mesh.h"

namespace arris {

/// An edge of an obstacle's triangles, or a segment of a wire.
struct ObstacleEdge {
    std::array<int, 2> points;  ///< ascending
    std::array<int, 2> faces;   ///< faces beside the edge: second -1 on a border, both -1 on a wire
};

/// Adjacency of an obstacle's points, edges and faces. Edges of triangles come first, ascending by points;
/// then wire segments in the mesh's order.
struct ObstacleTopology {
    std::vector<ObstacleEdge> edges;
    int surface_edge_count = 0;
    std::vector<std::array<int, 3>> face_edges;  ///< edge i runs from corner i to corner i + 1
    std::vector<Vec3> face_normals;  ///< unit; zero where a face of a pose (obstacle.h) has no area
    std::vector<int> first_edge;     ///< start of each point's range in `point_edges`; size
                                     ///< points + 1
    std::vector<int> point_edges;    ///< edges at a point, ascending
    std::vector<int> component;      ///< of each face
    std::vector<char> is_solid;      ///< 1 for each component without a border

    int edge_at(int point, int k) const { return point_edges[first_edge[point] + k]; }
    int edge_count_at(int point) const { return first_edge[point + 1] - first_edge[point]; }

    std::vector<int> faces_at(int point) const;  ///< ascending, once each

    /// The face across edge i of `face`; -1 on a border.
    int neighbour(int face, int i) const
    {
        const std::array<int, 2>& sides = edges[face_edges[face][i]].faces;
        return sides[0] == face ? sides[1] : sides[0];
    }
};

/// Labels `seed` and the faces connected to it through unlabelled faces for which `may_enter(face)` holds.
/// Label -1 means none.
template <typename MayEnter>
void label_connected(const ObstacleTopology& topology, int seed, int label, const MayEnter& may_enter,
                     std::vector<int>& labels)
{
    std::vector<int> open(1, seed);
    labels[seed] = label;
    while (!open.empty()) {
        const int f = open.back();
        open.pop_back();
        for (int i = 0; i < 3; ++i) {
            const int g = topology.neighbour(f, i);
            if (g < 0 || labels[g] >= 0 || !may_enter(g)) continue;
            labels[g] = label;
            open.push_back(g);
        }
    }
}

/// Linear in the mesh size, apart from a sort. The mesh must pass `validate`.
ObstacleTopology make_topology(const ObstacleMesh& mesh);

/// Sets the face normals to those of the mesh's present points.
void update_normals(const ObstacleMesh& mesh, ObstacleTopology& topology);

/// Describes the first defect of an obstacle's mesh; empty if there is none. Coordinates must be finite and
/// indices in range. No face or segment may be degenerate (exact predicate). At most two faces may meet at an
/// edge, with consistent orientation.
std::string validate(const ObstacleMesh& mesh);

}  // namespace arris
