// SPDX-License-Identifier: GPL-3.0-or-later
// Where EOL vertices are on the features of their obstacles, and which of them follow each other along one.
#pragma once

#include <array>
#include <vector>

#include "geometry/obstacle/feature_path.h"
#include "solver/eol/cloth_stars.h"
#include "solver/model/eol_limits.h"
#include "solver/model/state.h"

namespace arris {

/// The point of the obstacle's mesh at which a fixed vertex is held; -1 of one that slides.
int fixed_point(const Obstacle& obstacle, const EolVertex& eol);

/// Unit, of the feature that the vertex is on, in the obstacle's frame; zero on a corner.
Vec3 feature_tangent(const Obstacle& obstacle, const EolVertex& eol);

bool is_on_convex_edge(const Obstacle& obstacle, const EolVertex& eol);

/// An EOL vertex and where it is in its obstacle's frame.
struct PlacedEol {
    const EolVertex& eol;
    Vec3 place;
};

/// Whether two EOL vertices joined by an edge of the cloth have the feature along it: they are on one
/// polyline, or at its end, and it goes from one to the other nearly straight.
bool is_trace_edge(const Obstacle& obstacle, const PlacedEol& a, const PlacedEol& b);

/// Whether two EOL vertices on one convex edge are on one line along it: of a fold that has flown off and of
/// a trace behind it, which is on the edge, they are not. True of all others: where a polyline turns nothing
/// tells which way they have gone.
bool is_of_one_strand(const Obstacle& obstacle, const PlacedEol& a, const PlacedEol& b);

/// The cloth's edges that lie along features at the state's time: the entries in State::eol of their ends,
/// ascending.
std::vector<std::array<int, 2>> find_trace_edges(const std::vector<Obstacle>& obstacles, const State& state,
                                                 const ClothStars& stars);

/// EOL vertices that have gone along their polyline past an end of their edge are on the next one from now
/// on. At the state's time.
void follow_features(const std::vector<Obstacle>& obstacles, State& state);

}  // namespace arris
