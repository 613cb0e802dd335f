// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle/obstacle_topology.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <tuple>

#include "geometry/cgal.h"
#include "geometry/sort_unique.h"

namespace arris {
namespace {

/// A side of a triangle: its two points in ascending order, its face and corner index, and whether the face
/// runs from the lower point to the higher.
struct Side {
    std::array<int, 2> points;
    int face, corner;
    bool is_ascending;
};

std::vector<Side> sort_sides(const std::vector<Face>& faces)
{
    std::vector<Side> sides;
    sides.reserve(3 * faces.size());
    for (int f = 0; f < static_cast<int>(faces.size()); ++f)
        for (int i = 0; i < 3; ++i) {
            const int a = faces[f][i], b = faces[f][(i + 1) % 3];
            sides.push_back({{std::min(a, b), std::max(a, b)}, f, i, a < b});
        }
    std::sort(sides.begin(), sides.end(), [](const Side& s, const Side& t) {
        return std::tie(s.points, s.face) < std::tie(t.points, t.face);
    });
    return sides;
}

void make_edges(const ObstacleMesh& mesh, ObstacleTopology& topology)
{
    topology.face_edges.resize(mesh.faces.size());
    for (const Side& side : sort_sides(mesh.faces)) {
        if (topology.edges.empty() || topology.edges.back().points != side.points)
            topology.edges.push_back({side.points, {side.face, -1}});
        else
            topology.edges.back().faces[1] = side.face;
        topology.face_edges[side.face][side.corner] = static_cast<int>(topology.edges.size()) - 1;
    }
    topology.surface_edge_count = static_cast<int>(topology.edges.size());
    for (const std::array<int, 2>& s : mesh.segments)
        topology.edges.push_back({{std::min(s[0], s[1]), std::max(s[0], s[1])}, {-1, -1}});
}

void make_point_edges(const ObstacleMesh& mesh, ObstacleTopology& topology)
{
    topology.first_edge.assign(mesh.points.size() + 1, 0);
    for (const ObstacleEdge& edge : topology.edges)
        for (const int p : edge.points) ++topology.first_edge[p + 1];
    for (std::size_t p = 0; p < mesh.points.size(); ++p) topology.first_edge[p + 1] += topology.first_edge[p];
    topology.point_edges.resize(2 * topology.edges.size());
    std::vector<int> next(topology.first_edge.begin(), topology.first_edge.end() - 1);
    for (int e = 0; e < static_cast<int>(topology.edges.size()); ++e)
        for (const int p : topology.edges[e].points) topology.point_edges[next[p]++] = e;
}

/// Normalises the sides before the cross product, so that slivers far from the origin keep their direction.
Vec3 face_normal(const Vec3& a, const Vec3& b, const Vec3& c)
{
    return (b - a).stableNormalized().cross((c - a).stableNormalized()).stableNormalized();
}

void make_components(const ObstacleMesh& mesh, ObstacleTopology& topology)
{
    const int count = static_cast<int>(mesh.faces.size());
    topology.component.assign(mesh.faces.size(), -1);
    for (int seed = 0; seed < count; ++seed) {
        if (topology.component[seed] >= 0) continue;
        label_connected(
            topology, seed, static_cast<int>(topology.is_solid.size()), [](int) { return true; },
            topology.component);
        topology.is_solid.push_back(1);
    }
    for (int f = 0; f < count; ++f)
        for (int i = 0; i < 3; ++i)
            if (topology.neighbour(f, i) < 0) topology.is_solid[topology.component[f]] = 0;
}

std::string find_bad_index(const ObstacleMesh& mesh)
{
    const int n = static_cast<int>(mesh.points.size());
    const auto is_point = [n](int p) { return p >= 0 && p < n; };
    for (std::size_t p = 0; p < mesh.points.size(); ++p)
        if (!mesh.points[p].allFinite()) return fmt::format("point {} is not finite", p);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        if (!std::all_of(mesh.faces[f].begin(), mesh.faces[f].end(), is_point))
            return fmt::format("face {} names a point that is not there", f);
    for (std::size_t s = 0; s < mesh.segments.size(); ++s)
        if (!std::all_of(mesh.segments[s].begin(), mesh.segments[s].end(), is_point))
            return fmt::format("segment {} names a point that is not there", s);
    for (std::size_t p = 0; p < mesh.lone_points.size(); ++p)
        if (!is_point(mesh.lone_points[p]))
            return fmt::format("lone point {} names a point that is not there", p);
    return {};
}

std::string find_degenerate(const ObstacleMesh& mesh)
{
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const auto& [a, b, c] = mesh.faces[f];
        if (CGAL::collinear(to_cgal(mesh.points[a]), to_cgal(mesh.points[b]), to_cgal(mesh.points[c])))
            return fmt::format("face {} has no area", f);
    }
    for (std::size_t s = 0; s < mesh.segments.size(); ++s)
        if (mesh.points[mesh.segments[s][0]] == mesh.points[mesh.segments[s][1]])
            return fmt::format("segment {} has no length", s);
    return {};
}

}  // namespace

std::vector<int> ObstacleTopology::faces_at(int point) const
{
    std::vector<int> faces;
    for (int k = 0; k < edge_count_at(point); ++k)
        for (const int f : edges[edge_at(point, k)].faces)
            if (f >= 0) faces.push_back(f);
    sort_unique(faces);
    return faces;
}

ObstacleTopology make_topology(const ObstacleMesh& mesh)
{
    ObstacleTopology topology;
    make_edges(mesh, topology);
    make_point_edges(mesh, topology);
    update_normals(mesh, topology);
    make_components(mesh, topology);
    return topology;
}

void update_normals(const ObstacleMesh& mesh, ObstacleTopology& topology)
{
    topology.face_normals.clear();
    for (const auto& [a, b, c] : mesh.faces)
        topology.face_normals.push_back(face_normal(mesh.points[a], mesh.points[b], mesh.points[c]));
}

std::string validate(const ObstacleMesh& mesh)
{
    if (std::string wrong = find_bad_index(mesh); !wrong.empty()) return wrong;
    if (std::string wrong = find_degenerate(mesh); !wrong.empty()) return wrong;
    const std::vector<Side> sides = sort_sides(mesh.faces);
    for (std::size_t i = 1; i < sides.size(); ++i) {
        if (sides[i].points != sides[i - 1].points) continue;
        const std::string edge = fmt::format("edge ({}, {})", sides[i].points[0], sides[i].points[1]);
        if (sides[i].is_ascending == sides[i - 1].is_ascending)
            return fmt::format("faces {} and {} run the same way along {}", sides[i - 1].face, sides[i].face,
                               edge);
        if (i > 1 && sides[i - 2].points == sides[i].points)
            return fmt::format("more than two faces at {}", edge);
    }
    return {};
}

}  // namespace arris
