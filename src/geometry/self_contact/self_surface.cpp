// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/self_contact/self_surface.h"

#include <algorithm>

namespace arris {

SelfSurface::SelfSurface(int vertex_count, const std::vector<Face>& of_faces, const MeshTopology& topology)
    : faces(of_faces),
      edges(topology.edges),
      faces_at(vertex_count, of_faces),
      owned(assign_owners(vertex_count, of_faces, topology.edges)),
      edges_of(of_faces.size())
{
    for (std::size_t e = 0; e < edges.size(); ++e)
        for (const int f : {edges[e].face_left, edges[e].face_right})
            for (int k = 0; f >= 0 && k < 3; ++k) {
                const auto [low, high] = std::minmax(faces[f][k], faces[f][(k + 1) % 3]);
                if (low == edges[e].a && high == edges[e].b) edges_of[f][k] = static_cast<int>(e);
            }
}

bool SelfSurface::joins(const std::array<int, 4>& vertices, int first_count) const
{
    if (joined.empty()) return false;
    for (int i = 0; i < first_count; ++i)
        for (int j = first_count; j < 4; ++j)
            if (const int number = joined[vertices[i]]; number >= 0 && number == joined[vertices[j]])
                return true;
    return false;
}

int SelfSurface::apex(const MeshEdge& edge, int face) const
{
    for (const int v : faces[face])
        if (v != edge.a && v != edge.b) return v;
    return -1;
}

}  // namespace arris
