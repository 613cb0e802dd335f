// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/cloth/cloth_mesh.h"

namespace arris {

/// Some faces of a mesh as a mesh of their own.
struct SubMesh {
    ClothMesh mesh;             ///< vertices in the order in which the faces name them first
    std::vector<int> vertices;  ///< of the whole mesh: which each of them is
};

/// `faces` (indices) of `whole`, in their order. Costs what the part does, whatever the whole is.
SubMesh extract_faces(const ClothMesh& whole, const std::vector<int>& faces);

}  // namespace arris
