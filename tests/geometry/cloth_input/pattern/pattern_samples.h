// SPDX-License-Identifier: GPL-3.0-or-later
// Small sewing patterns for tests, and what must hold for the mesh of any pattern.
#pragma once

#include <string>
#include <vector>

#include "geometry/cloth_input/pattern/pattern_cloth.h"

namespace arris {

/// A panel with straight edges between corners, in the world at (u, v, 0).
Panel polygon_panel(const std::string& name, const std::vector<Vec2>& corners);

/// A rectangle from the origin; edges 0 to 3 are its bottom, right, top and left.
Panel rectangle_panel(const std::string& name, const Vec2& size);

/// A seam from the beginning of one edge to its end, and from the end of the other to its beginning.
Seam simple_seam(int panel, int edge, int other_panel, int other_edge);

/// Two rectangles, 0.4 x 0.3 m, side by side with a gap; the right edge of the first is sewn to the left one
/// of the second.
SewingPattern two_rectangles();

/// Two equal squares, 0.3 m, one above the other by 5 cm and running clockwise, sewn along all edges.
SewingPattern pillow();

/// A rectangle whose left and right edges are sewn together.
SewingPattern tube(double around, double length);

/// A square, 0.5 m, with a dart in its top: edges 3 and 4 are its sides.
SewingPattern dart();

/// A sector of a disc, whose straight edges 0 and 2 are sewn together.
SewingPattern cone(double radius, double degrees);

/// A strip whose ends are sewn together right side to wrong side: its only seam is a tie.
SewingPattern moebius_strip();

/// Front and back, each with a neckline (circle), armholes (cubic), sides (quadratic); the back runs
/// clockwise. They are sewn at shoulders, sides (the back's one is 5 % longer) and the front's darts.

SewingPattern top();

/// `validate` of the cloth sewn at all seams or at those that touch, and further: no inner edge of a panel
/// joins two vertices on seams, no face has three of them, and sewing all seams leaves just the free edges on
/// the border. Returns the first thing wrong.
std::string find_fault(const SewingPattern& pattern, double edge_length);

/// Number of closed lines on the border.
int count_border_loops(const ClothMesh& mesh);

}  // namespace arris
