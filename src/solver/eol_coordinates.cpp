// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/eol_coordinates.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace arris {

namespace {

const double kSin20 = std::sin(20.0 * M_PI / 180.0);
const double kCos10 = std::cos(10.0 * M_PI / 180.0);
const double kSin10 = std::sin(10.0 * M_PI / 180.0);

/// A face of the star with `vertex` first.
Face turned_to(const Face& face, int vertex)
{
    const auto at = std::find(face.begin(), face.end(), vertex) - face.begin();
    return {face[at], face[(at + 1) % 3], face[(at + 2) % 3]};
}

/// Sums over the star: what tells how the cloth lies around a vertex.
struct Star {
    ClothAround cloth;
    Mat2 squared_F = Mat2::Zero();                             ///< sum A F^T F
    Eigen::Matrix<double, 2, 3> F_transposed = Mat23::Zero();  ///< sum A F^T
    std::vector<Vec3> normals;
    std::vector<Mat32> deformations;  ///< F, and
    std::vector<double> areas;        ///< material, of the faces
};

Star look_around(const State& state, const std::vector<int>& faces, int vertex,
                 const std::vector<Vec3>& positions, const Vec3& tangent, const Vec3& side)
{
    Star star;
    star.cloth = {Vec3::Zero(), Vec3::Zero(), side};
    for (const int f : faces) {
        const Face face = turned_to(state.mesh.faces[f], vertex);
        Mat32 Dx;
        Mat2 DX;
        for (int k = 0; k < 2; ++k) {
            Dx.col(k) = positions[face[k + 1]] - positions[vertex];
            DX.col(k) = state.mesh.material[face[k + 1]] - state.mesh.material[vertex];
        }
        const Vec3 across = Dx.col(0).cross(Dx.col(1));
        if (!(across.norm() > 0.0)) continue;  // collapsed: tells no direction
        const Mat32 F = Dx * DX.inverse();
        const double area = 0.5 * DX.determinant();
        star.deformations.push_back(F);
        star.areas.push_back(area);
        star.squared_F += area * F.transpose() * F;
        star.F_transposed += area * F.transpose();
        star.normals.push_back(across.normalized());
        star.cloth.normal += star.normals.back();
        Vec3 leaving = Dx.col(0) + Dx.col(1);
        leaving -= tangent.dot(leaving) * tangent;
        if (leaving.norm() > 0.0) star.cloth.leaving += leaving.normalized();
    }
    return star;
}

Vec2 perpendicular(const Vec2& v)
{
    return Vec2(v.y(), -v.x()).normalized();
}

/// Material direction of the feature through the vertex: along the cloth's edges that lie on it, else what F
/// maps nearest to the tangent.
Vec2 find_trace(const Obstacle& obstacle, const State& state, int entry, int vertex,
                const std::vector<int>& faces, const Star& star, const Vec3& tangent)
{
    Vec2 along = Vec2::Zero();
    std::vector<int> seen;
    const Vec2 estimate = star.squared_F.inverse() * (star.F_transposed * tangent);
    for (const int f : faces)
        for (const int w : state.mesh.faces[f]) {
            if (w == vertex || std::find(seen.begin(), seen.end(), w) != seen.end()) continue;
            seen.push_back(w);
            const int other = state.eol_entry(state.ids[w]);
            if (other < 0 || !is_trace_edge(obstacle, state.eol[entry], state.eol[other])) continue;
            const Vec2 way = state.mesh.material[w] - state.mesh.material[vertex];
            along += way.dot(estimate) >= 0.0 ? way : Vec2(-way);
        }
    return along.norm() > 0.0 ? along.normalized() : estimate.normalized();
}

/// The border's direction through a border vertex; nothing elsewhere, and at a corner of the cloth zero.
std::optional<Vec2> find_border(const State& state, const ClothStars& stars, int vertex)
{
    constexpr double kStraight = 0.9;  // cosine: a corner of the cloth turns by more than 26 degrees
    const auto [a, b] = stars.border_neighbours[vertex];
    if (a < 0) return std::nullopt;
    const Vec2 before = (state.mesh.material[vertex] - state.mesh.material[a]).normalized();
    const Vec2 after = (state.mesh.material[b] - state.mesh.material[vertex]).normalized();
    return before.dot(after) < kStraight ? Vec2(Vec2::Zero()) : Vec2((before + after).normalized());
}

/// Where the cloth neither turns nor spreads across the outward direction, flow and world coincide.
bool is_edge_on(const Star& star, const Vec3& outward)
{
    Vec3 mean = Vec3::Zero();
    for (const Vec3& n : star.normals) mean += n;
    if (!(mean.norm() > 0.0)) return false;
    mean.normalize();
    const bool is_flat = std::all_of(star.normals.begin(), star.normals.end(),
                                     [&](const Vec3& n) { return n.dot(mean) > kCos10; });
    return is_flat && std::abs(mean.dot(outward)) < kSin10;
}

/// Away from the feature the vertex moves cloth, along and across it more or less of the same: c alone would
/// stretch what beside it the flow has still to bring.
Vec3 find_opening(const Star& star, const Mat3& basis, const Mat23& material_basis)
{
    Mat3 inertia = Mat3::Zero();
    for (std::size_t f = 0; f < star.areas.size(); ++f) {
        const Mat3 G = basis - star.deformations[f] * material_basis;
        inertia += star.areas[f] * G.transpose() * G;
    }
    const Vec3 response = inertia.inverse().col(0);
    return response / response[0];
}

/// From the obstacle's frame to the world.
EolPlacing finish(const Star& star, const Placement& end, EolCoordinates at)
{
    at.opening = find_opening(star, at.basis, at.material_basis);
    if (!at.opening.allFinite()) return {std::nullopt, EolRefusal::EdgeOn};
    at.basis = end.rotation * at.basis;
    return {at, {}};
}

}  // namespace

ClothStars make_stars(int vertex_count, const std::vector<Face>& faces, const std::vector<MeshEdge>& edges)
{
    ClothStars stars;
    stars.faces = faces_at_vertices(vertex_count, faces);
    stars.border_neighbours.assign(vertex_count, {-1, -1});
    for (const MeshEdge& edge : edges) {
        if (edge.face_right >= 0) continue;
        for (const auto& [v, w] : {std::pair(edge.a, edge.b), std::pair(edge.b, edge.a)})
            stars.border_neighbours[v][stars.border_neighbours[v][0] < 0 ? 0 : 1] = w;
    }
    return stars;
}

bool is_trace_edge(const Obstacle& obstacle, const EolVertex& a, const EolVertex& b)
{
    if (a.obstacle != b.obstacle) return false;
    if (!a.is_corner && !b.is_corner) return a.feature == b.feature;
    const ObstacleFeatures& features = obstacle.features();
    const auto ends_at = [&](const FeatureEdge& edge, const EolVertex& corner) {
        const auto& ends = obstacle.topology().edges[edge.edge].points;
        const int point = features.corners[corner.feature].point;
        return ends[0] == point || ends[1] == point;
    };
    if (a.is_corner && b.is_corner)
        return std::any_of(features.edges.begin(), features.edges.end(),
                           [&](const FeatureEdge& e) { return ends_at(e, a) && ends_at(e, b); });
    return a.is_corner ? ends_at(features.edges[b.feature], a) : ends_at(features.edges[a.feature], b);
}

EolPlacing place_eol_vertex(const Obstacle& obstacle, const State& state, int entry, const ClothStars& stars,
                            const std::vector<Vec3>& positions, const Placement& end)
{
    const EolVertex& eol = state.eol[entry];
    const int v = state.index_of(eol.vertex_id);
    const Vec3& place = positions[v];
    const std::optional<Vec2> border = find_border(state, stars, v);
    if (border && border->isZero()) return {std::nullopt, EolRefusal::ClothCorner};
    if (border && eol.is_corner) return {std::nullopt, EolRefusal::AlongBorder};

    Vec3 tangent = Vec3::Zero();
    if (!eol.is_corner) {
        const auto& ends = obstacle.topology().edges[obstacle.features().edges[eol.feature].edge].points;
        tangent = (obstacle.mesh().points[ends[1]] - obstacle.mesh().points[ends[0]]).normalized();
    }
    const Star star = look_around(state, stars.faces[v], v, positions, tangent, eol.outward);
    const std::optional<FeatureFrame> frame =
        eol.is_corner ? find_corner_frame(obstacle, eol.feature, place, star.cloth)
                      : find_edge_frame(obstacle, eol.feature, place, star.cloth);
    if (!frame) return {std::nullopt, EolRefusal::NoDirection};
    if (is_edge_on(star, frame->outward)) return {std::nullopt, EolRefusal::EdgeOn};

    EolCoordinates at{v, entry, *frame, end(place), Mat3::Zero(), Mat23::Zero(), Vec3::UnitX()};
    at.basis.col(0) = frame->outward;
    at.basis.col(1) = frame->tangent;
    if (eol.is_corner) {
        at.material_basis.col(1) = Vec2::UnitX();
        at.material_basis.col(2) = Vec2::UnitY();
        return finish(star, end, at);
    }
    const Vec2 trace = find_trace(obstacle, state, entry, v, stars.faces[v], star, tangent);
    if (!trace.allFinite()) return {std::nullopt, EolRefusal::NoDirection};
    if (border && std::abs(border->x() * trace.y() - border->y() * trace.x()) < kSin20)
        return {std::nullopt, EolRefusal::AlongBorder};
    at.material_basis.col(2) = border ? *border : perpendicular(trace);
    return finish(star, end, at);
}

}  // namespace arris
