// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/cloth_input/cloth_grid.h"

namespace arris {

/// Segments on which mesh edges must lie: the border of a rectangle of cloth and its fold lines, cut where
/// they meet.
struct FoldLines {
    std::vector<Vec2> nodes;  ///< m, material; the rectangle's corners first, counter-clockwise
    std::vector<std::array<int, 2>> segments;  ///< straight, between two nodes; no two cross; border first
    int border_count = 0;                      ///< number of border segments; the cloth is on their left
};

/// Fold lines are clipped to [0, size.x] x [0, size.y]. Points closer than 1e-12 of the longer side are
/// merged. A fold line on the border or on an earlier fold line adds nothing. Throws InputError if a fold's
/// points are equal or not finite, or if its line does not run through the cloth.
FoldLines make_fold_lines(const Vec2& size, const std::vector<Fold>& folds);

}  // namespace arris
