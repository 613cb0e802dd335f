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
        for (int k = 0; k < side.count; ++k)
            ends_.push_back((ends_.empty() ? 0.0 : ends_.back()) + curves[edge(k)].length());
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
        const double at = share * length();
        const auto end = std::upper_bound(ends_.begin(), ends_.end() - 1, at);
        const double begin = end == ends_.begin() ? 0.0 : *(end - 1);
        const double own = (at - begin) / (*end - begin);
        shares[edge(static_cast<int>(end - ends_.begin()))].push_back(side_.is_backward ? 1.0 - own : own);
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
    }

    PatternBorders divide()
    {
        refuse_too_many();
        for (const Seam& seam : pattern_.seams) divide_seam(seam);
        for (std::size_t p = 0; p < curves_.size(); ++p) {
            for (std::size_t e = 0; e < curves_[p].size(); ++e) divide_free(p, e);
            borders_.panels.push_back(make_border(p));
        }
        for (const Seam& seam : pattern_.seams) borders_.seams.push_back(pair_up(seam));
        return std::move(borders_);
    }

  private:
    // A seam's side has at most the vertices that its other side asks for, kMostEase times its own.
    void refuse_too_many() const
    {
        for (std::size_t p = 0; p < curves_.size(); ++p) {
            double count = 0.0;
            for (const EdgeCurve& curve : curves_[p]) count += count_intervals(curve.length(), edge_length_);
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

    void divide_seam(const Seam& seam)
    {
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
                        add(seam.sides[k], sides[k],
                            std::lerp(marks[m].shares[k], marks[m + 1].shares[k], double(i) / count));
        }
        for (const SeamSide& side : seam.sides)
            for (const int e : edges_of(side, curves_[side.panel].size())) is_sewn_[side.panel][e] = 1;
    }

    void add(const SeamSide& side, const SideWalk& walk, double share)
    {
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

    std::vector<PanelVertexPair> pair_up(const Seam& seam) const
    {
        const std::vector<PanelVertex> one = vertices_of(seam.sides[0]), other = vertices_of(seam.sides[1]);
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
