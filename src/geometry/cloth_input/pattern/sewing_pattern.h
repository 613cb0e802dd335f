// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "geometry/rigid_motion.h"
#include "geometry/vectors.h"

namespace arris {

/// A Bezier curve between the ends of an edge.
struct BezierCurve {
    std::vector<Vec2> control = {};  ///< m; none: straight, one: quadratic, two: cubic
};

/// An arc between the ends of an edge. Of the four arcs of this radius: the one longer than half of the
/// circle, or not; the one that runs counter-clockwise, which bulges to the edge's right, or clockwise.
struct CircularArc {
    double radius = 0.0;  ///< m
    bool is_large = false;
    bool is_counter_clockwise = false;
};

/// An edge from a corner of a panel to the next one's.
struct PanelEdge {
    Vec2 begin = Vec2::Zero();  ///< m, the corner at which the edge begins
    std::variant<BezierCurve, CircularArc> shape = {};
    std::string label = {};  ///< may be empty
};

/// A flat piece of cloth. Its edges form a closed loop in either direction. The panel's right side, to which
/// faces turn, is that from which the loop runs counter-clockwise, or the other where it is turned over.
struct Panel {
    std::string name;
    std::vector<PanelEdge> edges;
    Placement placement;  ///< from (u, v, 0) to the world
    bool is_turned_over = false;
};

/// Edges of a panel that follow each other in its loop, or, of a tie, a line within it.
struct SeamSide {
    int panel = 0;
    int edge = 0;                 ///< the first one in the loop's order
    int count = 1;                ///< number of edges; 0 of a line
    bool is_backward = false;     ///< whether the seam runs against the loop here
    std::vector<Vec2> line = {};  ///< its corners, m, two or more; empty along edges

    bool is_line() const { return !line.empty(); }
    bool operator==(const SeamSide&) const = default;
};

/// Two sides of cloth to be joined from one end to the other, at equal shares of their lengths.
struct Seam {
    std::array<SeamSide, 2> sides;
    int order = 0;  ///< seams of a lower order close first
    /// Is never sewn, as where it would join a right side to a wrong one. One side may be on other seams,
    /// too.
    bool is_tie = false;
};

struct SewingPattern {
    std::vector<Panel> panels;
    std::vector<Seam> seams;
};

/// The edges of a side in the loop's order, of a panel with `edge_count` edges.
std::vector<int> edges_of(const SeamSide& side, std::size_t edge_count);

/// Index of the panel with this name; -1 if there is none.
int find_panel(const SewingPattern& pattern, std::string_view name);

/// Whether sewing this seam joins the right side of one panel to the wrong side of the other.
bool joins_right_to_wrong(const SewingPattern& pattern, const Seam& seam);

/// Turns panels over so that seams join right sides to right sides; of panels that are sewn together the
/// first one stays. A seam that cannot agree with those before it (as in a Moebius strip) becomes a tie. A
/// seam that is a tie already turns nothing.
void agree_on_sides(SewingPattern& pattern);

}  // namespace arris
