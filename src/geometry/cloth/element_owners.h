// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/cloth/mesh_topology.h"

namespace arris {

/// Vertices and edges that belong to a cloth face; -1 where there are fewer.
struct OwnedElements {
    std::array<int, 3> vertices{-1, -1, -1};
    std::array<int, 3> edges{-1, -1, -1};
};

/// One entry a face. Each vertex belongs to the first of its faces, each edge to its left face, so that every
/// element is visited once through its face.
std::vector<OwnedElements> assign_owners(int vertex_count, const std::vector<Face>& faces,
                                         const std::vector<MeshEdge>& edges);

}  // namespace arris
