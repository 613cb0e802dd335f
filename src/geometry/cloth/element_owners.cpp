// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth/element_owners.h"

#include <algorithm>

namespace arris {

std::vector<OwnedElements> assign_owners(int vertex_count, const std::vector<Face>& faces,
                                         const std::vector<MeshEdge>& edges)
{
    std::vector<OwnedElements> owned(faces.size());
    std::vector<char> is_taken(static_cast<std::size_t>(vertex_count), 0);
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (int k = 0; k < 3; ++k) {
            if (is_taken[faces[f][k]]) continue;
            is_taken[faces[f][k]] = 1;
            owned[f].vertices[k] = faces[f][k];
        }
    for (std::size_t e = 0; e < edges.size(); ++e) {
        std::array<int, 3>& own = owned[edges[e].face_left].edges;
        *std::find(own.begin(), own.end(), -1) = static_cast<int>(e);
    }
    return owned;
}

}  // namespace arris
