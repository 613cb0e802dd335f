// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/eol/cloth_stars.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace arris {

namespace {

/// The face with `vertex` first.
Face turned_to(const Face& face, int vertex)
{
    const auto at = std::find(face.begin(), face.end(), vertex) - face.begin();
    return {face[at], face[(at + 1) % 3], face[(at + 2) % 3]};
}

bool is_seam(const ClothMesh& mesh, const MeshEdge& edge)
{
    const auto parts_at = [&](int v) {
        return mesh.point_of(v, edge.face_left) != mesh.point_of(v, edge.face_right);
    };
    return parts_at(edge.a) || parts_at(edge.b);
}

}  // namespace

double StarFace::angle() const
{
    return std::atan2(sides.col(0).cross(sides.col(1)).norm(), sides.col(0).dot(sides.col(1)));
}

ClothStars make_stars(const ClothMesh& mesh)
{
    const int vertex_count = mesh.vertex_count();
    ClothStars stars;
    stars.topology = make_topology(vertex_count, mesh.faces);
    stars.faces = VertexFaces(vertex_count, mesh.faces);
    stars.border_neighbours.assign(vertex_count, {-1, -1});
    if (mesh.has_seams()) {
        stars.is_on_seam.assign(vertex_count, 0);
        for (const int v : mesh.seam_vertices) stars.is_on_seam[v] = 1;
    }
    for (const MeshEdge& edge : stars.topology.edges) {
        if (edge.face_right >= 0 && !is_seam(mesh, edge)) continue;
        for (const auto& [v, w] : {std::pair(edge.a, edge.b), std::pair(edge.b, edge.a)})
            stars.border_neighbours[v][stars.border_neighbours[v][0] < 0 ? 0 : 1] = w;
    }
    return stars;
}

Star look_around(const ClothMesh& mesh, std::span<const int> faces, int vertex,
                 const std::vector<Vec3>& positions)
{
    Star star;
    star.faces.reserve(faces.size());
    for (const int f : faces) {
        const Face face = turned_to(mesh.faces[f], vertex);
        const int point = mesh.point_of(vertex, f);
        const Face points = turned_to(mesh.points_of(f), point);
        Mat32 Dx;
        Mat2 DX;
        for (int k = 0; k < 2; ++k) {
            Dx.col(k) = positions[face[k + 1]] - positions[vertex];
            DX.col(k) = mesh.material[points[k + 1]] - mesh.material[point];
        }
        const Vec3 across = Dx.col(0).cross(Dx.col(1));
        if (!(across.norm() > 0.0)) continue;  // collapsed: has no direction
        const Mat32 F = Dx * DX.inverse();
        const double area = 0.5 * DX.determinant();
        star.squared_F += area * F.transpose() * F;
        star.F_transposed += area * F.transpose();
        const FaceSector sector = {Dx.col(0).normalized(), Dx.col(1).normalized()};
        star.faces.push_back({across.normalized(), (sector[0] + sector[1]).stableNormalized(),
                              DX.col(0) + DX.col(1), F, area, sector, Dx});
    }
    return star;
}

Vec2 blend_material(const ClothMesh& mesh, const ClothStars& stars, std::span<const int> vertices,
                    std::span<const double> weights)
{
    int common = -1;  // a face that has them all
    if (mesh.has_seams())
        for (const int f : stars.faces[vertices[0]])
            if (std::all_of(vertices.begin(), vertices.end(), [&](int v) {
                    const Face& face = mesh.faces[f];
                    return v < 0 || std::find(face.begin(), face.end(), v) != face.end();
                }))
                common = f;
    Vec2 X = Vec2::Zero();
    for (std::size_t i = 0; i < vertices.size() && vertices[i] >= 0; ++i)
        X += weights[i] * mesh.material[common < 0 ? vertices[i] : mesh.point_of(vertices[i], common)];
    return X;
}

std::optional<Vec2> find_border(const ClothMesh& mesh, const ClothStars& stars, int vertex)
{
    constexpr double kStraight = 0.9;  // cosine: at a corner the border bends by more than 26 degrees
    const auto [a, b] = stars.border_neighbours[vertex];
    if (a < 0) return std::nullopt;
    if (b < 0) return Vec2(Vec2::Zero());  // the tip of a dart
    if (!stars.is_on_seam.empty() && stars.is_on_seam[vertex])
        return Vec2(Vec2::Zero());  // stays, as a corner
    const Vec2 before = (mesh.material[vertex] - mesh.material[a]).normalized();
    const Vec2 after = (mesh.material[b] - mesh.material[vertex]).normalized();
    return before.dot(after) < kStraight ? Vec2(Vec2::Zero()) : Vec2((before + after).normalized());
}

}  // namespace arris
