// SPDX-License-Identifier: GPL-3.0-or-later
//
//      cloth              A fold that hangs on a wire leads on to the cloth's border, also where
//     .------------.      the wire ends before it, or with it. Without an EOL vertex at the
//     |   wire     |      border the cloth there would have to bend at its own vertices and edges:
//     *---*---*....*      it would hold the whole fold, though nothing slips.
//     |          ^ |
//     '--------end-'
#pragma once

#include <vector>

#include "solver/sites/edge_crossings.h"

namespace arris {

/// Adds to `sites` on the wire's edge `feature` those on the line that goes on past the wire's end, as far as
/// `reach_past_end`. They begin beside a site or EOL vertex of that edge. None where they do not lead to the
/// cloth's border: cloth around an end inside it is a cone, and has no one fold.
void continue_past_ends(const EdgeCrossings& crossings, int feature, std::vector<FeatureSite>& sites);

/// Removes the sites at ends of wires of the crossings' obstacle past which a trace continues: the end
/// presses on the trace, and a vertex held there would stand in the way of the others.
void drop_ends_passed(const EdgeCrossings& crossings, std::vector<FeatureSite>& sites);

}  // namespace arris
