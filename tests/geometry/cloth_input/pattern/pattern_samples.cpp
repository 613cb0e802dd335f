// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/geometry/cloth_input/pattern/pattern_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "geometry/cloth/mesh_pieces.h"
#include "geometry/cloth/mesh_topology.h"

namespace arris {
namespace {

BezierCurve curve(const std::vector<Vec2>& control)
{
    return {control};
}

// The neckline dips by 6 cm between shoulders 20 cm apart.
Panel top_panel(const std::string& name, double side_bulge, bool has_dart)
{
    Panel panel;
    panel.name = name;
    const auto add = [&](const Vec2& begin, const std::variant<BezierCurve, CircularArc>& shape = {}) {
        panel.edges.push_back({begin, shape, ""});
    };
    add({0.0, 0.0});  // 0: bottom
    if (has_dart) {
        add({0.23, 0.0});  // 1, 2: the dart's sides
        add({0.25, 0.12});
        add({0.27, 0.0});  // 3: bottom
    }
    add({0.5, 0.0}, curve({Vec2(0.5 + side_bulge, 0.2)}));          // right side
    add({0.5, 0.4}, curve({Vec2(0.42, 0.42), Vec2(0.43, 0.5)}));    // armhole
    add({0.46, 0.58});                                              // shoulder
    add({0.35, 0.6}, CircularArc{0.34 / 3.0, false, false});        // neckline
    add({0.15, 0.6});                                               // shoulder
    add({0.04, 0.58}, curve({Vec2(0.07, 0.5), Vec2(0.08, 0.42)}));  // armhole
    add({0.0, 0.4}, curve({Vec2(-side_bulge, 0.2)}));               // left side
    return panel;
}

// The loop in the other direction: corner 0 stays, edge e becomes edge count - 1 - e.
Panel reversed(const Panel& panel)
{
    Panel other = panel;
    const std::size_t count = panel.edges.size();
    for (std::size_t e = 0; e < count; ++e) {
        PanelEdge edge = panel.edges[count - 1 - e];
        edge.begin = panel.edges[(count - e) % count].begin;
        if (auto* bezier = std::get_if<BezierCurve>(&edge.shape))
            std::reverse(bezier->control.begin(), bezier->control.end());
        else
            std::get<CircularArc>(edge.shape).is_counter_clockwise ^= true;
        other.edges[e] = edge;
    }
    return other;
}

std::string find_panel_fault(const SewingPattern& pattern, const PatternMesh& meshes, int p)
{
    const PanelMesh& panel = meshes.panels[p];
    std::set<int> on_seam;
    for (const Seam& seam : pattern.seams)
        for (const SeamSide& side : seam.sides)
            for (int k = 0; k < side.count && side.panel == p; ++k) {
                const int edges = static_cast<int>(panel.corners.size()) - 1;
                for (const int v : panel.vertices_of((side.edge + k) % edges)) on_seam.insert(v);
            }
    const MeshTopology topology = make_topology(panel.mesh.vertex_count(), panel.mesh.faces);
    for (const MeshEdge& edge : topology.edges) {
        const bool is_border = edge.face_right < 0;
        if (is_border != (edge.b < panel.corners.back() &&
                          (edge.b - edge.a == 1 || edge.b - edge.a == panel.corners.back() - 1)))
            return fmt::format("panel {}: ({}, {}) is not as on the border", p, edge.a, edge.b);
        if (!is_border && on_seam.contains(edge.a) && on_seam.contains(edge.b))
            return fmt::format("panel {}: inner edge ({}, {}) joins seams", p, edge.a, edge.b);
    }
    for (const auto& [a, b, c] : panel.mesh.faces)
        if (on_seam.contains(a) && on_seam.contains(b) && on_seam.contains(c))
            return fmt::format("panel {}: face ({}, {}, {}) is on seams", p, a, b, c);
    return validate(panel.mesh);
}

int count_border_edges(const ClothMesh& mesh)
{
    int count = 0;
    for (const MeshEdge& edge : make_topology(mesh.vertex_count(), mesh.faces).edges)
        count += edge.face_right < 0 ? 1 : 0;
    return count;
}

int count_free_edges(const SewingPattern& pattern, const PatternMesh& meshes)
{
    int count = 0;
    for (const PanelMesh& panel : meshes.panels) count += panel.corners.back();
    for (const Seam& seam : pattern.seams)
        for (const SeamSide& side : seam.sides)
            for (int k = 0; k < side.count && !seam.is_tie; ++k) {
                const auto& corners = meshes.panels[side.panel].corners;
                const std::size_t e = static_cast<std::size_t>(side.edge + k) % (corners.size() - 1);
                count -= corners[e + 1] - corners[e];
            }
    return count;
}

}  // namespace

Panel polygon_panel(const std::string& name, const std::vector<Vec2>& corners)
{
    Panel panel;
    panel.name = name;
    for (const Vec2& corner : corners) panel.edges.push_back({corner, {}, ""});
    return panel;
}

Panel rectangle_panel(const std::string& name, const Vec2& size)
{
    return polygon_panel(name, {{0.0, 0.0}, {size.x(), 0.0}, size, {0.0, size.y()}});
}

Seam simple_seam(int panel, int edge, int other_panel, int other_edge)
{
    Seam seam;
    seam.sides = {SeamSide{panel, edge}, SeamSide{other_panel, other_edge, 1, true}};
    return seam;
}

SewingPattern two_rectangles()
{
    SewingPattern pattern;
    pattern.panels = {rectangle_panel("left", {0.4, 0.3}), rectangle_panel("right", {0.4, 0.3})};
    pattern.panels[1].placement.translation = Vec3(0.45, 0.0, 0.0);
    pattern.seams = {simple_seam(0, 1, 1, 3)};
    return pattern;
}

SewingPattern pillow()
{
    SewingPattern pattern;
    pattern.panels = {rectangle_panel("upper", {0.3, 0.3}), reversed(rectangle_panel("lower", {0.3, 0.3}))};
    pattern.panels[0].placement.translation.z() = 0.05;
    for (int e = 0; e < 4; ++e) pattern.seams.push_back(simple_seam(0, e, 1, 3 - e));
    return pattern;
}

SewingPattern tube(double around, double length)
{
    SewingPattern pattern;
    pattern.panels = {rectangle_panel("tube", {around, length})};
    pattern.seams = {simple_seam(0, 1, 0, 3)};
    return pattern;
}

SewingPattern dart()
{
    SewingPattern pattern;
    pattern.panels = {polygon_panel(
        "front", {{0.0, 0.0}, {0.5, 0.0}, {0.5, 0.5}, {0.28, 0.5}, {0.25, 0.3}, {0.22, 0.5}, {0.0, 0.5}})};
    pattern.seams = {simple_seam(0, 3, 0, 4)};
    return pattern;
}

SewingPattern cone(double radius, double degrees)
{
    const double angle = degrees * std::numbers::pi / 180.0;
    SewingPattern pattern;
    pattern.panels = {
        polygon_panel("cone", {{0.0, 0.0}, {radius, 0.0}, radius * Vec2(std::cos(angle), std::sin(angle))})};
    pattern.panels[0].edges[1].shape = CircularArc{radius, degrees > 180.0, true};
    pattern.seams = {simple_seam(0, 0, 0, 2)};
    return pattern;
}

SewingPattern moebius_strip()
{
    SewingPattern pattern;
    pattern.panels = {rectangle_panel("strip", {0.6, 0.1})};
    pattern.seams = {simple_seam(0, 1, 0, 3)};
    pattern.seams[0].sides[1].is_backward = false;
    agree_on_sides(pattern);
    return pattern;
}

SewingPattern top()
{
    SewingPattern pattern;
    pattern.panels = {top_panel("front", 0.02, true), reversed(top_panel("back", 0.06, false))};
    pattern.panels[0].placement.translation.z() = 0.1;
    // Edge 7 of the back is its bottom; 6 to 0 are the front's 4 to 10.
    pattern.seams = {simple_seam(0, 1, 0, 2), simple_seam(0, 4, 1, 6), simple_seam(0, 6, 1, 4),
                     simple_seam(0, 8, 1, 2), simple_seam(0, 10, 1, 0)};
    return pattern;
}

int count_border_loops(const ClothMesh& mesh)
{
    // Each border edge as a face of its own joins its ends.
    std::vector<Face> edges;
    std::set<int> loops;
    for (const MeshEdge& edge : make_topology(mesh.vertex_count(), mesh.faces).edges)
        if (edge.face_right < 0) edges.push_back({edge.a, edge.b, edge.b});
    const std::vector<int> label = label_pieces(mesh.vertex_count(), edges);
    for (const Face& edge : edges) loops.insert(label[edge[0]]);
    return static_cast<int>(loops.size());
}

std::string find_fault(const SewingPattern& pattern, double edge_length)
{
    const PatternMesh meshes = mesh_pattern(pattern, edge_length);
    for (int p = 0; p < static_cast<int>(pattern.panels.size()); ++p)
        if (std::string fault = find_panel_fault(pattern, meshes, p); !fault.empty()) return fault;
    if (std::string fault = validate(join_panels(pattern, meshes, edge_length).mesh); !fault.empty())
        return "sewn where touching: " + fault;
    const ClothMesh sewn = join_panels(pattern, meshes, edge_length, SewnSeams::All).mesh;
    if (std::string fault = validate(sewn); !fault.empty()) return "sewn: " + fault;
    const int border = count_border_edges(sewn), free = count_free_edges(pattern, meshes);
    return border == free ? "" : fmt::format("{} edges on the border, but {} free ones", border, free);
}

}  // namespace arris
