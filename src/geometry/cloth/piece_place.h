// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <limits>
#include <string>

#include "geometry/vectors.h"

namespace arris {

/// Most pieces of cloth in a scene.
inline constexpr int kMaxPieces = 1000;

/// Where a piece of cloth is in the plane of all material, in which pieces lie side by side along u: a
/// piece's own (u, v) is there at (u + shift, v), or at (shift - u, v).
struct PiecePlace {
    std::string name;                                         ///< empty for a [cloth] without one
    double shift = 0.0;                                       ///< m
    double begin = -std::numeric_limits<double>::infinity();  ///< m, where its part of the plane begins
    bool is_mirrored = false;                                 ///< whether u runs backward there

    Vec2 to_plane(const Vec2& own) const
    {
        return {is_mirrored ? shift - own.x() : own.x() + shift, own.y()};
    }
    Vec2 from_plane(const Vec2& X) const { return {is_mirrored ? shift - X.x() : X.x() - shift, X.y()}; }
};

/// Index of the piece that a place in that plane belongs to. `pieces`: PiecePlaces, ascending by `begin`; 0
/// where there are none.
template <class Pieces>
int piece_at(const Pieces& pieces, const Vec2& X)
{
    const auto after = std::upper_bound(pieces.begin(), pieces.end(), X.x(),
                                        [](double u, const PiecePlace& piece) { return u < piece.begin; });
    return std::max(0, static_cast<int>(after - pieces.begin()) - 1);
}

}  // namespace arris
