// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/untangle/contours.h"
#include "geometry/untangle/smooth_move.h"

namespace arris {

/// Factor by which a way may be longer than the shortest one to be preferred for its lesser work. Lengths are
/// those of single points; a short way may pull neighbours apart, as at the edges of a box.
inline constexpr double kSimilarWay = 2.0;

/// A way in which the two sheets of a contour may come apart.
struct WayApart {
    double distance = 0.0;      ///< m, that the sheets move against each other, about
    std::vector<MoveRow> rows;  ///< that ask for it
    /// Faces on each side that may meet those on the other one, ascending: the ones that cross, the part that
    /// moves back and what it passes, with the faces around them.
    std::array<std::vector<int>, 2> sides;
};

/// The sides of several ways, by face.
class WaySides {
  public:
    WaySides(std::size_t face_count, const std::vector<WayApart>& ways);

    /// Whether two faces are on the two sides of a way.
    bool may_meet(int first, int second) const;

  private:
    std::vector<std::vector<int>> sides_of_;  // of each face: 2 way + side, ascending
};

/// Lengths of the ways.
struct WayLimits {
    double gap;   ///< m, to leave between the sheets
    double step;  ///< m, the longest move of a vertex at once
};

/// Ways of each contour, the shortest first; none where nothing can move. Candidates: a part of either sheet
/// that the contour cuts off, as far as it lies over the other sheet, moves back through that; the contour
/// becomes shorter; sheets that lie on each other part along the normal. No part moves into a solid.
std::vector<std::vector<WayApart>> find_ways_apart(const CollisionMesh& mesh,
                                                   const std::vector<Contour>& contours,
                                                   const WayLimits& limits);

}  // namespace arris
