// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth/mesh_topology.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <numeric>

#include "geometry/cgal.h"

namespace arris {
namespace {

// One side of a face: from corner `corner` to the next. `low` < `high` are its vertices.
struct Side {
    std::uint64_t key;  // sort key among sides of one `low`: `high`, forward before backward, face
    int low, corner;

    int high() const { return static_cast<int>(key >> 32); }
    bool is_forward() const { return (key & kBackward) == 0; }  // runs from low to high
    int face() const { return static_cast<int>(key & (kBackward - 1)); }

    static constexpr std::uint64_t kBackward = std::uint64_t{1} << 31;
};

Side make_side(const Face& face, int f, int corner)
{
    const int a = face[corner], b = face[(corner + 1) % 3];
    const std::uint64_t high = static_cast<std::uint64_t>(std::max(a, b));
    return {high << 32 | (a < b ? 0 : Side::kBackward) | static_cast<std::uint64_t>(f), std::min(a, b),
            corner};
}

// All sides, ordered by `low`, then `high`. Among the sides of one edge, forward ones come first.
std::vector<Side> sorted_sides(int vertex_count, const std::vector<Face>& faces)
{
    // Bucket sort by `low`, then a sort of each vertex's few sides.
    std::vector<std::size_t> next(static_cast<std::size_t>(vertex_count) + 1, 0);
    const auto low_of = [](const Face& face, int k) { return std::min(face[k], face[(k + 1) % 3]); };
    for (const Face& face : faces)
        for (int k = 0; k < 3; ++k) ++next[low_of(face, k) + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    std::vector<Side> sides(3 * faces.size());
    for (int f = 0; f < static_cast<int>(faces.size()); ++f) {
        for (int k = 0; k < 3; ++k) {
            const Side side = make_side(faces[f], f, k);
            sides[next[side.low]++] = side;
        }
    }
    std::size_t begin = 0;  // next[v] is now the end of vertex v's sides
    for (int v = 0; v < vertex_count; begin = next[v++])
        std::sort(sides.begin() + static_cast<std::ptrdiff_t>(begin),
                  sides.begin() + static_cast<std::ptrdiff_t>(next[v]),
                  [&](const Side& s, const Side& t) { return s.key < t.key; });
    return sides;
}

bool same_edge(const Side& s, const Side& t)
{
    return s.low == t.low && s.high() == t.high();
}

// Numbers by which messages name vertices and faces.
struct Names {
    const ElementNumbers& numbers;

    int vertex(int v) const { return numbers.vertices.empty() ? v : numbers.vertices[v]; }
    int face(int f) const { return numbers.faces.empty() ? f : numbers.faces[f]; }
};

int opposite_vertex(const std::vector<Face>& faces, const Side& side)
{
    return faces[side.face()][(side.corner + 2) % 3];
}

/// Points of faces against their vertices.
std::string find_bad_point(const ClothMesh& mesh, const Names& names)
{
    if (mesh.face_points.size() != mesh.faces.size())
        return fmt::format("{} faces but {} faces of points", mesh.faces.size(), mesh.face_points.size());
    for (const int v : mesh.seam_vertices)
        if (v < 0 || v >= mesh.vertex_count()) return fmt::format("a point is of vertex {}", v);
    std::vector<char> is_used(mesh.material.size(), 0);
    for (int f = 0; f < mesh.face_count(); ++f)
        for (int k = 0; k < 3; ++k) {
            const int point = mesh.face_points[f][k];
            if (point < 0 || point >= static_cast<int>(mesh.material.size()) ||
                mesh.vertex_of(point) != mesh.faces[f][k])
                return fmt::format("face {} has a point of another vertex", names.face(f));
            is_used[point] = 1;
        }
    for (std::size_t p = 0; p < is_used.size(); ++p)
        if (is_used[p] == 0)
            return fmt::format("a point of vertex {} belongs to no face",
                               names.vertex(mesh.vertex_of(static_cast<int>(p))));
    return {};
}

std::string find_bad_index(const ClothMesh& mesh, const Names& names)
{
    const int n = mesh.vertex_count();
    if (mesh.material.size() != mesh.world.size() + mesh.seam_vertices.size())
        return fmt::format("{} material but {} world coordinates", mesh.material.size(), mesh.world.size());
    std::vector<char> is_used(mesh.world.size(), 0);
    for (int f = 0; f < mesh.face_count(); ++f) {
        const Face& face = mesh.faces[f];
        for (const int v : face) {
            if (v < 0 || v >= n) return fmt::format("face {} names vertex {} of {}", names.face(f), v, n);
            is_used[v] = 1;
        }
        if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0])
            return fmt::format("face {} names a vertex twice ({}, {}, {})", names.face(f),
                               names.vertex(face[0]), names.vertex(face[1]), names.vertex(face[2]));
    }
    for (int v = 0; v < n; ++v)
        if (is_used[v] == 0) return fmt::format("vertex {} belongs to no face", names.vertex(v));
    return mesh.has_seams() || !mesh.seam_vertices.empty() ? find_bad_point(mesh, names) : "";
}

std::string find_bad_coordinate(const ClothMesh& mesh, const Names& names)
{
    for (int p = 0; p < static_cast<int>(mesh.material.size()); ++p)
        if (const Vec2& X = mesh.material[p]; !X.allFinite())
            return fmt::format("vertex {} has material coordinates ({}, {})", names.vertex(mesh.vertex_of(p)),
                               X.x(), X.y());
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Vec3& x = mesh.world[v];
        if (!x.allFinite())
            return fmt::format("vertex {} is at ({}, {}, {})", names.vertex(v), x.x(), x.y(), x.z());
    }
    return {};
}

std::string find_bad_edge(const std::vector<Side>& sides, const Names& names)
{
    for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
        const Side& s = sides[i];
        const Side& t = sides[i + 1];
        if (!same_edge(s, t)) continue;
        if (i + 2 < sides.size() && same_edge(s, sides[i + 2]))
            return fmt::format("edge ({}, {}) has more than two faces ({}, {}, {})", names.vertex(s.low),
                               names.vertex(s.high()), names.face(s.face()), names.face(t.face()),
                               names.face(sides[i + 2].face()));
        if (s.is_forward() == t.is_forward())
            return fmt::format("faces {} and {} run along edge ({}, {}) the same way", names.face(s.face()),
                               names.face(t.face()), names.vertex(s.low), names.vertex(s.high()));
    }
    return {};
}

// The faces around a vertex must form one fan. Corners joined through the edges at the vertex form one set
// (union-find); each vertex must have a single set.
std::string find_bow_tie(const ClothMesh& mesh, const std::vector<Side>& sides, const Names& names)
{
    std::vector<int> parent(3 * mesh.faces.size());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](int c) {
        while (parent[c] != c) c = parent[c] = parent[parent[c]];
        return c;
    };
    for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
        const Side& s = sides[i];
        const Side& t = sides[i + 1];
        if (!same_edge(s, t)) continue;
        // s and t run in opposite directions: t ends where s starts.
        parent[root(3 * s.face() + s.corner)] = root(3 * t.face() + (t.corner + 1) % 3);
        parent[root(3 * s.face() + (s.corner + 1) % 3)] = root(3 * t.face() + t.corner);
    }
    std::vector<int> fan(mesh.world.size(), -1);
    for (int c = 0; c < static_cast<int>(parent.size()); ++c) {
        const int v = mesh.faces[c / 3][c % 3];
        if (fan[v] < 0) fan[v] = root(c);
        if (fan[v] == root(c)) continue;
        const int one = names.face(fan[v] / 3), other = names.face(c / 3);
        return fmt::format(
            "vertex {} joins parts of the cloth in a single point, where {}; allowed: parts that share an "
            "edge, or "
            "that are apart, each with a vertex of its own",
            names.vertex(v),
            one == other ? fmt::format("the polygon of face {} touches itself", one)
                         : fmt::format("faces {} and {} meet", one, other));
    }
    return {};
}

std::string find_bad_orientation(const ClothMesh& mesh, const Names& names)
{
    for (int f = 0; f < mesh.face_count(); ++f) {
        const auto [a, b, c] = mesh.corners(f);
        const int turn = exact_orientation(a, b, c);
        if (turn < 0) return fmt::format("face {} is clockwise in material space", names.face(f));
        if (turn == 0) return fmt::format("face {} has no material area", names.face(f));
    }
    return {};
}

}  // namespace

MeshTopology make_topology(int vertex_count, const std::vector<Face>& faces)
{
    MeshTopology topology;
    topology.is_border.assign(vertex_count, 0);
    const std::vector<Side> sides = sorted_sides(vertex_count, faces);
    topology.edges.reserve(sides.size() / 2);
    topology.hinges.reserve(sides.size() / 2);
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const Side& s = sides[i];
        if (i + 1 == sides.size() || !same_edge(s, sides[i + 1])) {
            topology.edges.push_back({s.low, s.high(), s.face(), -1});
            topology.is_border[s.low] = topology.is_border[s.high()] = 1;
            continue;
        }
        const Side& t = sides[++i];
        assert(s.is_forward() && !t.is_forward() && "faces must form an oriented manifold");
        topology.edges.push_back({s.low, s.high(), s.face(), t.face()});
        topology.hinges.push_back(
            {s.low, s.high(), opposite_vertex(faces, s), opposite_vertex(faces, t), s.face(), t.face()});
    }
    return topology;
}

VertexFaces::VertexFaces(int vertex_count, const std::vector<Face>& faces)
    : begin_(static_cast<std::size_t>(vertex_count) + 1, 0), faces_(3 * faces.size())
{
    for (const Face& face : faces)
        for (const int v : face) ++begin_[v + 1];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    std::vector<int> next(begin_.begin(), begin_.end() - 1);
    for (int f = 0; f < static_cast<int>(faces.size()); ++f)
        for (const int v : faces[f]) faces_[next[v]++] = f;
}

std::string validate(const ClothMesh& mesh, const ElementNumbers& numbers)
{
    const Names names{numbers};
    if (std::string wrong = find_bad_index(mesh, names); !wrong.empty()) return wrong;
    if (std::string wrong = find_bad_coordinate(mesh, names); !wrong.empty()) return wrong;
    const std::vector<Side> sides = sorted_sides(mesh.vertex_count(), mesh.faces);
    if (std::string wrong = find_bad_edge(sides, names); !wrong.empty()) return wrong;
    if (std::string wrong = find_bow_tie(mesh, sides, names); !wrong.empty()) return wrong;
    return find_bad_orientation(mesh, names);
}

}  // namespace arris
