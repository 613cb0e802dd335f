// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/delaunay.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_size_criteria_2.h>
#include <CGAL/Delaunay_mesh_vertex_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "geometry/cgal.h"

namespace arris {
namespace {

// sin^2 of the least angle (20.7 degrees): the greatest bound for which the refinement is proven to end.
constexpr double kAngleBound = 0.125;

// A vertex has its index in the graph, or none if the refinement added it.
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::optional<int>, Kernel,
                                                               CGAL::Delaunay_mesh_vertex_base_2<Kernel>>;
using FaceBase = CGAL::Delaunay_mesh_face_base_2<Kernel>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel,
                                               CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>>;
using VertexHandle = Triangulation::Vertex_handle;
using FaceHandle = Triangulation::Face_handle;

// An order of insertion without quadratic cost. Deterministic.
std::vector<std::size_t> insertion_order(const std::vector<Point2>& points)
{
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    using Traits =
        CGAL::Spatial_sort_traits_adapter_2<Kernel, CGAL::Pointer_property_map<Point2>::const_type>;
    CGAL::spatial_sort(order.begin(), order.end(), Traits(CGAL::make_property_map(points)));
    return order;
}

Triangulation build(const PlanarGraph& graph)
{
    std::vector<Point2> points;
    points.reserve(graph.points.size());
    for (const Vec2& p : graph.points) points.push_back(to_cgal(p));
    Triangulation triangulation;
    std::vector<VertexHandle> vertices(points.size());
    FaceHandle hint;
    for (const std::size_t v : insertion_order(points)) {
        vertices[v] = triangulation.insert(points[v], hint);
        vertices[v]->info() = static_cast<int>(v);
        hint = vertices[v]->face();
    }
    for (const auto& [a, b] : graph.edges) triangulation.insert_constraint(vertices[a], vertices[b]);
    return triangulation;
}

// Faces reached from `start` without crossing an edge of the graph.
std::vector<FaceHandle> region_of(FaceHandle start, std::set<FaceHandle>& visited)
{
    std::vector<FaceHandle> region = {start};
    visited.insert(start);
    for (std::size_t next = 0; next < region.size(); ++next) {
        for (int k = 0; k < 3; ++k) {
            const FaceHandle neighbour = region[next]->neighbor(k);
            if (region[next]->is_constrained(k) || !visited.insert(neighbour).second) continue;
            region.push_back(neighbour);
        }
    }
    return region;
}

Face indices_of(const FaceHandle& face)
{
    return {*face->vertex(0)->info(), *face->vertex(1)->info(), *face->vertex(2)->info()};
}

// Starts each face at its lowest vertex and sorts, so that the order does not depend on CGAL's storage.
void make_canonical(std::vector<Face>& faces)
{
    for (Face& face : faces)
        std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    std::sort(faces.begin(), faces.end());
}

// Numbers the new vertices in the order of their coordinates and appends them to `points`.
void number_new_vertices(Triangulation& triangulation, std::vector<Vec2>& points)
{
    std::vector<VertexHandle> added;
    for (const VertexHandle v : triangulation.finite_vertex_handles())
        if (!v->info()) added.push_back(v);
    std::sort(added.begin(), added.end(), [](const VertexHandle& v, const VertexHandle& w) {
        return std::pair(v->point().y(), v->point().x()) < std::pair(w->point().y(), w->point().x());
    });
    for (const VertexHandle& v : added) {
        v->info() = static_cast<int>(points.size());
        points.push_back(to_eigen(v->point()));
    }
}

void find_shortest_side(const Triangulation& triangulation, RefinedTriangulation& refined)
{
    refined.shortest = std::numeric_limits<double>::infinity();
    for (const auto& [face, k] : triangulation.finite_edges()) {
        const Vec2 a = to_eigen(face->vertex(Triangulation::cw(k))->point());
        const Vec2 b = to_eigen(face->vertex(Triangulation::ccw(k))->point());
        if (!((b - a).norm() < refined.shortest)) continue;
        refined.shortest = (b - a).norm();
        refined.crowded = 0.5 * (a + b);
    }
}

bool has_side_in(const FaceHandle& face, const std::set<std::array<int, 2>>& directed)
{
    const Face f = indices_of(face);
    return directed.contains({f[0], f[1]}) || directed.contains({f[1], f[2]}) ||
           directed.contains({f[2], f[0]});
}

// Faces of the regions that the graph's edges enclose, but for those on the left of a side in `outside`.
std::vector<FaceHandle> enclosed_faces(const Triangulation& triangulation,
                                       const std::vector<std::array<int, 2>>& outside)
{
    const std::set<std::array<int, 2>> outside_sides(outside.begin(), outside.end());
    std::set<FaceHandle> visited;
    region_of(triangulation.infinite_face(), visited);
    std::vector<FaceHandle> faces;
    for (const FaceHandle start : triangulation.finite_face_handles()) {
        if (visited.contains(start)) continue;
        const std::vector<FaceHandle> region = region_of(start, visited);
        const bool is_outside = std::any_of(region.begin(), region.end(), [&](const FaceHandle& face) {
            return has_side_in(face, outside_sides);
        });
        if (!is_outside) faces.insert(faces.end(), region.begin(), region.end());
    }
    return faces;
}

}  // namespace

std::vector<Face> triangulate(const PlanarGraph& graph)
{
    const Triangulation triangulation = build(graph);
    std::vector<Face> faces;
    for (const FaceHandle& face : enclosed_faces(triangulation, graph.outside))
        faces.push_back(indices_of(face));
    make_canonical(faces);
    return faces;
}

RefinedTriangulation refine(const PlanarGraph& graph, double size, const RefinementLimits& limits)
{
    Triangulation triangulation = build(graph);
    using Criteria = CGAL::Delaunay_mesh_size_criteria_2<Triangulation>;
    CGAL::Delaunay_mesher_2<Triangulation, Criteria> mesher(triangulation, Criteria(kAngleBound, size));
    for (const FaceHandle& face : enclosed_faces(triangulation, graph.outside)) face->set_in_domain(true);
    mesher.init(/*is_domain_specified=*/true);

    RefinedTriangulation refined;
    const auto is_within_limits = [&] {
        find_shortest_side(triangulation, refined);
        return triangulation.number_of_vertices() <= limits.most_points &&
               refined.shortest >= limits.shortest_side;
    };
    std::size_t next_test = 0;
    bool is_done = false;
    while (!is_done && triangulation.number_of_vertices() <= limits.most_points) {
        is_done = !mesher.step_by_step_refine_mesh();
        if (triangulation.number_of_vertices() < next_test) continue;
        if (!is_within_limits()) break;
        next_test = 2 * triangulation.number_of_vertices();
    }
    refined.is_complete = is_done && is_within_limits();
    if (!refined.is_complete) return refined;

    refined.points = graph.points;
    number_new_vertices(triangulation, refined.points);
    for (const FaceHandle face : triangulation.finite_face_handles())
        if (face->is_in_domain()) refined.faces.push_back(indices_of(face));
    make_canonical(refined.faces);
    for (const auto& [face, k] : triangulation.constrained_edges()) {
        const int a = *face->vertex(Triangulation::cw(k))->info();
        const int b = *face->vertex(Triangulation::ccw(k))->info();
        refined.edges.push_back({std::min(a, b), std::max(a, b)});
    }
    std::sort(refined.edges.begin(), refined.edges.end());
    return refined;
}

}  // namespace arris
