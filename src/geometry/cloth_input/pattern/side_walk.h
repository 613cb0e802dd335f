// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "geometry/cloth_input/pattern/edge_curve.h"

namespace arris {

/// Corners of two sides within this share of the edge length meet: a shorter edge would be merged
/// (mesh_limits.h merges below twice as much).
inline constexpr double kMeet = 0.25;

/// Shares of a length, ascending, at which vertices lie.
using Shares = std::vector<double>;

/// One side of a seam, run through in the seam's direction.
class SideWalk {
  public:
    /// `curves`: of all edges of the side's panel.
    SideWalk(const SeamSide& side, const std::vector<EdgeCurve>& curves);

    double length() const { return ends_.back(); }  ///< m

    /// Shares of the side's length at which corners lie, without both ends.
    Shares corners() const;

    /// Adds the place at a share of the side's length to the shares of its edge, which follow the panel's
    /// loop.
    void add(double share, std::vector<Shares>& shares) const;

    /// The edge, or part of the line, at a share of the side's length, and the share of its own length there.
    std::pair<int, double> find(double share) const;

    /// Shares of the side's length of all vertices within it, corners too. `shares`: of its panel's edges.
    Shares vertices(const std::vector<Shares>& shares) const;

  private:
    std::size_t edge(int k) const;  ///< of the panel, the k-th one of the side

    SeamSide side_;
    std::size_t edges_;         ///< of the panel
    std::vector<double> ends_;  ///< m, length up to the end of each edge
};

/// A vertex on both sides of a seam, because one side has a corner there.
struct SeamMark {
    std::array<double, 2> shares;  ///< of each side's length
    std::array<bool, 2> is_corner;
};

/// Ends of a seam, and its corners: those of both sides that are within kMeet of an edge of `edge_length` (m)
/// meet. Others divide the other side between those, at the same share.
std::vector<SeamMark> find_marks(const std::array<SideWalk, 2>& sides, double edge_length);

}  // namespace arris
