// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// An open seam at present.
struct SeamGap {
    int seam = 0;         ///< index in the scene's sewing
    int pairs = 0;        ///< that are apart
    double widest = 0.0;  ///< m
    int vertex = -1;      ///< where it is widest
};

/// Time, s, in which a gap (m) closes that begins and ends at rest, with this greatest speed, m/s.
double closing_time(double gap, double speed);

/// Distance, m, from which on a pair counts as closed: a share of the distance between two layers.
double closed_gap(const Scene& scene);

/// The open seams, by their numbers; a tie is open where a pair of it is apart.
std::vector<SeamGap> find_open_seams(const Scene& scene, const State& state);

/// Between two steps that took `elapsed` (s): slows all cloth down, so that what is bumped does not drift
/// away, where nothing but seams holds it. Takes no momentum from cloth whose momentum is zero.
void slow_down(double elapsed, State& state);

/// Between two steps: welds seams that are closed, and lets those of the next order close when all of this
/// one have. Sets `sewn_at` once none is left. Does nothing where the scene has no seams, or all are closed.
void advance_sewing(const Scene& scene, State& state);

}  // namespace arris
