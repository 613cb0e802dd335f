// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/self_contact/self_surface.h"

#include <algorithm>

namespace arris {

SelfSurface::SelfSurface(int vertex_count, const std::vector<Face>& faces, const MeshTopology& topology)
    : faces(faces),
      edges(topology.edges),
      faces_at(vertex_count, faces),
      own_vertices(faces.size(), {-1, -1, -1}),
      own_edges(faces.size(), {-1, -1, -1}),
      edges_of(faces.size())
{
    std::vector<char> is_owned(static_cast<std::size_t>(vertex_count), 0);
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (int k = 0; k < 3; ++k) {
            if (is_owned[faces[f][k]]) continue;
            is_owned[faces[f][k]] = 1;
            own_vertices[f][k] = faces[f][k];
        }
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const MeshEdge& edge = edges[e];
        for (const int f : {edge.face_left, edge.face_right}) {
            if (f < 0) continue;
            for (int k = 0; k < 3; ++k) {
                const int a = faces[f][k], b = faces[f][(k + 1) % 3];
                if (std::min(a, b) != edge.a || std::max(a, b) != edge.b) continue;
                edges_of[f][k] = static_cast<int>(e);
                if (f == edge.face_left) own_edges[f][k] = static_cast<int>(e);
            }
        }
    }
}

int SelfSurface::apex(const MeshEdge& edge, int face) const
{
    for (const int v : faces[face])
        if (v != edge.a && v != edge.b) return v;
    return -1;
}

}  // namespace arris
