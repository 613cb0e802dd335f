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

    /// Whether a seam joins a vertex of the first element to one of the second, so that the pair will be none
    /// once the seam is closed.
    bool joins(const std::array<int, 4>& vertices, int first_count) const;

    /// The third vertex of an edge's face.
    int apex(const MeshEdge& edge, int face) const;

    std::vector<Face> faces;
    std::vector<MeshEdge> edges;
    VertexFaces faces_at;
    std::vector<OwnedElements> owned;          ///< by each face
    std::vector<std::array<int, 3>> edges_of;  ///< of each face: the edge from corner k to the next
    /// Vertices that seams join have the same number here, others -1. Empty without open seams.
    std::vector<int> joined = {};
};

}  // namespace arris
