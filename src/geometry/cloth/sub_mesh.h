// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/cloth/cloth_mesh.h"

namespace arris {

/// Some faces of a mesh as a mesh of their own.
struct SubMesh {
    ClothMesh mesh;             ///< vertices in the order of their first use by the faces
    std::vector<int> vertices;  ///< index in the whole mesh of each vertex of `mesh`
};

/// Extracts the faces with the indices `faces`, in this order. The cost depends on their number, not on the
/// size of `whole`.
SubMesh extract_faces(const ClothMesh& whole, const std::vector<int>& faces);

}  // namespace arris
