// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/cloth_input/cloth_grid.h"

namespace arris {

/// Closed polygons around the cloth, m, material. The first encloses the cloth and is counter-clockwise, the
/// others are holes and clockwise: the cloth is on the left of every side.
using BorderLoops = std::vector<std::vector<Vec2>>;

/// The corners of the rectangle [0, size.x] x [0, size.y], counter-clockwise.
BorderLoops rectangle_border(const Vec2& size);

/// Segments on which mesh edges must lie: the border of the cloth and its fold lines, cut where they meet.
struct MeshLines {
    std::vector<Vec2> nodes;                   ///< m, material; the border's corners first, loop by loop
    std::vector<std::array<int, 2>> segments;  ///< straight, between two nodes; no two cross; border first
    int border_count = 0;                      ///< number of border segments; the cloth is on their left
};

/// Fold lines are clipped to the cloth: a line may run through it in several parts. Points closer than
/// 1e-12 of the border's longer extent are merged. A fold line on the border or on an earlier fold line adds
/// nothing. Throws InputError if a fold's points are equal or not finite, or if its line does not run through
/// the cloth. The loops must not touch themselves or each other.
MeshLines make_mesh_lines(const BorderLoops& border, const std::vector<FoldLine>& folds);

}  // namespace arris
