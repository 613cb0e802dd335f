// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/cloth_input/pattern/sewing_pattern.h"

namespace arris {

/// The curve of a panel's edge, by arc length. Lengths of Bezier curves without cusps are exact to 1e-9
/// (measured); straight lines and arcs are exact.
class EdgeCurve {
  public:
    /// `end`: where the next edge begins. An arc too small for its ends becomes half a circle between them.
    EdgeCurve(const PanelEdge& edge, const Vec2& end);

    double length() const { return length_; }  ///< m
    bool is_straight() const { return control_.size() == 2; }

    /// The point at this share, 0 to 1, of the length.
    Vec2 at(double share) const;

  private:
    void measure();
    double speed(double t) const;
    double length_between(double from, double to) const;
    double parameter_at(double length) const;

    std::vector<Vec2> control_;  // of a Bezier curve, with both ends; empty for an arc
    std::vector<double> up_to_;  // length from the beginning to each of equal parts of the parameter
    Vec2 begin_, end_, centre_ = Vec2::Zero();
    double sweep_ = 0.0;  // rad, of an arc
    double length_ = 0.0;
};

/// The curves of a panel's edges, in order.
std::vector<EdgeCurve> curves_of(const Panel& panel);

/// A polygon along a panel's loop, (u, v), m, that is as fine as its shape needs: for checks and boxes. It
/// has kOutlineParts sides for each curved edge.
inline constexpr int kOutlineParts = 16;
std::vector<Vec2> outline_of(const std::vector<EdgeCurve>& curves);

}  // namespace arris
