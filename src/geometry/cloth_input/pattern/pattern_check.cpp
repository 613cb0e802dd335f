// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/pattern/pattern_check.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "geometry/cloth/piece_place.h"
#include "geometry/input_error.h"
#include "geometry/input_limits.h"
#include "geometry/mesh_text.h"
#include "geometry/tolerances.h"

namespace arris {
namespace {

[[noreturn]] void refuse(const std::string& what, const std::string& wrong, const std::string& allowed)
{
    throw InputError(fmt::format("{}: {}; allowed: {}", what, wrong, allowed));
}

// NaN does not pass.
bool is_within_limits(double value)
{
    return std::abs(value) <= kLargestCoordinate;
}

const std::string kCoordinates = fmt::format("finite numbers up to {:g} m", kLargestCoordinate);

// ---- panels

void check_names(const SewingPattern& pattern)
{
    if (pattern.panels.empty()) refuse("the pattern", "has no panel", "one or more panels");
    if (pattern.panels.size() > static_cast<std::size_t>(kMaxPieces))
        refuse("the pattern", fmt::format("has {} panels", pattern.panels.size()),
               fmt::format("at most {}", kMaxPieces));
    std::set<std::string_view> names;
    std::size_t edges = 0;
    for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
        const Panel& panel = pattern.panels[p];
        if (panel.name.empty())
            refuse(fmt::format("panel {}", p), "has no name", "a name that no other panel has");
        if (!names.insert(panel.name).second)
            refuse(panel_in_words(panel), "is there twice", "a name that no other panel has");
        edges += panel.edges.size();
    }
    if (edges > static_cast<std::size_t>(kMostPatternEdges))
        refuse("the pattern", fmt::format("has {} edges", edges),
               fmt::format("at most {}", kMostPatternEdges));
}

void check_arc(const Panel& panel, int edge, const CircularArc& arc)
{
    const std::string what = edge_in_words(panel, edge);
    if (!is_within_limits(arc.radius))
        refuse(what, fmt::format("has a radius of {} m", arc.radius), kCoordinates);
    const Vec2 chord = panel.edges[(edge + 1) % panel.edges.size()].begin - panel.edges[edge].begin;
    const double least = 0.5 * chord.norm();
    if (!(arc.radius >= (1.0 - kThreeDigits) * least) || !(arc.radius > 0.0))
        refuse(what,
               fmt::format("is an arc with a radius of {} m between corners {:.6g} m apart", arc.radius,
                           2.0 * least),
               "a radius of at least half of that");
}

void check_edge_numbers(const Panel& panel, int edge)
{
    const PanelEdge& of = panel.edges[edge];
    const auto check_point = [&](const Vec2& p, const char* which) {
        if (!is_within_limits(p.x()) || !is_within_limits(p.y()))
            refuse(edge_in_words(panel, edge), fmt::format("{} ({}, {}) m", which, p.x(), p.y()),
                   kCoordinates);
    };
    check_point(of.begin, "begins at");
    const auto* curve = std::get_if<BezierCurve>(&of.shape);
    if (!curve) return;
    for (const Vec2& p : curve->control) check_point(p, "has the control point");
    if (curve->control.size() > 2)
        refuse(edge_in_words(panel, edge), fmt::format("has {} control points", curve->control.size()),
               "none, one or two");
}

void check_numbers(const Panel& panel)
{
    const Placement& placement = panel.placement;
    if (!placement.rotation.allFinite() || !placement.translation.allFinite() ||
        !is_within_limits(placement.translation.cwiseAbs().maxCoeff()))
        refuse(panel_in_words(panel), "is not placed at a finite place", kCoordinates);
    if (panel.edges.size() < 3)
        refuse(
            panel_in_words(panel),
            fmt::format("has {}", counted(static_cast<long long>(panel.edges.size()), "corner", "corners")),
            "three or more");
    for (int e = 0; e < static_cast<int>(panel.edges.size()); ++e) check_edge_numbers(panel, e);
    for (int e = 0; e < static_cast<int>(panel.edges.size()); ++e)
        if (const auto* arc = std::get_if<CircularArc>(&panel.edges[e].shape)) check_arc(panel, e, *arc);
}

void check_shape(const Panel& panel, const std::vector<EdgeCurve>& curves)
{
    const std::vector<Vec2> outline = outline_of(curves);
    Eigen::AlignedBox2d box;
    for (const Vec2& p : outline) box.extend(p);
    const double extent = box.sizes().maxCoeff();
    if (!(extent >= kSmallestPanel && extent <= kLargestPanel))
        refuse(panel_in_words(panel), fmt::format("is {:.3g} m large", extent),
               fmt::format("{:g} to {:g} m", kSmallestPanel, kLargestPanel));
    for (std::size_t e = 0; e < curves.size(); ++e)
        if (!(curves[e].length() > kComputed * extent))
            refuse(edge_in_words(panel, static_cast<int>(e)), "has no length",
                   "edges between two different corners");
    if (const std::optional<BorderDefect> defect = find_border_defect({outline}))
        refuse(panel_in_words(panel), "its loop " + defect->wrong, defect->allowed);
}

// ---- seams

void check_line(const std::string& what, const Panel& panel, const SeamSide& side)
{
    const std::string line = fmt::format("{} has a line within {}", what, panel_in_words(panel));
    if (side.count != 0 || side.line.size() < 2)
        refuse(line, fmt::format("with {} corners", side.line.size()), "two or more");
    for (const Vec2& p : side.line)
        if (!is_within_limits(p.x()) || !is_within_limits(p.y()))
            refuse(line, fmt::format("past ({}, {}) m", p.x(), p.y()), kCoordinates);
    for (std::size_t k = 1; k < side.line.size(); ++k)
        if (side.line[k] == side.line[k - 1]) refuse(line, "that stays at one place", "corners that differ");
}

void check_side(const SewingPattern& pattern, int seam, const SeamSide& side)
{
    const std::string what = fmt::format("seam {}", seam);
    const int panels = static_cast<int>(pattern.panels.size());
    if (side.panel < 0 || side.panel >= panels)
        refuse(what, fmt::format("names panel {}", side.panel), fmt::format("0 to {}", panels - 1));
    const Panel& panel = pattern.panels[side.panel];
    if (side.is_line()) return check_line(what, panel, side);
    const int edges = static_cast<int>(panel.edges.size());
    if (side.edge < 0 || side.edge >= edges)
        refuse(what, fmt::format("names edge {} of {}", side.edge, panel_in_words(panel)),
               fmt::format("0 to {}", edges - 1));
    if (side.count < 1 || side.count > edges)
        refuse(what, fmt::format("has {} edges of {}", side.count, panel_in_words(panel)),
               fmt::format("1 to {}", edges));
}

void check_seam(const SewingPattern& pattern, int s, const std::vector<std::vector<EdgeCurve>>& curves)
{
    const Seam& seam = pattern.seams[s];
    std::array<double, 2> length;
    for (int k = 0; k < 2; ++k) length[k] = length_of(seam.sides[k], curves[seam.sides[k].panel]);
    const auto [shorter, longer] = std::minmax(length[0], length[1]);
    if (longer > kMostEase * shorter)
        refuse(seam_in_words(pattern, s),
               fmt::format("has sides of {:.4g} and {:.4g} m", length[0], length[1]),
               fmt::format("one at most {:g} times as long as the other", kMostEase));
    if (!seam.is_tie && joins_right_to_wrong(pattern, seam))
        refuse(seam_in_words(pattern, s), "joins the right side of cloth to a wrong side",
               "a seam in the other direction, a panel that is turned over, or a tie");
}

using SeamOfEdge = std::map<std::pair<int, int>, int>;  // (panel, edge) -> the first seam on it

/// Seams that are sewn have edges of their own, and so has one side of a tie.
void check_edges(const SewingPattern& pattern, int s, SeamOfEdge& sewn)
{
    const Seam& seam = pattern.seams[s];
    int sides_taken = 0;
    for (const SeamSide& side : seam.sides) {
        const Panel& panel = pattern.panels[side.panel];
        bool is_taken = false;
        for (const int edge : edges_of(side, panel.edges.size())) {
            const auto [at, is_new] = sewn.insert({{side.panel, edge}, s});
            if (is_new) continue;
            if (at->second == s)
                refuse(edge_in_words(panel, edge), fmt::format("is sewn twice, on both sides of seam {}", s),
                       "one seam an edge");
            if (!seam.is_tie)
                refuse(edge_in_words(panel, edge),
                       fmt::format("is sewn twice, in seams {} and {}", at->second, s),
                       "one seam an edge, or a tie");
            is_taken = true;
        }
        sides_taken += is_taken;
    }
    if (sides_taken == 2)
        refuse(seam_in_words(pattern, s), "has other seams on both sides",
               "a tie with one side that no other seam joins");
}

}  // namespace

std::string panel_in_words(const Panel& panel)
{
    return fmt::format("panel \"{}\"", excerpt(one_line(panel.name)));
}

std::string edge_in_words(const Panel& panel, int edge)
{
    return fmt::format("{}, edge {}", panel_in_words(panel), edge);
}

std::string seam_in_words(const SewingPattern& pattern, int seam)
{
    const auto words = [&](const SeamSide& side) {
        const Panel& panel = pattern.panels[side.panel];
        if (side.is_line())
            return fmt::format("{}, from ({:.4g}, {:.4g}) to ({:.4g}, {:.4g}) m", panel_in_words(panel),
                               side.line.front().x(), side.line.front().y(), side.line.back().x(),
                               side.line.back().y());
        if (side.count == 1) return edge_in_words(panel, side.edge);
        return fmt::format("{}, edges {} to {}", panel_in_words(panel), side.edge,
                           (side.edge + side.count - 1) % static_cast<int>(panel.edges.size()));
    };
    const auto& [one, other] = pattern.seams[seam].sides;
    return fmt::format("seam {} ({} with {})", seam, words(one), words(other));
}

double length_of(const SeamSide& side, const std::vector<EdgeCurve>& curves)
{
    double length = 0.0;
    for (std::size_t k = 1; k < side.line.size(); ++k) length += (side.line[k] - side.line[k - 1]).norm();
    for (const int e : edges_of(side, curves.size())) length += curves[e].length();
    return length;
}

void check_seam_edges(const SewingPattern& pattern)
{
    for (int s = 0; s < static_cast<int>(pattern.seams.size()); ++s)
        for (const SeamSide& side : pattern.seams[s].sides) {
            check_side(pattern, s, side);
            if (side.is_line() && !pattern.seams[s].is_tie)
                refuse(seam_in_words(pattern, s), "joins a line within a panel", "as a tie");
        }
    SeamOfEdge sewn;
    for (const bool is_tie : {false, true})
        for (int s = 0; s < static_cast<int>(pattern.seams.size()); ++s)
            if (pattern.seams[s].is_tie == is_tie) check_edges(pattern, s, sewn);
}

void check_pattern(const SewingPattern& pattern)
{
    check_names(pattern);
    std::vector<std::vector<EdgeCurve>> curves;
    for (const Panel& panel : pattern.panels) {
        check_numbers(panel);
        curves.push_back(curves_of(panel));
        check_shape(panel, curves.back());
    }
    check_seam_edges(pattern);
    for (int s = 0; s < static_cast<int>(pattern.seams.size()); ++s) check_seam(pattern, s, curves);
}

}  // namespace arris
