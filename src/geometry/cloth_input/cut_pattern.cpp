// SPDX-License-Identifier: GPL-3.0-or-later
//
// Fits a regular pattern to its creases. In this file, a crease is a segment on which mesh edges must lie: a
// part of the rectangle's border or of a fold line.
//  1. Creases get vertices about a cell apart.
//  2. Pattern vertices too close to a crease are dropped.
//  3. Pattern faces that are complete and meet no crease are kept.
//  4. A constrained Delaunay triangulation fills the gap between the kept faces and the creases.
//  5. Vertices move a little to open the smallest angles.
//
//      crease  *-----*-----*-----*       Pattern vertices on a crease stay where they are. A crease along
//        gap   | \  / \   / \  / |       edges of the pattern therefore leaves the pattern unchanged.
//      kept    o---o---o---o---o         Coordinates are in cells: a cell is a unit square.
#include "geometry/cloth_input/cut_pattern.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/cgal.h"
#include "geometry/cloth/material_box.h"
#include "geometry/cloth_input/angle_relaxation.h"
#include "geometry/cloth_input/delaunay.h"
#include "geometry/cloth_input/mesh_lines.h"
#include "geometry/cloth_input/pattern_lattice.h"

namespace arris {
namespace {

// Cells: the clearance along a crease from its ends. A cross's middles have it. Chosen by measurement over
// all patterns and angles (cloth_grid_test.cpp has the least angles).
constexpr double kNodeClearance = 0.5;

// A vertex on a crease.
struct CreaseVertex {
    int segment;       // index in the fold lines; -1: the vertex is a node
    double parameter;  // along the segment, 0 to 1
    int lattice;       // the pattern vertex at this place, or -1
};

class CutPattern {
  public:
    explicit CutPattern(const ClothGrid& grid)
        : graph_(make_mesh_lines(rectangle_border(grid.size), grid.folds)),
          lattice_(grid),
          index_(lattice_.vertex_count()),
          is_dropped_(lattice_.vertex_count(), 0)
    {
        for (const Vec2& node : graph_.nodes) add_node(node);
        for (int s = 0; s < static_cast<int>(graph_.segments.size()); ++s) divide(s);
        drop_near_creases();
        keep_faces();
        add_pattern_vertices();
    }

    ClothMesh build()
    {
        fill_gap();
        for (int round = 0; round < kRelaxRounds; ++round) {
            relax_angles(faces_, freedoms(), 1.0, places_);
            fill_gap();
        }
        return to_mesh();
    }

  private:
    // --- vertices on creases

    int lattice_at(const Vec2& place) const
    {
        const Vec2 reach = Vec2::Constant(kMaterialTolerance);
        const std::vector<int> found = lattice_.vertices_in(place - reach, place + reach);
        return found.empty() ? -1 : found.front();
    }

    int add_crease_vertex(const Vec2& place, const CreaseVertex& vertex)
    {
        const int v = static_cast<int>(places_.size());
        places_.push_back(vertex.lattice >= 0 ? lattice_.place(vertex.lattice) : place);
        on_crease_.push_back(vertex);
        if (vertex.lattice >= 0) index_[vertex.lattice] = v;
        return v;
    }

    void add_node(const Vec2& material)
    {
        const Vec2 place = lattice_.to_cells(material);
        add_crease_vertex(place, {-1, 0.0, lattice_at(place)});
    }

    // Pattern vertices on the open segment from a to b and far enough from its ends, in order along it.
    std::vector<CreaseVertex> pattern_vertices_on(int segment, const Vec2& a, const Vec2& b) const
    {
        const Vec2 reach = Vec2::Constant(kMaterialTolerance);
        const double length = (b - a).norm();
        std::vector<CreaseVertex> found;
        const int steps = std::max(1, static_cast<int>(std::ceil(length)));
        // The segment is searched in pieces, so that the search boxes stay small.
        for (int k = 0; k < steps; ++k) {
            const Vec2 p = a + (b - a) * (double(k) / steps);
            const Vec2 q = a + (b - a) * (double(k + 1) / steps);
            for (const int v : lattice_.vertices_in(p.cwiseMin(q) - reach, p.cwiseMax(q) + reach)) {
                const Vec2 from = lattice_.place(v) - a;
                const double along = from.dot(b - a) / length;
                const double off = (from.x() * (b - a).y() - from.y() * (b - a).x()) / length;
                const bool is_clear = along >= kNodeClearance && length - along >= kNodeClearance;
                if (is_clear && std::abs(off) <= kMaterialTolerance)
                    found.push_back({segment, along / length, v});
            }
        }
        std::sort(found.begin(), found.end(),
                  [](const CreaseVertex& v, const CreaseVertex& w) { return v.parameter < w.parameter; });
        const auto same = [](const CreaseVertex& v, const CreaseVertex& w) { return v.lattice == w.lattice; };
        found.erase(std::unique(found.begin(), found.end(), same), found.end());
        return found;
    }

    // Puts vertices on a segment: the pattern's own, and further ones between them, about a cell apart.
    void divide(int segment)
    {
        const auto [begin, end] = graph_.segments[segment];
        const Vec2 a = places_[begin];
        const Vec2 b = places_[end];
        std::vector<CreaseVertex> stops = pattern_vertices_on(segment, a, b);
        stops.push_back({segment, 1.0, -1});
        int last = begin;
        double from = 0.0;
        for (const CreaseVertex& stop : stops) {
            const double gap = (stop.parameter - from) * (b - a).norm();
            const int pieces = std::max(1, static_cast<int>(std::lround(gap)));
            for (int k = 1; k <= pieces; ++k) {
                const double s = k < pieces ? from + (stop.parameter - from) * k / pieces : stop.parameter;
                const bool is_stop = k == pieces;
                const bool is_end = is_stop && stop.parameter >= 1.0;
                const int next =
                    is_end ? end
                           : add_crease_vertex(a + s * (b - a), {segment, s, is_stop ? stop.lattice : -1});
                crease_edges_.push_back({last, next});
                last = next;
            }
            from = stop.parameter;
        }
    }

    // --- pattern vertices and faces that are kept

    void drop_near_creases()
    {
        const Vec2 reach = Vec2::Constant(kCreaseClearance);
        for (const auto& [p, q] : crease_edges_) {
            const Vec2& a = places_[p];
            const Vec2& b = places_[q];
            for (const int v : lattice_.vertices_in(a.cwiseMin(b) - reach, a.cwiseMax(b) + reach)) {
                if (index_[v]) continue;
                const Vec2 d = b - a;
                const double s = std::clamp((lattice_.place(v) - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
                if ((a + s * d - lattice_.place(v)).norm() < kCreaseClearance) is_dropped_[v] = 1;
            }
        }
    }

    bool is_whole(const Face& face) const
    {
        return std::all_of(face.begin(), face.end(), [&](int v) { return v >= 0 && !is_dropped_[v]; });
    }

    int turn(const Vec2& a, const Vec2& b, const Vec2& c) const { return exact_orientation(a, b, c); }

    // Whether a crease edge meets a pattern face at more than common vertices or a common edge.
    bool is_cut(const Face& face, int p, int q) const
    {
        std::array<int, 2> end = {p, q};
        const auto corner_at = [&](int v) {
            return std::find_if(face.begin(), face.end(), [&](int l) { return index_[l] == v; }) -
                   face.begin();
        };
        if (corner_at(q) < 3) std::swap(end[0], end[1]);
        const auto at_first = corner_at(end[0]);
        if (at_first < 3 && corner_at(end[1]) < 3) return false;
        const Vec2& a = places_[end[0]];
        const Vec2& b = places_[end[1]];
        if (at_first < 3) {
            const Vec2& next = lattice_.place(face[(at_first + 1) % 3]);
            const Vec2& last = lattice_.place(face[(at_first + 2) % 3]);
            return turn(a, next, b) >= 0 && turn(a, b, last) >= 0;
        }
        // Disjoint convex polygons are separated by the line through a side of one of them.
        std::array<int, 3> side;
        for (int k = 0; k < 3; ++k) {
            const Vec2& c = lattice_.place(face[k]);
            const Vec2& d = lattice_.place(face[(k + 1) % 3]);
            if (turn(c, d, a) < 0 && turn(c, d, b) < 0) return false;
            side[k] = turn(a, b, c);
        }
        const auto [least, most] = std::minmax({side[0], side[1], side[2]});
        return least <= 0 && most >= 0;
    }

    void keep_faces()
    {
        std::vector<unsigned char> is_lost(lattice_.vertex_count(), 0);  // per cell, one bit per face
        for (const auto& [p, q] : crease_edges_) {
            const Vec2 low = places_[p].cwiseMin(places_[q]);
            const Vec2 high = places_[p].cwiseMax(places_[q]);
            for (const int cell : lattice_.cells_in(low, high)) {
                const std::vector<Face> faces = lattice_.faces_of(cell);
                for (std::size_t k = 0; k < faces.size(); ++k)
                    if (is_whole(faces[k]) && is_cut(faces[k], p, q))
                        is_lost[cell] = static_cast<unsigned char>(is_lost[cell] | (1u << k));
            }
        }
        for (int cell = 0; cell < lattice_.vertex_count(); ++cell) {
            if (!is_corner(cell)) continue;
            const std::vector<Face> faces = lattice_.faces_of(cell);
            for (std::size_t k = 0; k < faces.size(); ++k)
                if ((is_lost[cell] >> k & 1u) == 0 && is_whole(faces[k])) faces_.push_back(faces[k]);
        }
    }

    // Whether a pattern vertex is a corner of cells and not the middle of a "cross" cell.
    bool is_corner(int v) const { return lattice_.place(v).y() == std::round(lattice_.place(v).y()); }

    void add_pattern_vertices()
    {
        for (int v = 0; v < lattice_.vertex_count(); ++v) {
            if (index_[v] || is_dropped_[v]) continue;
            index_[v] = static_cast<int>(places_.size());
            places_.push_back(lattice_.place(v));
        }
        for (Face& face : faces_)
            for (int& v : face) v = *index_[v];
        kept_count_ = faces_.size();
        find_gap();
    }

    // --- the gap

    // Directed sides of kept faces that no other kept face shares.
    std::vector<std::array<int, 2>> rim_of_kept() const
    {
        std::vector<std::array<int, 2>> sides;
        sides.reserve(3 * kept_count_);
        for (std::size_t f = 0; f < kept_count_; ++f)
            for (int k = 0; k < 3; ++k) sides.push_back({faces_[f][k], faces_[f][(k + 1) % 3]});
        std::sort(sides.begin(), sides.end());
        std::vector<std::array<int, 2>> rim;
        for (const auto& [a, b] : sides)
            if (!std::binary_search(sides.begin(), sides.end(), std::array{b, a})) rim.push_back({a, b});
        return rim;
    }

    // Builds the gap's outline, with its own numbering: creases, the border of the kept faces, and pattern
    // vertices in no kept face.
    void find_gap()
    {
        const std::vector<std::array<int, 2>> rim = rim_of_kept();
        std::vector<char> is_inside(places_.size(), 0);
        for (std::size_t f = 0; f < kept_count_; ++f)
            for (const int v : faces_[f]) is_inside[v] = 1;
        for (const auto& [a, b] : rim) is_inside[a] = is_inside[b] = 0;
        std::fill_n(is_inside.begin(), on_crease_.size(), 0);
        std::vector<int> local(places_.size(), -1);
        for (int v = 0; v < static_cast<int>(places_.size()); ++v) {
            if (is_inside[v] != 0) continue;
            local[v] = static_cast<int>(gap_vertices_.size());
            gap_vertices_.push_back(v);
        }
        const auto to_local = [&](const std::array<int, 2>& e) {
            return std::array{local[e[0]], local[e[1]]};
        };
        for (const auto& edge : crease_edges_) gap_.edges.push_back(to_local(edge));
        for (const auto& edge : rim) {
            gap_.edges.push_back(to_local(edge));
            gap_.outside.push_back(to_local(edge));
        }
    }

    void fill_gap()
    {
        gap_.points.clear();
        for (const int v : gap_vertices_) gap_.points.push_back(places_[v]);
        faces_.resize(kept_count_);
        for (const Face& face : triangulate(gap_))
            faces_.push_back({gap_vertices_[face[0]], gap_vertices_[face[1]], gap_vertices_[face[2]]});
    }

    std::vector<Freedom> freedoms() const
    {
        std::vector<Freedom> freedom(places_.size());
        for (std::size_t v = 0; v < on_crease_.size(); ++v) {
            const CreaseVertex& vertex = on_crease_[v];
            freedom[v].is_on_line = true;
            freedom[v].is_fixed = vertex.segment < 0;
            if (vertex.segment < 0) continue;
            const auto [a, b] = graph_.segments[vertex.segment];
            freedom[v].along = (places_[b] - places_[a]).normalized();
        }
        return freedom;
    }

    // --- back to material space

    Vec2 material_of(int v) const
    {
        if (v >= static_cast<int>(on_crease_.size())) return lattice_.to_material(places_[v]);
        const CreaseVertex& vertex = on_crease_[v];
        if (vertex.segment < 0) return graph_.nodes[v];
        const auto [a, b] = graph_.segments[vertex.segment];
        const Vec2 d = places_[b] - places_[a];
        const double s = (places_[v] - places_[a]).dot(d) / d.squaredNorm();
        return graph_.nodes[a] + s * (graph_.nodes[b] - graph_.nodes[a]);
    }

    ClothMesh to_mesh() const
    {
        ClothMesh mesh;
        mesh.faces = faces_;
        for (int v = 0; v < static_cast<int>(places_.size()); ++v) {
            mesh.material.push_back(material_of(v));
            mesh.world.emplace_back(mesh.material.back().x(), mesh.material.back().y(), 0.0);
        }
        return mesh;
    }

    MeshLines graph_;
    PatternLattice lattice_;
    std::vector<std::optional<int>> index_;  // mesh vertex of each pattern vertex that is in the mesh
    std::vector<char> is_dropped_;           // the pattern vertex will not be in the mesh
    std::vector<Vec2> places_;  // mesh vertices, in cells: nodes, other crease vertices, pattern vertices
    std::vector<CreaseVertex> on_crease_;  // of the first vertices in places_
    std::vector<std::array<int, 2>> crease_edges_;
    std::vector<Face> faces_;  // kept faces first
    std::size_t kept_count_ = 0;
    PlanarGraph gap_;
    std::vector<int> gap_vertices_;
};

}  // namespace

ClothMesh make_cut_pattern(const ClothGrid& grid)
{
    return CutPattern(grid).build();
}

}  // namespace arris
