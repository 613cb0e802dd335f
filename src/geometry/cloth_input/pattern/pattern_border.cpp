// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/pattern/pattern_border.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/cloth_input/pattern/pattern_check.h"
#include "geometry/input_error.h"
#include "geometry/tolerances.h"

namespace arris {
namespace {

// Corners of two sides within this share of the edge length meet: a shorter edge would be merged
// (mesh_limits.h merges below twice as much).
constexpr double kMeet = 0.25;

using PanelCurves = std::vector<EdgeCurve>;
using Shares = std::vector<double>;  // of an edge's length, ascending; vertices between its corners

// Intervals of at most `edge_length`; a length that rounding lifts above a multiple gets none more.
double count_intervals(double length, double edge_length)
{
    return std::max(1.0, std::ceil(length / edge_length * (1.0 - kAccumulated)));
}

// One side of a seam, run through in the seam's direction.
class SideWalk {
  public:
    SideWalk(const SeamSide& side, const PanelCurves& curves) : side_(side), edges_(curves.size())
    {
        const auto add = [&](double length) {
            ends_.push_back((ends_.empty() ? 0.0 : ends_.back()) + length);
        };
        for (std::size_t k = 1; k < side.line.size(); ++k) add((side.line[k] - side.line[k - 1]).norm());
        for (int k = 0; k < side.count; ++k) add(curves[edge(k)].length());
    }

    double length() const { return ends_.back(); }

    /// The k-th edge of the side.
    std::size_t edge(int k) const
    {
        return static_cast<std::size_t>(side_.edge + (side_.is_backward ? side_.count - 1 - k : k)) % edges_;
    }

    /// Shares of the side's length at which corners lie, without both ends.
    Shares corners() const
    {
        Shares shares;
        for (std::size_t k = 0; k + 1 < ends_.size(); ++k) shares.push_back(ends_[k] / length());
        return shares;
    }

    /// Adds the place at a share of the side's length to the shares of its edge, which follow the seam.
    void add(double share, std::vector<Shares>& shares) const
    {
        const auto [k, own] = find(share);
        shares[edge(k)].push_back(side_.is_backward ? 1.0 - own : own);
    }

    /// The edge, or part of the line, at a share of the side's length, and the share of its own length there.
    std::pair<int, double> find(double share) const
    {
        const double at = share * length();
        const auto end = std::upper_bound(ends_.begin(), ends_.end() - 1, at);
        const double begin = end == ends_.begin() ? 0.0 : *(end - 1);
        return {static_cast<int>(end - ends_.begin()), (at - begin) / (*end - begin)};
    }

    /// Shares of the side's length of all vertices within it, corners too. `shares`: of its panel's edges.
    Shares vertices(const std::vector<Shares>& shares) const
    {
        Shares all = corners();
        for (std::size_t k = 0; k < ends_.size(); ++k) {
            const double begin = k == 0 ? 0.0 : ends_[k - 1];
            for (const double own : shares[edge(static_cast<int>(k))])
                all.push_back(std::lerp(begin, ends_[k], side_.is_backward ? 1.0 - own : own) / length());
        }
        std::sort(all.begin(), all.end());
        return all;
    }

  private:
    SeamSide side_;
    std::size_t edges_;         // of the panel
    std::vector<double> ends_;  // length up to the end of each edge
};

// A vertex on both sides of a seam, because one side has a corner there.
struct Mark {
    std::array<double, 2> shares;  // of each side's length
    std::array<bool, 2> is_corner;
};

// Pairs of corners that meet, and both ends of the seam.
std::vector<Mark> find_meeting(const std::array<Shares, 2>& corners, double nearness)
{
    std::vector<Mark> marks = {{{0.0, 0.0}, {true, true}}};
    for (std::size_t i = 0, j = 0; i < corners[0].size() && j < corners[1].size();) {
        const double a = corners[0][i], b = corners[1][j];
        if (std::abs(a - b) < nearness) {
            marks.push_back({{a, b}, {true, true}});
            ++i, ++j;
        } else {
            ++(a < b ? i : j);
        }
    }
    marks.push_back({{1.0, 1.0}, {true, true}});
    return marks;
}

// Adds the corners of side `k` that meet none; shares on the other side are between those of the marks.
void add_lone_corners(const Shares& corners, int k, const std::vector<Mark>& meeting,
                      std::vector<Mark>& marks)
{
    std::size_t next = 1;
    for (const double share : corners) {
        while (meeting[next].shares[k] < share) ++next;
        const Mark &before = meeting[next - 1], &after = meeting[next];
        if (share == after.shares[k]) continue;
        const double part = (share - before.shares[k]) / (after.shares[k] - before.shares[k]);
        Mark mark;
        mark.shares[k] = share;
        mark.shares[1 - k] = before.shares[1 - k] + part * (after.shares[1 - k] - before.shares[1 - k]);
        mark.is_corner[k] = true;
        mark.is_corner[1 - k] = false;
        marks.push_back(mark);
    }
}

std::vector<Mark> find_marks(const std::array<SideWalk, 2>& sides, double edge_length)
{
    const std::array<Shares, 2> corners = {sides[0].corners(), sides[1].corners()};
    const double longer = std::max(sides[0].length(), sides[1].length());
    const std::vector<Mark> meeting = find_meeting(corners, kMeet * edge_length / longer);
    std::vector<Mark> marks = meeting;
    for (const int k : {0, 1}) add_lone_corners(corners[k], k, meeting, marks);
    std::sort(marks.begin(), marks.end(), [](const Mark& a, const Mark& b) { return a.shares < b.shares; });
    return marks;
}

double distance_to_side(const Vec2& p, const Vec2& a, const Vec2& b)
{
    const Vec2 d = b - a;
    return (p - a - std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0) * d).norm();
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
        const std::vector<Mark> marks = find_marks(sides, edge_length_);
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
    struct Line {
        Shares shares;  // of its length, of vertices between its corners; in any order
        std::vector<PanelVertex> vertices;
    };
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
