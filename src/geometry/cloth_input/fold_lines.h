// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/cloth_input/cloth_grid.h"

namespace arris {

/// Where mesh edges must lie: the border of a rectangle of cloth and its fold lines, cut where they meet.
struct FoldLines {
    std::vector<Vec2> nodes;  ///< m, material; the rectangle's corners first, counter-clockwise
    std::vector<std::array<int, 2>>
        segments;          ///< straight between two nodes, crossing no other; border first
    int border_count = 0;  ///< how many of the segments are border, interior on their left
};

/// Fold lines are clipped to [0, size.x] x [0, size.y]; points closer than 1e-12 of its longer side are one.
/// A line on the border adds nothing, and neither does one that is there already. Throws InputError for a
/// fold without a direction or whose line does not run through the cloth.
FoldLines make_fold_lines(const Vec2& size, const std::vector<Fold>& folds);

}  // namespace arris
