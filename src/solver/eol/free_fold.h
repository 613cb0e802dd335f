// SPDX-License-Identifier: GPL-3.0-or-later
//
// A fold that has left its edge. Where material flows over a convex edge faster than sqrt(tension / density),
// the edge does not hold the fold: it flies off, while the cloth goes on flowing through it. A vertex that
// may only move along the bisector of the edge's faces would lead it aside, and bend the cloth that comes to
// it with every step; that bend cannot be cleared away ahead of the fold without straining the cloth.
//
// A kink moves through a string at c = sqrt(tension / density). If what comes to it moves along itself, in
// direction e at speed v, the kink moves with (v - c) e: along the same straight line, out or back.
//
//     n1 ^        bisector          On a table e is along its top. So that line is where outward points, as
//        |      /                   soon as the vertex is off the edge; and on it, should tension grow again,
//   =====|====o-----> e             the vertex comes back to where it has left.
//  table |    |
#pragma once

#include "geometry/obstacle/feature_frame.h"
#include "solver/model/eol_limits.h"

namespace arris {

/// Cloth that comes to a fold, in the obstacle's frame.
struct ArrivingCloth {
    Vec3 direction;  ///< unit, in which it leaves the fold, across the edge; zero where there is none
    double flow;     ///< m/s, of its material through the fold
};

/// Whether cloth with a vertex at `place` is off the feature whose nearest point is `nearest`.
bool has_left_feature(const Vec3& nearest, const Vec3& place, double thickness);

/// `frame` of convex edge `edge` (its outward the bisector), outward turned for a vertex at `place` that is
/// farther out than its stand-off, all of it in the obstacle's frame: along the face on which what arrives
/// lies, else away from where the edge holds the vertex. Moving outward still closes the gap to neither face,
/// and the bound that `mitre` gives stays that place. The same frame for one that is not farther.
FeatureFrame turn_to_free_fold(const FeatureEdge& edge, const ArrivingCloth& arriving, const Vec3& place,
                               double thickness, const FeatureFrame& frame);

}  // namespace arris
