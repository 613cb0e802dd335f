// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/pattern/pattern_mesh.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "geometry/cloth/sewing.h"
#include "geometry/cloth_input/pattern/pattern_check.h"
#include "geometry/cloth_input/pattern/seam_parting.h"
#include "geometry/cloth_input/unstructured.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

void check_edge_lengths(const SewingPattern& pattern, double edge_length)
{
    for (const Panel& panel : pattern.panels) {
        const std::vector<EdgeCurve> curves = curves_of(panel);
        for (std::size_t e = 0; e < curves.size(); ++e)
            if (curves[e].length() < kShortestSide * edge_length)
                throw InputError(
                    fmt::format("{}: is {:.3g} m long; allowed: at least {:g} of the edge length of {} m",
                                edge_in_words(panel, static_cast<int>(e)), curves[e].length(), kShortestSide,
                                edge_length));
    }
}

// Panels whose curves cross, or enclose another area, once they are polygons.
void check_borders(const SewingPattern& pattern, double edge_length, const PatternBorders& borders)
{
    for (std::size_t p = 0; p < borders.panels.size(); ++p) {
        const Panel& panel = pattern.panels[p];
        const std::vector<Vec2>& places = borders.panels[p].places;
        if (const auto defect = find_border_defect({places}))
            throw InputError(
                fmt::format("{}: with edges of {} m its loop {}; allowed: {}, as with shorter edges",
                            panel_in_words(panel), edge_length, defect->wrong, defect->allowed));
        const double change =
            area_of(BorderLoops{places}) / area_of(BorderLoops{outline_of(curves_of(panel))}) - 1.0;
        if (std::abs(change) > kOtherShape)
            throw InputError(
                fmt::format("{}: with edges of {} m its area changes by {:.2g} %; allowed: an edge length "
                            "with which it changes by at most {:g} %",
                            panel_in_words(panel), edge_length, 100.0 * change, 100.0 * kOtherShape));
    }
}

// ---- numbers of sewn vertices

// The points of all borders, panel after panel, with the vertices that they become when all is sewn.
class SewnBorders {
  public:
    SewnBorders(const SewingPattern& pattern, const PatternBorders& borders)
    {
        int count = 0;
        for (const PanelBorder& border : borders.panels) {
            first_.push_back(count);
            count += static_cast<int>(border.places.size());
        }
        first_.push_back(count);
        std::vector<std::array<int, 2>> pairs;
        for (std::size_t s = 0; s < borders.seams.size(); ++s)
            if (!pattern.seams[s].is_tie)
                for (const auto& [v, w] : borders.seams[s]) pairs.push_back({point(v), point(w)});
        vertices_ = number_vertices(count, pairs);
        is_on_seam_.assign(count, 0);
        for (const Seam& seam : pattern.seams)
            for (const SeamSide& side : seam.sides) mark(side, borders.panels[side.panel]);
    }

    int vertex(std::size_t panel, int v) const { return vertices_[first_[panel] + v]; }

    SewnNumbers numbers_of(std::size_t panel) const
    {
        SewnNumbers numbers;
        for (int p = first_[panel]; p < first_[panel + 1]; ++p)
            numbers.push_back(is_on_seam_[p] != 0 ? vertices_[p] : -1);
        return numbers;
    }

  private:
    int point(const PanelVertex& v) const { return first_[v.panel] + v.vertex; }

    void mark(const SeamSide& side, const PanelBorder& border)
    {
        for (const int e : edges_of(side, border.corners.size() - 1))
            for (const int v : vertices_of_edge(border.corners, e)) is_on_seam_[point({side.panel, v})] = 1;
    }

    std::vector<int> first_;  // point of each panel
    std::vector<int> vertices_;
    std::vector<char> is_on_seam_;
};

// An edge of a mesh on a panel's border, and its ends once sewn.
struct BorderEdge {
    int low = 0, high = 0;
    std::size_t panel = 0;
    std::size_t edge = 0;  // of the panel
    std::optional<int> seam;
};

std::vector<BorderEdge> find_border_edges(const SewingPattern& pattern, const PatternBorders& borders,
                                          const SewnBorders& sewn)
{
    std::vector<BorderEdge> edges;
    std::vector<std::vector<std::optional<int>>> seam_of;
    for (const Panel& panel : pattern.panels) seam_of.emplace_back(panel.edges.size());
    for (std::size_t s = 0; s < pattern.seams.size(); ++s)
        for (const SeamSide& side : pattern.seams[s].sides)
            for (const int e : edges_of(side, seam_of[side.panel].size()))
                if (!pattern.seams[s].is_tie) seam_of[side.panel][e] = static_cast<int>(s);
    for (std::size_t p = 0; p < borders.panels.size(); ++p) {
        const PanelBorder& border = borders.panels[p];
        for (std::size_t e = 0; e + 1 < border.corners.size(); ++e)
            for (int v = border.corners[e]; v < border.corners[e + 1]; ++v) {
                const int next = (v + 1) % static_cast<int>(border.places.size());
                const auto [low, high] = std::minmax({sewn.vertex(p, v), sewn.vertex(p, next)});
                edges.push_back({low, high, p, e, seam_of[p][e]});
            }
    }
    std::stable_sort(edges.begin(), edges.end(), [](const BorderEdge& a, const BorderEdge& b) {
        return std::pair(a.low, a.high) < std::pair(b.low, b.high);
    });
    return edges;
}

// Sewn, each edge of the border coincides with its partner alone, or with none if it is on no seam.
void check_openings(const SewingPattern& pattern, double edge_length, const PatternBorders& borders,
                    const SewnBorders& sewn)
{
    const std::vector<BorderEdge> edges = find_border_edges(pattern, borders, sewn);
    for (std::size_t k = 0, end = 0; k < edges.size(); k = end) {
        while (end < edges.size() && edges[end].low == edges[k].low && edges[end].high == edges[k].high)
            ++end;
        const bool is_free = end == k + 1 && !edges[k].seam;
        const bool is_sewn = end == k + 2 && edges[k].seam && edges[k].seam == edges[k + 1].seam;
        if ((is_free || is_sewn) && edges[k].low != edges[k].high) continue;
        const BorderEdge& last = edges[end - 1];
        throw InputError(fmt::format(
            "{}: sewn, fewer than three edges of the mesh would go round here; allowed: openings and "
            "tubes longer than twice the edge length of {} m",
            edge_in_words(pattern.panels[last.panel], static_cast<int>(last.edge)), edge_length));
    }
}

// ---- meshes

PanelMesh mesh_panel(const Panel& panel, const PanelBorder& border, const SewnNumbers& sewn,
                     double edge_length)
{
    PanelMesh made;
    made.corners = border.corners;
    made.is_mirrored = (area_of(BorderLoops{border.places}) < 0.0) != panel.is_turned_over;
    std::vector<Vec2> loop = border.places, inside = border.inside;
    if (made.is_mirrored)
        for (std::vector<Vec2>* places : {&loop, &inside})
            for (Vec2& X : *places) X.x() = -X.x();
    ClothMesh& mesh = made.mesh;
    try {
        mesh = make_relaxed_inside(loop, inside, edge_length);
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", panel_in_words(panel), error.what()));
    }
    part_seams(sewn, edge_length, mesh.material, mesh.faces);
    mesh.world.clear();
    for (const Vec2& X : mesh.material)
        mesh.world.push_back(panel.placement(Vec3(made.is_mirrored ? -X.x() : X.x(), X.y(), 0.0)));
    return made;
}

void check_edge_length(const SewingPattern& pattern, double edge_length)
{
    double most = 0.0;
    for (const Panel& panel : pattern.panels) {
        Eigen::AlignedBox2d box;
        for (const Vec2& p : outline_of(curves_of(panel))) box.extend(p);
        most = std::max(most, box.diagonal().norm());
    }
    if (!(edge_length > 0.0) || !(edge_length <= most))
        throw InputError(
            fmt::format("edges of {} m; allowed: above 0, up to the largest panel's diagonal of {:.4g} m",
                        edge_length, most));
    require_few_vertices(edge_length, estimate_pattern(pattern, edge_length).vertices);
}

}  // namespace

std::vector<int> PanelMesh::vertices_of(int edge) const
{
    return vertices_of_edge(corners, edge);
}

GridCount estimate_pattern(const SewingPattern& pattern, double edge_length)
{
    GridCount count;
    for (const Panel& panel : pattern.panels) {
        ClothOutline outline;
        outline.border = to_border_loops(outline_of(curves_of(panel)), {});
        outline.edge_length = edge_length;
        const GridCount own = estimate_cloth_outline(outline);
        count.vertices += own.vertices;
        count.faces += own.faces;
    }
    return count;
}

PatternMesh mesh_pattern(const SewingPattern& pattern, double edge_length)
{
    check_pattern(pattern);
    check_edge_length(pattern, edge_length);
    check_edge_lengths(pattern, edge_length);
    const PatternBorders borders = divide_borders(pattern, edge_length);
    check_borders(pattern, edge_length, borders);
    const SewnBorders sewn(pattern, borders);
    check_openings(pattern, edge_length, borders, sewn);
    PatternMesh made;
    made.seams = borders.seams;
    for (std::size_t p = 0; p < pattern.panels.size(); ++p)
        made.panels.push_back(
            mesh_panel(pattern.panels[p], borders.panels[p], sewn.numbers_of(p), edge_length));
    return made;
}

}  // namespace arris
