// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/cloth/cloth_mesh.h"

namespace arris {

/// The vertex of each of `point_count` points when pairs of points become one vertex, as `sew` needs it:
/// vertices are numbered from 0 in the order of their first points. A point may be in several pairs.
std::vector<int> number_vertices(int point_count, const std::vector<std::array<int, 2>>& pairs);

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
