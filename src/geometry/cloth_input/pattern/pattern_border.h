// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/cloth_input/pattern/edge_curve.h"

namespace arris {

/// A vertex of a panel's own mesh.
struct PanelVertex {
    int panel = 0;
    int vertex = 0;

    bool operator==(const PanelVertex&) const = default;
};

/// Vertices that a seam joins, one of each side.
using PanelVertexPair = std::array<PanelVertex, 2>;

/// The vertices on a panel's border, in the loop's order, and then those on lines of ties within it.
struct PanelBorder {
    std::vector<Vec2> places;  ///< (u, v), m
    std::vector<int> corners;  ///< the vertex at the beginning of each edge, and places.size() at the end
    std::vector<Vec2> inside;  ///< (u, v), m, of the vertices that follow those of the border
};

struct PatternBorders {
    std::vector<PanelBorder> panels;
    std::vector<std::vector<PanelVertexPair>> seams;  ///< from the seam's beginning to its end
};

/// Vertices of an edge with both its ends, along the loop. `corners`: as PanelBorder's.
std::vector<int> vertices_of_edge(const std::vector<int>& corners, int edge);

/// Places vertices on all edges, about `edge_length` (m) apart. Both sides of a seam have equal counts at
/// equal shares of their lengths: the longer side divided by `edge_length`, rounded up. Corners within a side
/// of several edges are vertices, which divide the other side at the same share; where that is within a
/// quarter of `edge_length` of a corner there, the two corners meet. A vertex that both sides share, as at
/// the tip of a dart, is in no pair. A side of a tie that is on other seams, too, gives its vertices' shares
/// to the other side. The pattern must have passed check_pattern. Throws InputError for more than
/// kMostOutlineCorners vertices on a panel's border, and for lines that come within a quarter of
/// `edge_length` of the border or leave the panel.
PatternBorders divide_borders(const SewingPattern& pattern, double edge_length);

}  // namespace arris
