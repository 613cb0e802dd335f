// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/sites/edge_crossings.h"

namespace arris {

/// Adds to `sites` on the convex edge `feature` the trace gaps: crossings between sites and EOL vertices
/// where the cloth lies on the feature. A trace with a gap holds the cloth there.
void fill_trace_gaps(const EdgeCrossings& crossings, int feature, std::vector<FeatureSite>& sites);

}  // namespace arris
