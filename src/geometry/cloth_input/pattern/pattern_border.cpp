// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/pattern/pattern_border.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/closest_point.h"
#include "geometry/cloth_input/pattern/pattern_check.h"
#include "geometry/cloth_input/pattern/side_walk.h"
#include "geometry/input_error.h"
#include "geometry/tolerances.h"

namespace arris {
namespace {

using PanelCurves = std::vector<EdgeCurve>;

// Intervals of at most `edge_length`; a length that rounding lifts above a multiple gets none more.
double count_intervals(double length, double edge_length)
{
    return std::max(1.0, std::ceil(length / edge_length * (1.0 - kAccumulated)));
}

double distance_to_side(const Vec2& p, const Vec2& a, const Vec2& b)
{
    const auto at = [](const Vec2& x) { return Vec3(x.x(), x.y(), 0.0); };
    return (p - a - closest_on_segment(at(p), at(a), at(b)) * (b - a)).norm();
}

// Whether a place is within a loop, at least so far (m) from it.
bool is_clear_inside(const std::vector<Vec2>& loop, const Vec2& p, double distance)
{
    bool is_inside = false;
    for (std::size_t k = 0; k < loop.size(); ++k) {
        const Vec2 &a = loop[k], &b = loop[(k + 1) % loop.size()];
        if (distance_to_side(p, a, b) < distance) return false;
        if ((a.y() > p.y()) != (b.y() > p.y()) &&
            p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
            is_inside = !is_inside;
    }
    return is_inside;
}

// A line of a tie within a panel.
struct Line {
    Shares shares;  // of its length, of vertices between its corners; in any order
    std::vector<PanelVertex> vertices;
};

class BorderDivision {
  public:
    BorderDivision(const SewingPattern& pattern, double edge_length)
        : pattern_(pattern), edge_length_(edge_length)
    {
        for (const Panel& panel : pattern.panels) {
            curves_.push_back(curves_of(panel));
            shares_.emplace_back(panel.edges.size());
            is_sewn_.emplace_back(panel.edges.size(), 0);
        }
        lines_.resize(pattern.seams.size());
    }

    PatternBorders divide()
    {
        refuse_too_many();
        for (std::size_t s = 0; s < pattern_.seams.size(); ++s)
            if (!pattern_.seams[s].is_tie) divide_seam(s);
        for (std::size_t s = 0; s < pattern_.seams.size(); ++s)
            if (pattern_.seams[s].is_tie) divide_tie(s);
        for (std::size_t p = 0; p < curves_.size(); ++p) {
            for (std::size_t e = 0; e < curves_[p].size(); ++e) divide_free(p, e);
            borders_.panels.push_back(make_border(p));
        }
        for (std::size_t s = 0; s < pattern_.seams.size(); ++s) place_lines(s);
        for (std::size_t s = 0; s < pattern_.seams.size(); ++s) borders_.seams.push_back(pair_up(s));
        return std::move(borders_);
    }

  private:
    // A seam's side has at most the vertices that its other side asks for, kMostEase times its own.
    void refuse_too_many() const
    {
        for (std::size_t p = 0; p < curves_.size(); ++p) {
            double count = 0.0;
            for (const EdgeCurve& curve : curves_[p]) count += count_intervals(curve.length(), edge_length_);
            for (const Seam& seam : pattern_.seams)
                for (const SeamSide& side : seam.sides)
                    if (side.is_line() && side.panel == static_cast<int>(p))
                        count += count_intervals(length_of(side, curves_[p]), edge_length_);
            if (count > kMostOutlineCorners / kMostEase)
                throw InputError(
                    fmt::format("{}: with edges of {} m its border would have {:.3g} vertices; allowed: at "
                                "most {:g}",
                                panel_in_words(pattern_.panels[p]), edge_length_, count,
                                kMostOutlineCorners / kMostEase));
        }
    }

    std::array<SideWalk, 2> sides_of(const Seam& seam) const
    {
        return {SideWalk(seam.sides[0], curves_[seam.sides[0].panel]),
                SideWalk(seam.sides[1], curves_[seam.sides[1].panel])};
    }

    void divide_seam(std::size_t s)
    {
        const Seam& seam = pattern_.seams[s];
        const std::array<SideWalk, 2> sides = sides_of(seam);
        const std::vector<SeamMark> marks = find_marks(sides, edge_length_);
        for (std::size_t m = 0; m + 1 < marks.size(); ++m) {
            double longer = 0.0;
            for (const int k : {0, 1})
                longer = std::max(longer, (marks[m + 1].shares[k] - marks[m].shares[k]) * sides[k].length());
            // Ends of a tie that other seams join must not make its two edges one.
            const int count =
                static_cast<int>(std::max(count_intervals(longer, edge_length_), seam.is_tie ? 2.0 : 1.0));
            for (int i = 0; i < count; ++i)
                for (const int k : {0, 1})
                    if (i > 0 || !marks[m].is_corner[k])
                        add(s, k, sides[k],
                            std::lerp(marks[m].shares[k], marks[m + 1].shares[k], double(i) / count));
        }
        mark_sewn(seam);
    }

    // One side of a tie may have vertices already, of other seams.
    void divide_tie(std::size_t s)
    {
        const Seam& seam = pattern_.seams[s];
        const auto is_on_seam = [&](const SeamSide& side) {
            const std::vector<int> edges = edges_of(side, curves_[side.panel].size());
            return std::any_of(edges.begin(), edges.end(),
                               [&](int e) { return is_sewn_[side.panel][e] != 0; });
        };
        const bool is_first = is_on_seam(seam.sides[0]);
        if (!is_first && !is_on_seam(seam.sides[1])) return divide_seam(s);
        const int giving = is_first ? 0 : 1, taking = 1 - giving;
        const SeamSide& side = seam.sides[giving];
        for (const int e : edges_of(side, curves_[side.panel].size()))
            if (is_sewn_[side.panel][e] == 0) divide_free(side.panel, e);
        const std::array<SideWalk, 2> walks = sides_of(seam);
        const Shares corners = walks[taking].corners();
        for (const double share : walks[giving].vertices(shares_[side.panel]))
            if (std::none_of(corners.begin(), corners.end(), [&](double corner) {
                    return std::abs(corner - share) * walks[taking].length() < kMeet * edge_length_;
                }))
                add(s, taking, walks[taking], share);
        mark_sewn(seam);
    }

    void mark_sewn(const Seam& seam)
    {
        for (const SeamSide& side : seam.sides)
            for (const int e : edges_of(side, curves_[side.panel].size())) is_sewn_[side.panel][e] = 1;
    }

    // Adds a vertex at a share of a side's length.
    void add(std::size_t s, int k, const SideWalk& walk, double share)
    {
        const SeamSide& side = pattern_.seams[s].sides[k];
        if (side.is_line())
            lines_[s][k].shares.push_back(share);
        else
            walk.add(share, shares_[side.panel]);
    }

    void divide_free(std::size_t p, std::size_t e)
    {
        if (is_sewn_[p][e] != 0) {
            std::sort(shares_[p][e].begin(), shares_[p][e].end());
            return;
        }
        const int count = static_cast<int>(count_intervals(curves_[p][e].length(), edge_length_));
        for (int i = 1; i < count; ++i) shares_[p][e].push_back(double(i) / count);
    }

    PanelBorder make_border(std::size_t p) const
    {
        PanelBorder border;
        for (std::size_t e = 0; e < curves_[p].size(); ++e) {
            border.corners.push_back(static_cast<int>(border.places.size()));
            border.places.push_back(curves_[p][e].at(0.0));
            for (const double share : shares_[p][e]) border.places.push_back(curves_[p][e].at(share));
        }
        border.corners.push_back(static_cast<int>(border.places.size()));
        return border;
    }

    // All vertices of a side, in the seam's direction.
    std::vector<PanelVertex> vertices_of(const SeamSide& side) const
    {
        const PanelBorder& border = borders_.panels[side.panel];
        std::vector<PanelVertex> vertices;
        for (const int e : edges_of(side, curves_[side.panel].size())) {
            if (!vertices.empty()) vertices.pop_back();  // the corner between two edges
            for (const int v : vertices_of_edge(border.corners, e)) vertices.push_back({side.panel, v});
        }
        if (side.is_backward) std::reverse(vertices.begin(), vertices.end());
        return vertices;
    }

    // Gives the lines of a tie their vertices, within their panels.
    void place_lines(std::size_t s)
    {
        const Seam& seam = pattern_.seams[s];
        for (int k = 0; k < 2; ++k) {
            const SeamSide& side = seam.sides[k];
            if (!side.is_line()) continue;
            const SideWalk walk(side, curves_[side.panel]);
            Shares shares = walk.corners();
            shares.insert(shares.end(), lines_[s][k].shares.begin(), lines_[s][k].shares.end());
            shares.insert(shares.end(), {0.0, 1.0});
            std::sort(shares.begin(), shares.end());
            for (const double share : shares) {
                const auto [part, own] = walk.find(share);
                const Vec2 place = (1.0 - own) * side.line[part] + own * side.line[part + 1];
                lines_[s][k].vertices.push_back({side.panel, find_inside(s, side.panel, place)});
            }
        }
    }

    // The vertex at a place within a panel: one that is near, or a new one.
    int find_inside(std::size_t s, int panel, const Vec2& place)
    {
        PanelBorder& border = borders_.panels[panel];
        if (!is_clear_inside(border.places, place, kMeet * edge_length_))
            throw InputError(
                fmt::format("{}: at ({:.4g}, {:.4g}) m it is not within {}; allowed: a line at least a "
                            "quarter of the edge length of {} m from its border",
                            seam_in_words(pattern_, static_cast<int>(s)), place.x(), place.y(),
                            panel_in_words(pattern_.panels[panel]), edge_length_));
        const auto near = std::find_if(border.inside.begin(), border.inside.end(), [&](const Vec2& other) {
            return (other - place).norm() < kMeet * edge_length_;
        });
        const auto index = near - border.inside.begin();
        if (near == border.inside.end()) border.inside.push_back(place);
        return static_cast<int>(border.places.size() + static_cast<std::size_t>(index));
    }

    std::vector<PanelVertex> vertices_of(std::size_t s, int k) const
    {
        const SeamSide& side = pattern_.seams[s].sides[k];
        return side.is_line() ? lines_[s][k].vertices : vertices_of(side);
    }

    Vec2 place_of(const PanelVertex& v) const
    {
        const PanelBorder& border = borders_.panels[v.panel];
        const auto n = static_cast<int>(border.places.size());
        return v.vertex < n ? border.places[v.vertex] : border.inside[v.vertex - n];
    }

    // Shares of the length along vertices at which they are.
    Shares shares_along(const std::vector<PanelVertex>& vertices) const
    {
        Shares shares = {0.0};
        for (std::size_t k = 1; k < vertices.size(); ++k)
            shares.push_back(shares.back() + (place_of(vertices[k]) - place_of(vertices[k - 1])).norm());
        for (double& share : shares) share /= shares.back();
        return shares;
    }

    // The vertices of `many` at the shares nearest to those of `few`.
    std::vector<PanelVertex> choose(const std::vector<PanelVertex>& many,
                                    const std::vector<PanelVertex>& few) const
    {
        const Shares shares = shares_along(many);
        std::vector<PanelVertex> chosen;
        for (const double share : shares_along(few)) {
            const auto after = std::lower_bound(shares.begin() + 1, shares.end() - 1, share);
            const auto before = after - 1;
            chosen.push_back(many[static_cast<std::size_t>(
                (share - *before < *after - share ? before : after) - shares.begin())]);
        }
        return chosen;
    }

    std::vector<PanelVertexPair> pair_up(std::size_t s) const
    {
        std::vector<PanelVertex> one = vertices_of(s, 0), other = vertices_of(s, 1);
        if (one.size() > other.size()) one = choose(one, other);
        if (other.size() > one.size()) other = choose(other, one);
        std::vector<PanelVertexPair> pairs;
        for (std::size_t k = 0; k < one.size(); ++k) {
            const PanelVertexPair pair = {one[k], other[k]};
            const bool is_first_again = !pairs.empty() && pair == pairs.front();  // around a closed seam
            if (one[k] != other[k] && !is_first_again) pairs.push_back(pair);
        }
        return pairs;
    }

    const SewingPattern& pattern_;
    double edge_length_;
    std::vector<PanelCurves> curves_;
    std::vector<std::vector<Shares>> shares_;  // of each panel's edges
    std::vector<std::vector<char>> is_sewn_;
    std::vector<std::array<Line, 2>> lines_;  // of each seam's sides
    PatternBorders borders_;
};

}  // namespace

std::vector<int> vertices_of_edge(const std::vector<int>& corners, int edge)
{
    std::vector<int> vertices;
    for (int v = corners[edge]; v <= corners[edge + 1]; ++v) vertices.push_back(v % corners.back());
    return vertices;
}

PatternBorders divide_borders(const SewingPattern& pattern, double edge_length)
{
    return BorderDivision(pattern, edge_length).divide();
}

}  // namespace arris
