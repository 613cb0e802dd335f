// SPDX-License-Identifier: GPL-3.0-or-later
//
// A fold that has left its edge. Where material flows over a convex edge faster than sqrt(tension / density),
// the edge does not hold the fold: the fold flies off, while the cloth flows on through it. A vertex that
// moved only along the bisector of the edge's faces would lead the fold aside and bend the arriving cloth in
// every step. Such bends cannot be cleared ahead of the fold without straining the cloth.
//
// A kink moves through a string at c = sqrt(tension / density). If the arriving string moves along itself, in
// direction e at speed v, the kink moves with (v - c) e: along one straight line, out or back.
//
//     n1 ^        bisector          On a table, e is along its top. Outward therefore points along e as soon
//        |      /                   as the vertex is off the edge. If tension grows again, the vertex returns
//   =====|====o-----> e             along e to the place where it left.
//  table |    |
#pragma once

#include "geometry/obstacle/feature_frame.h"
#include "solver/model/eol_limits.h"

namespace arris {

/// Cloth that arrives at a fold, in the obstacle's frame.
struct ArrivingCloth {
    Vec3 direction;  ///< unit, across the edge, from the fold into this cloth; zero without arriving cloth
    double flow;     ///< m/s, of the material through the fold
};

/// Whether a vertex at `place` has left the feature, whose nearest point is `nearest`.
bool has_left_feature(const Vec3& nearest, const Vec3& place, double thickness);

/// Turns `frame` of the convex edge `edge`, whose outward is the bisector, for a vertex at `place` beyond its
/// stand-off; all in the obstacle's frame. Outward turns to the face along which the cloth arrives, else away
/// from the place where the edge holds the vertex. Moving outward still closes the gap to neither face, and
/// `mitre` times the thickness still bounds the vertex at that place. A vertex within its stand-off keeps
/// `frame`.
FeatureFrame turn_to_free_fold(const FeatureEdge& edge, const ArrivingCloth& arriving, const Vec3& place,
                               double thickness, const FeatureFrame& frame);

}  // namespace arris
