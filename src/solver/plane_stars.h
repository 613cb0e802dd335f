// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/cloth/cloth_mesh.h"
#include "geometry/cloth/mesh_topology.h"
#include "geometry/vectors.h"

namespace arris {

/// Unit normal of the faces around `vertex` where they lie in one plane at `positions`: no vertex of them is
/// farther from the plane than `tolerance` times their longest edge, plus round-off. Nothing elsewhere, and
/// where these faces are folded onto one another or have no area.
std::optional<Vec3> find_plane_normal(int vertex, const std::vector<Face>& faces, const VertexFaces& stars,
                                      const std::vector<Vec3>& positions, double tolerance);

/// Answers for single vertices whether the cloth is plane there. Computes each vertex's normal once, when it
/// is first needed; without a question nothing is computed or allocated. All arguments outlive it.
class PlaneStars {
  public:
    using FindNormal = std::function<std::optional<Vec3>(int vertex)>;

    /// `find` gives a vertex's normal where the faces around the vertex count as plane.
    PlaneStars(const std::vector<Face>& faces, const VertexFaces& stars, int vertex_count, FindNormal find)
        : faces_(faces), stars_(stars), vertex_count_(vertex_count), find_(std::move(find))
    {
    }

    const std::optional<Vec3>& normal(int vertex);

    /// Whether all vertices of the faces around `vertex` have a normal: the cloth is plane as far as the
    /// second ring of faces. One ring alone says nothing at a corner with a single face.
    bool is_plane_around(int vertex);

  private:
    const std::vector<Face>& faces_;
    const VertexFaces& stars_;
    int vertex_count_;
    FindNormal find_;
    std::vector<char> is_known_;
    std::vector<std::optional<Vec3>> normals_;
};

}  // namespace arris
