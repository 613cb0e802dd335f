// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/sites/edge_crossings.h"

namespace arris {

/// Adds to `sites` on convex edge `feature` of the obstacle what of the cloth lies on it between them and EOL
/// vertices: a trace with a hole holds the cloth there.
void fill_trace_gaps(const EdgeCrossings& crossings, int feature, std::vector<FeatureSite>& sites);

}  // namespace arris
