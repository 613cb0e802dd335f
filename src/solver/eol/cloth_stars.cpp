// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/eol/cloth_stars.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/cloth/sewing.h"

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
    stars.border_neighbours.assign(mesh.material.size(), {-1, -1});
    if (mesh.has_seams()) {
        stars.next_points.assign(mesh.material.size(), -1);
        for (int p = static_cast<int>(mesh.material.size()) - 1; p >= vertex_count; --p) {
            const int v = mesh.vertex_of(p);
            stars.next_points[p] = std::exchange(stars.next_points[v], p);
        }
    }
    const auto add_border = [&](int p, int q) {
        for (const auto& [at, beside] : {std::pair(p, q), std::pair(q, p)})
            stars.border_neighbours[at][stars.border_neighbours[at][0] < 0 ? 0 : 1] = beside;
    };
    for (const MeshEdge& edge : stars.topology.edges) {
        const bool is_seam = edge.face_right >= 0 && arris::is_seam(mesh, edge);
        if (edge.face_right >= 0 && !is_seam) continue;
        add_border(mesh.point_of(edge.a, edge.face_left), mesh.point_of(edge.b, edge.face_left));
        if (is_seam)
            add_border(mesh.point_of(edge.a, edge.face_right), mesh.point_of(edge.b, edge.face_right));
    }
    return stars;
}

Star look_around(const ClothMesh& mesh, const ClothStars& stars, int vertex,
                 const std::vector<Vec3>& positions)
{
    return look_around(mesh, stars, stars.faces[vertex], vertex, positions);
}

Star look_around(const ClothMesh& mesh, const ClothStars& stars, std::span<const int> faces, int vertex,
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
        const double area = 0.5 * DX.determinant();
        if (point != vertex) DX = find_turn(mesh, stars, point).inverse() * DX;
        const Mat32 F = Dx * DX.inverse();
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

int find_nearest(const ClothStars& stars, std::span<const int> vertices, std::span<const double> weights)
{
    std::size_t best = 0;
    for (std::size_t i = 1; i < vertices.size() && vertices[i] >= 0; ++i) {
        const bool is_off = !stars.is_on_seam(vertices[i]);
        if (is_off == !stars.is_on_seam(vertices[best]) ? weights[i] > weights[best] : is_off) best = i;
    }
    return vertices[best];
}

double material_length(const ClothMesh& mesh, const ClothStars& stars, int a, int b)
{
    const Vec2 from = blend_material(mesh, stars, std::array{a, b}, std::array{1.0, 0.0}),
               to = blend_material(mesh, stars, std::array{a, b}, std::array{0.0, 1.0});
    return (to - from).norm();
}

bool is_border_edge(const ClothMesh& mesh, const ClothStars& stars, int a, int b)
{
    return std::any_of(stars.faces[a].begin(), stars.faces[a].end(), [&](int f) {
        const auto [before, after] = stars.border_neighbours[mesh.point_of(a, f)];
        return (before >= 0 && mesh.vertex_of(before) == b) || (after >= 0 && mesh.vertex_of(after) == b);
    });
}

namespace {

constexpr double kStraight = 0.9;  // cosine: at a corner the border bends by more than 26 degrees

/// Unit direction of the border through a point of the border; zero at a corner.
Vec2 direction_through(const ClothMesh& mesh, const ClothStars& stars, int point)
{
    const auto [a, b] = stars.border_neighbours[point];
    const Vec2 before = (mesh.material[point] - mesh.material[a]).normalized();
    const Vec2 after = (mesh.material[b] - mesh.material[point]).normalized();
    return before.dot(after) < kStraight ? Vec2(Vec2::Zero()) : Vec2((before + after).normalized());
}

/// The points beside this one on the border, in the order of those beside its vertex's first point; nothing
/// where the two are not the two sides of one seam.
std::optional<std::array<int, 2>> beside_as_first(const ClothMesh& mesh, const ClothStars& stars, int point)
{
    const int vertex = mesh.vertex_of(point);
    const auto first = stars.border_neighbours[vertex];
    auto beside = stars.border_neighbours[point];
    const auto is_same = [&](int p, int q) { return mesh.vertex_of(p) == mesh.vertex_of(q); };
    if (!is_same(first[0], beside[0])) std::swap(beside[0], beside[1]);
    if (!is_same(first[0], beside[0]) || !is_same(first[1], beside[1])) return std::nullopt;
    return beside;
}

}  // namespace

Mat2 find_turn(const ClothMesh& mesh, const ClothStars& stars, int point)
{
    const int vertex = mesh.vertex_of(point);
    if (point == vertex) return Mat2::Identity();
    const auto beside = beside_as_first(mesh, stars, point);
    if (!beside) return Mat2::Identity();
    const auto way = [&](const std::array<int, 2>& ends) {
        return Vec2(mesh.material[ends[1]] - mesh.material[ends[0]]);
    };
    return turn_between(way(stars.border_neighbours[vertex]), way(*beside));
}

int find_point_beside(const ClothMesh& mesh, const ClothStars& stars, int vertex, const Vec2& X)
{
    int nearest = vertex;
    for (int p = stars.next_point(vertex); p >= 0; p = stars.next_point(p))
        if ((mesh.material[p] - X).squaredNorm() < (mesh.material[nearest] - X).squaredNorm()) nearest = p;
    return nearest;
}

std::optional<Vec2> find_border(const ClothMesh& mesh, const ClothStars& stars, int vertex)
{
    if (!stars.is_on_border(vertex)) return std::nullopt;
    if (const int other = stars.next_point(vertex); other >= 0) {
        const auto beyond = beside_as_first(mesh, stars, other);
        if (!beyond || stars.next_point(other) >= 0 || direction_through(mesh, stars, other).isZero(0.0))
            return Vec2(Vec2::Zero());
        const auto [a, b] = stars.border_neighbours[vertex];
        const auto length = [&](int p, int q) { return (mesh.material[q] - mesh.material[p]).norm(); };
        if (!has_one_share(length(vertex, a), length(vertex, b), length(other, (*beyond)[0]),
                           length(other, (*beyond)[1])))
            return Vec2(Vec2::Zero());
    }
    return direction_through(mesh, stars, vertex);
}

}  // namespace arris
