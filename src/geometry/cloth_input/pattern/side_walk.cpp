// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/pattern/side_walk.h"

#include <algorithm>
#include <cmath>

namespace arris {
namespace {

/// Pairs of corners that meet, and both ends of the seam.
std::vector<SeamMark> find_meeting(const std::array<Shares, 2>& corners, double nearness)
{
    std::vector<SeamMark> marks = {{{0.0, 0.0}, {true, true}}};
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

/// Adds the corners of side `k` that meet none; shares on the other side are between those of the marks.
void add_lone_corners(const Shares& corners, int k, const std::vector<SeamMark>& meeting,
                      std::vector<SeamMark>& marks)
{
    std::size_t next = 1;
    for (const double share : corners) {
        while (meeting[next].shares[k] < share) ++next;
        const SeamMark &before = meeting[next - 1], &after = meeting[next];
        if (share == after.shares[k]) continue;
        const double part = (share - before.shares[k]) / (after.shares[k] - before.shares[k]);
        SeamMark mark;
        mark.shares[k] = share;
        mark.shares[1 - k] = before.shares[1 - k] + part * (after.shares[1 - k] - before.shares[1 - k]);
        mark.is_corner[k] = true;
        mark.is_corner[1 - k] = false;
        marks.push_back(mark);
    }
}

}  // namespace

SideWalk::SideWalk(const SeamSide& side, const std::vector<EdgeCurve>& curves)
    : side_(side), edges_(curves.size())
{
    const auto add = [&](double length) { ends_.push_back((ends_.empty() ? 0.0 : ends_.back()) + length); };
    for (std::size_t k = 1; k < side.line.size(); ++k) add((side.line[k] - side.line[k - 1]).norm());
    for (int k = 0; k < side.count; ++k) add(curves[edge(k)].length());
}

std::size_t SideWalk::edge(int k) const
{
    return static_cast<std::size_t>(side_.edge + (side_.is_backward ? side_.count - 1 - k : k)) % edges_;
}

Shares SideWalk::corners() const
{
    Shares shares;
    for (std::size_t k = 0; k + 1 < ends_.size(); ++k) shares.push_back(ends_[k] / length());
    return shares;
}

void SideWalk::add(double share, std::vector<Shares>& shares) const
{
    const auto [k, own] = find(share);
    shares[edge(k)].push_back(side_.is_backward ? 1.0 - own : own);
}

std::pair<int, double> SideWalk::find(double share) const
{
    const double at = share * length();
    const auto end = std::upper_bound(ends_.begin(), ends_.end() - 1, at);
    const double begin = end == ends_.begin() ? 0.0 : *(end - 1);
    return {static_cast<int>(end - ends_.begin()), (at - begin) / (*end - begin)};
}

Shares SideWalk::vertices(const std::vector<Shares>& shares) const
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

std::vector<SeamMark> find_marks(const std::array<SideWalk, 2>& sides, double edge_length)
{
    const std::array<Shares, 2> corners = {sides[0].corners(), sides[1].corners()};
    const double longer = std::max(sides[0].length(), sides[1].length());
    const std::vector<SeamMark> meeting = find_meeting(corners, kMeet * edge_length / longer);
    std::vector<SeamMark> marks = meeting;
    for (const int k : {0, 1}) add_lone_corners(corners[k], k, meeting, marks);
    std::sort(marks.begin(), marks.end(),
              [](const SeamMark& a, const SeamMark& b) { return a.shares < b.shares; });
    return marks;
}

}  // namespace arris
