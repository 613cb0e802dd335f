// SPDX-License-Identifier: GPL-3.0-or-later
// Geometry of the cloth around its vertices.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "geometry/cloth/cloth_cone.h"
#include "geometry/cloth/cloth_mesh.h"
#include "geometry/cloth/mesh_topology.h"

namespace arris {

/// Neighbourhoods of all vertices. Rebuilt where the mesh changes.
struct ClothStars {
    MeshTopology topology;
    VertexFaces faces;
    /// For a vertex on the border of the material, ascending; else -1. Seams are such borders.
    std::vector<std::array<int, 2>> border_neighbours;
    std::vector<char> is_on_seam;  ///< by vertex; empty without seams
};
ClothStars make_stars(const ClothMesh& mesh);

/// A face at a vertex, relative to that vertex.
struct StarFace {
    Vec3 normal;
    Vec3 leaving;  ///< unit, world, away from the vertex, halfway between its edges
    Vec2 middle;   ///< twice the way from the vertex to the opposite edge's middle, material
    Mat32 F;
    double area;  ///< material
    FaceSector sector;
    Mat32 sides;  ///< its two edges from the vertex

    double angle() const;  ///< rad
};

/// Sums over the faces around a vertex, weighted by their material area A.
struct Star {
    Mat2 squared_F = Mat2::Zero();                             ///< sum A F^T F
    Eigen::Matrix<double, 2, 3> F_transposed = Mat23::Zero();  ///< sum A F^T
    std::vector<StarFace> faces;
};

/// `faces`: the faces at the vertex. `positions`: of the cloth, in any frame. Collapsed faces are left out.
Star look_around(const ClothMesh& mesh, std::span<const int> faces, int vertex,
                 const std::vector<Vec3>& positions);

/// Material coordinates of the point with these weights of up to three vertices that have a face in common. A
/// point of a seam is that on either side.
Vec2 blend_material(const ClothMesh& mesh, const ClothStars& stars, std::span<const int> vertices,
                    std::span<const double> weights);

/// Material direction of the border through a border vertex, unit; zero at a corner of the cloth; nothing at
/// inner vertices.
std::optional<Vec2> find_border(const ClothMesh& mesh, const ClothStars& stars, int vertex);

}  // namespace arris
