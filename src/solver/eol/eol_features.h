// SPDX-License-Identifier: GPL-3.0-or-later
// Places of EOL vertices on the features of their obstacles, and which of them follow each other along one.
#pragma once

#include <array>
#include <vector>

#include "geometry/obstacle/feature_path.h"
#include "geometry/obstacle/moving_obstacle.h"
#include "solver/eol/cloth_stars.h"
#include "solver/model/eol_limits.h"
#include "solver/model/state.h"

namespace arris {

/// The point of the obstacle's mesh at which a fixed vertex is held; -1 for a vertex that slides.
int fixed_point(const Obstacle& obstacle, const EolVertex& eol);

/// Unit tangent of the vertex's feature in the obstacle's frame; zero at a corner.
Vec3 feature_tangent(const Obstacle& obstacle, const EolVertex& eol);

bool is_on_convex_edge(const Obstacle& obstacle, const EolVertex& eol);

/// An EOL vertex and its place in its obstacle's frame.
struct PlacedEol {
    const EolVertex& eol;
    Vec3 place;
};

/// Whether the cloth's edge between two EOL vertices lies along the feature: both are on one polyline, or at
/// its end, and the polyline leads from one to the other nearly straight.
bool is_trace_edge(const Obstacle& obstacle, const PlacedEol& a, const PlacedEol& b);

/// Whether two EOL vertices on one convex edge belong to one strand along it. A free fold and the trace
/// behind it, which is on the edge, are different strands. True for all other pairs: at a bend of a polyline
/// the direction in which a vertex has left the edge is unknown.
bool is_of_one_strand(const Obstacle& obstacle, const PlacedEol& a, const PlacedEol& b);

/// The cloth's edges that lie along features at the state's time, as the entries of their ends in State::eol,
/// ascending.
std::vector<std::array<int, 2>> find_trace_edges(const std::vector<MovingObstacle>& obstacles,
                                                 const State& state, const ClothStars& stars);

/// Reassigns EOL vertices that have moved past an end of their edge to the next edge of the polyline, at the
/// state's time.
void follow_features(const std::vector<MovingObstacle>& obstacles, State& state);

}  // namespace arris
