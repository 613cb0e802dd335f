// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/unstructured.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/cloth_input/angle_relaxation.h"
#include "geometry/cloth_input/delaunay.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

// Largest side of the refinement, relative to the length aimed at: makes the mean side that length, within
// 10 % (cloth_grid_test.cpp).
constexpr double kLargestSide = 1.5;
constexpr double kLargestRelaxed = 1.45;  // the vertices' moves make some sides longer

// The lines, with vertices about `side` apart.
PlanarGraph divide(const MeshLines& lines, double side)
{
    PlanarGraph graph{lines.nodes, {}, {}};
    std::size_t border_end = 0;
    for (std::size_t s = 0; s < lines.segments.size(); ++s) {
        const auto [a, b] = lines.segments[s];
        const Vec2 d = lines.nodes[b] - lines.nodes[a];
        const int pieces = std::max(1, static_cast<int>(std::lround(d.norm() / side)));
        int last = a;
        for (int k = 1; k < pieces; ++k) {
            graph.points.push_back(lines.nodes[a] + d * (double(k) / pieces));
            graph.edges.push_back({last, static_cast<int>(graph.points.size()) - 1});
            last = graph.edges.back()[1];
        }
        graph.edges.push_back({last, b});
        if (s < static_cast<std::size_t>(lines.border_count)) border_end = graph.edges.size();
    }
    for (std::size_t e = 0; e < border_end; ++e)
        graph.outside.push_back({graph.edges[e][1], graph.edges[e][0]});
    return graph;
}

RefinedTriangulation refine_graph(const PlanarGraph& graph, double largest_side, double shortest_side)
{
    const RefinedTriangulation refined =
        refine(graph, largest_side, {static_cast<std::size_t>(kMostGridVertices), shortest_side});
    if (refined.is_complete) return refined;
    throw InputError(fmt::format(
        "around ({:.6g}, {:.6g}) m the mesh would need sides of {:.2g} m, or more than the {:.0e} vertices "
        "that are allowed, as sides of the border, or folds, come that near one another",
        refined.crowded.x(), refined.crowded.y(), refined.shortest, kMostGridVertices));
}

ClothMesh to_mesh(const std::vector<Vec2>& material, const std::vector<Face>& faces)
{
    ClothMesh mesh;
    mesh.material = material;
    mesh.faces = faces;
    for (const Vec2& X : mesh.material) mesh.world.emplace_back(X.x(), X.y(), 0.0);
    return mesh;
}

// Nodes are fixed. Other vertices on a line lie between two neighbours on it.
std::vector<Freedom> freedoms(const RefinedTriangulation& refined, std::size_t node_count)
{
    std::vector<std::array<int, 2>> neighbours(refined.points.size(), {-1, -1});
    for (const auto& [a, b] : refined.edges) {
        neighbours[a][neighbours[a][0] < 0 ? 0 : 1] = b;
        neighbours[b][neighbours[b][0] < 0 ? 0 : 1] = a;
    }
    std::vector<Freedom> freedom(refined.points.size());
    for (std::size_t v = 0; v < freedom.size(); ++v) {
        freedom[v].is_fixed = v < node_count;
        freedom[v].is_on_line = neighbours[v][0] >= 0;
        if (freedom[v].is_fixed || !freedom[v].is_on_line) continue;
        const auto [a, b] = neighbours[v];
        freedom[v].along = (refined.points[b] - refined.points[a]).normalized();
    }
    return freedom;
}

// The sides of the border as seen from outside: nothing on their left is cloth.
std::vector<std::array<int, 2>> outer_sides(const std::vector<Face>& faces)
{
    std::vector<std::array<int, 2>> sides;
    for (const Face& face : faces)
        for (int k = 0; k < 3; ++k) sides.push_back({face[k], face[(k + 1) % 3]});
    std::sort(sides.begin(), sides.end());
    std::vector<std::array<int, 2>> outer;
    for (const auto& [a, b] : sides)
        if (!std::binary_search(sides.begin(), sides.end(), std::array{b, a})) outer.push_back({b, a});
    return outer;
}

PlanarGraph graph_of(const std::vector<Vec2>& loop)
{
    PlanarGraph graph{loop, {}, {}};
    const int count = static_cast<int>(loop.size());
    for (int k = 0; k < count; ++k) graph.edges.push_back({k, (k + 1) % count});
    return graph;
}

// The loop, and the refinement's points inside it: without those that it added on the loop.
PlanarGraph take_inner_points(const std::vector<Vec2>& loop, const RefinedTriangulation& refined)
{
    std::vector<char> is_on_loop(refined.points.size(), 0);
    for (const auto& edge : refined.edges)
        for (const int v : edge) is_on_loop[v] = 1;
    PlanarGraph graph = graph_of(loop);
    for (std::size_t p = loop.size(); p < refined.points.size(); ++p)
        if (is_on_loop[p] == 0) graph.points.push_back(refined.points[p]);
    return graph;
}

}  // namespace

ClothMesh make_unstructured(const MeshLines& lines, double side)
{
    const RefinedTriangulation refined = refine_graph(divide(lines, side), kLargestSide * side, 0.0);
    return to_mesh(refined.points, refined.faces);
}

ClothMesh make_relaxed(const MeshLines& lines, double side)
{
    const RefinedTriangulation refined =
        refine_graph(divide(lines, side), kLargestRelaxed * side, kShortestSide * side);
    const std::vector<Freedom> freedom = freedoms(refined, lines.nodes.size());
    PlanarGraph graph{refined.points, refined.edges, outer_sides(refined.faces)};
    std::vector<Face> faces = refined.faces;
    for (int round = 0; round < kRelaxRounds; ++round) {
        relax_angles(faces, freedom, side, graph.points);
        faces = triangulate(graph);
    }
    return to_mesh(graph.points, faces);
}

ClothMesh make_relaxed_inside(const std::vector<Vec2>& loop, const std::vector<Vec2>& inside, double side)
{
    PlanarGraph given = graph_of(loop);
    given.points.insert(given.points.end(), inside.begin(), inside.end());
    PlanarGraph graph =
        take_inner_points(loop, refine_graph(given, kLargestRelaxed * side, kShortestSide * side));
    std::vector<Freedom> freedom(graph.points.size());
    for (std::size_t v = 0; v < given.points.size(); ++v) freedom[v].is_fixed = true;
    std::vector<Face> faces = triangulate(graph);
    for (int round = 0; round < kRelaxRounds; ++round) {
        relax_angles(faces, freedom, side, graph.points);
        faces = triangulate(graph);
    }
    return to_mesh(graph.points, faces);
}

}  // namespace arris
