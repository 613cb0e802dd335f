// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/cloth/element_owners.h"
#include "geometry/cloth/mesh_topology.h"

namespace arris {

/// Connectivity of a cloth, as contact with itself needs it.
struct SelfSurface {
    SelfSurface() = default;
    SelfSurface(int vertex_count, const std::vector<Face>& faces, const MeshTopology& topology);

    /// The third vertex of an edge's face.
    int apex(const MeshEdge& edge, int face) const;

    std::vector<Face> faces;
    std::vector<MeshEdge> edges;
    VertexFaces faces_at;
    std::vector<OwnedElements> owned;          ///< by each face
    std::vector<std::array<int, 3>> edges_of;  ///< of each face: the edge from corner k to the next
};

}  // namespace arris
