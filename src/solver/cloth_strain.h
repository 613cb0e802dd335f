// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <vector>

#include "geometry/cloth/cloth_mesh.h"
#include "geometry/cloth/mesh_topology.h"
#include "physics/elements/materials.h"

namespace arris {

/// A principal strain, stretch - 1, around a vertex: the mean over the vertex's faces, weighted by their area
/// of material. Around a vertex that flows towards an edge of its mesh a face becomes very thin for a step,
/// and its own strain says nothing about the cloth. No vertex where there is no strain.
struct VertexStrain {
    double strain = 0.0;
    int vertex = -1;
};

/// The extreme strains of a cloth at one moment.
struct ClothStrain {
    VertexStrain stretch;      ///< the greatest principal strain, > 0
    VertexStrain compression;  ///< the least principal strain, < 0
    VertexStrain in_plane;     ///< the greatest compression, < 0, around a vertex under compressive tension
                               ///< whose surroundings lie in a plane: real cloth would fold there

    /// Size of the greatest principal strain, stretch or compression.
    double greatest() const { return std::max(stretch.strain, -compression.strain); }
};

/// Linear in face count. `stretches` are the principal stretches of the faces of `mesh`, and `stars` the
/// faces at its vertices.
ClothStrain measure_cloth_strain(const Materials& materials, const std::vector<Vec2>& stretches,
                                 const ClothMesh& mesh, const VertexFaces& stars);

}  // namespace arris
