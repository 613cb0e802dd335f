// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "geometry/box_tree.h"
#include "geometry/check/face_groups.h"
#include "geometry/self_contact/self_contact.h"
#include "geometry/self_contact/self_surface.h"
#include "geometry/vectors.h"

namespace arris {

/// Linear motion of the cloth's vertices during a step.
struct SelfMotion {
    const std::vector<Vec3>& begin;
    const std::vector<Vec3>& end;

    Box3 box(int v) const { return Box3(begin[v]).extend(end[v]); }
    Box3 box(int a, int b) const { return box(a).merged(box(b)); }
};

/// Vertices of a vertex and a face, and of two edges; those of the first element first.
inline std::array<int, 4> vertex_and_face(const SelfSurface& surface, int v, int face)
{
    const Face& f = surface.faces[face];
    return {v, f[0], f[1], f[2]};
}
inline std::array<int, 4> two_edges(const SelfSurface& surface, int first, int second)
{
    const MeshEdge &a = surface.edges[first], &b = surface.edges[second];
    return {a.a, a.b, b.a, b.b};
}

/// Distance, m, that a pair keeps: the thickness, or a share of it where a seam joins the elements.
inline double kept_distance(const SelfSurface& surface, const std::array<int, 4>& vertices, int first_count,
                            double thickness)
{
    return surface.joins(vertices, first_count) ? kSeamShare * thickness : thickness;
}

/// Positions of the four vertices of a pair.
inline std::array<Vec3, 4> corners(const std::vector<Vec3>& field, const std::array<int, 4>& vertices)
{
    return {field[vertices[0]], field[vertices[1]], field[vertices[2]], field[vertices[3]]};
}

/// Collects what `find` makes of the pairs of elements whose swept boxes come within `reach` (m) of each
/// other: find.vertex_face(v, face, results) and find.edge_edge(e, f, results), each pair once. A vertex of
/// the face, or a common vertex of the edges, makes no pair. In parallel; the order does not depend on the
/// number of threads. `Find` is copied for each batch.
template <typename Result, typename Find>
std::vector<Result> collect_near_pairs(const SelfSurface& surface, const SelfMotion& motion, double reach,
                                       const Find& find)
{
    const auto grow = [&](const Box3& box) {
        return Box3(box.min().array() - 0.5 * reach, box.max().array() + 0.5 * reach);
    };
    std::vector<Box3> boxes(surface.faces.size());
    for (std::size_t f = 0; f < boxes.size(); ++f) {
        for (const int v : surface.faces[f]) boxes[f].extend(motion.box(v));
        boxes[f] = grow(boxes[f]);
    }
    const BoxTree tree(boxes);

    const auto sweep_vertices = [&](Find& found, int f, int g, std::vector<Result>& results) {
        const Face& face = surface.faces[g];
        for (const int v : surface.owned[f].vertices)
            if (v >= 0 && v != face[0] && v != face[1] && v != face[2] &&
                grow(motion.box(v)).intersects(boxes[g]))
                found.vertex_face(v, g, results);
    };
    const auto sweep_edges = [&](Find& found, int f, int g, std::vector<Result>& results) {
        for (const int e : surface.owned[f].edges) {
            if (e < 0) continue;
            const MeshEdge& first = surface.edges[e];
            const Box3 box = grow(motion.box(first.a, first.b));
            if (!box.intersects(boxes[g])) continue;
            for (const int h : surface.owned[g].edges) {
                if (h < 0) continue;
                const MeshEdge& second = surface.edges[h];
                if (first.a != second.a && first.a != second.b && first.b != second.a &&
                    first.b != second.b && box.intersects(grow(motion.box(second.a, second.b))))
                    found.edge_edge(std::min(e, h), std::max(e, h), results);
            }
        }
    };
    const auto search = [&, found = find, near = std::vector<int>()](std::span<const int> group,
                                                                     const Box3& box,
                                                                     std::vector<Result>& results) mutable {
        tree.find(box, near);
        for (const int f : group) {
            for (const int g : near) {
                if (g <= f || !boxes[f].intersects(boxes[g])) continue;
                sweep_vertices(found, f, g, results);
                sweep_vertices(found, g, f, results);
                sweep_edges(found, f, g, results);
            }
        }
    };
    std::vector<int> all(boxes.size());
    std::iota(all.begin(), all.end(), 0);
    return collect_in_groups<Result>(boxes, std::move(all), search);
}

}  // namespace arris
