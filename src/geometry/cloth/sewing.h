// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/cloth/cloth_mesh.h"

namespace arris {

/// Sews a mesh, in which every point is a vertex, together: points with the same `vertex_of` become one
/// vertex, where the first of them is. Vertices are numbered from 0 in the order of their first points.
/// Returned as it is where no vertex has several points.
ClothMesh sew(ClothMesh parts, const std::vector<int>& vertex_of);

/// The mesh with every point a vertex: what is sewn is apart, its points in their order.
ClothMesh unsew(ClothMesh mesh);

/// Whether a point divides both sides of a seam in the same share: `before` and `after` it, m, on one side,
/// and `other_before` and `other_after` on the other. Within what a file's rounding leaves open.
bool has_one_share(double before, double after, double other_before, double other_after);

/// One mesh of several, which stay apart.
ClothMesh join(const std::vector<ClothMesh>& meshes);

}  // namespace arris
