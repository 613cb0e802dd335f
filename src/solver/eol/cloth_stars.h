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
    /// By point of the material: the points beside it on the border; -1 within. Seams are such borders.
    std::vector<std::array<int, 2>> border_neighbours;
    std::vector<int> next_points;  ///< by point: the next one of its vertex, or -1; empty without seams

    bool is_on_border(int vertex) const { return border_neighbours[vertex][0] >= 0; }
    bool is_on_seam(int vertex) const { return next_point(vertex) >= 0; }
    int next_point(int point) const { return next_points.empty() ? -1 : next_points[point]; }
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

/// Sums over the faces around a vertex, weighted by their material area A. On a seam the material of all
/// sides is turned to that of the vertex's first point (`find_turn`).
struct Star {
    Mat2 squared_F = Mat2::Zero();                             ///< sum A F^T F
    Eigen::Matrix<double, 2, 3> F_transposed = Mat23::Zero();  ///< sum A F^T
    std::vector<StarFace> faces;
};

/// `positions`: of the cloth, in any frame. Collapsed faces are left out.
Star look_around(const ClothMesh& mesh, const ClothStars& stars, int vertex,
                 const std::vector<Vec3>& positions);
/// As above, of some of the faces at the vertex.
Star look_around(const ClothMesh& mesh, const ClothStars& stars, std::span<const int> faces, int vertex,
                 const std::vector<Vec3>& positions);

/// Map of material directions at the first point of a vertex to those at this one of its points: a flow
/// along a seam has one on each side. The identity but on a seam with two sides.
Mat2 find_turn(const ClothMesh& mesh, const ClothStars& stars, int point);

/// The point of a vertex that is nearest to X in the material: the one on its side of a seam.
int find_point_beside(const ClothMesh& mesh, const ClothStars& stars, int vertex, const Vec2& X);

/// Material coordinates of the point with these weights of up to three vertices that have a face in common. A
/// point of a seam is that on either side.
Vec2 blend_material(const ClothMesh& mesh, const ClothStars& stars, std::span<const int> vertices,
                    std::span<const double> weights);

/// The vertex of greatest weight, if possible one on no seam: all faces around that are of one panel.
int find_nearest(const ClothStars& stars, std::span<const int> vertices, std::span<const double> weights);

/// Length in the material, m, of the edge between two neighbours.
double material_length(const ClothMesh& mesh, const ClothStars& stars, int a, int b);

/// Whether two neighbours have an edge on the border of the material.
bool is_border_edge(const ClothMesh& mesh, const ClothStars& stars, int a, int b);

/// Material direction of the border through a border vertex, unit, at its first point; zero at a corner of
/// the cloth, and where a seam meets another, ends or is eased; nothing at inner vertices.
std::optional<Vec2> find_border(const ClothMesh& mesh, const ClothStars& stars, int vertex);

}  // namespace arris
