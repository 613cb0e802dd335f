// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "geometry/vectors.h"
#include "solver/eol/cloth_stars.h"

namespace arris {

/// Each vertex's unit normal where the faces around the vertex lie in one plane at `positions`: no vertex of
/// them is farther from the plane than `tolerance` times their longest edge, plus round-off. Nothing at other
/// vertices, and where these faces are folded onto one another or have no area. Linear in face count.
std::vector<std::optional<Vec3>> find_plane_stars(const std::vector<Face>& faces, const VertexFaces& stars,
                                                  const std::vector<Vec3>& positions, double tolerance);

/// Whether all vertices of the faces around `vertex` have a normal in `normals`: the cloth is plane as far as
/// the second ring of faces. One ring alone says nothing at a corner with a single face.
bool is_plane_around(int vertex, const std::vector<Face>& faces, const VertexFaces& stars,
                     const std::vector<std::optional<Vec3>>& normals);

}  // namespace arris
