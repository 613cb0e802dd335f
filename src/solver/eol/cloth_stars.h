// SPDX-License-Identifier: GPL-3.0-or-later
// How the cloth lies around its vertices.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "geometry/cloth/cloth_cone.h"
#include "geometry/cloth/cloth_mesh.h"
#include "geometry/cloth/mesh_topology.h"

namespace arris {

/// What is around each vertex. Made anew where the mesh changes.
struct ClothStars {
    MeshTopology topology;
    VertexFaces faces;
    std::vector<std::array<int, 2>> border_neighbours;  ///< of a border vertex, ascending; -1 elsewhere
};
ClothStars make_stars(int vertex_count, const std::vector<Face>& faces);

/// A face at a vertex, and what it looks like from there.
struct StarFace {
    Vec3 normal;
    Vec3 leaving;  ///< unit, away from the vertex, halfway between its edges
    Vec2 middle;   ///< material, from the vertex
    Mat32 F;
    double area;  ///< material
    FaceSector sector;
    Mat32 sides;  ///< its edges from the vertex

    double angle() const;  ///< rad
};

/// What tells how the cloth lies around a vertex: by the material area A of its faces.
struct Star {
    Mat2 squared_F = Mat2::Zero();                             ///< sum A F^T F
    Eigen::Matrix<double, 2, 3> F_transposed = Mat23::Zero();  ///< sum A F^T
    std::vector<StarFace> faces;
};

/// `faces`: those at the vertex. `positions`: of the cloth, in any frame.
Star look_around(const ClothMesh& mesh, std::span<const int> faces, int vertex,
                 const std::vector<Vec3>& positions);

/// The border's direction through a border vertex, material, unit; nothing elsewhere, and at a corner of the
/// cloth zero.
std::optional<Vec2> find_border(const ClothMesh& mesh, const ClothStars& stars, int vertex);

}  // namespace arris
