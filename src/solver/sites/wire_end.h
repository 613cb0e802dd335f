// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/obstacle/obstacle.h"

namespace arris {

/// Length, m, past end `end` (index in the mesh) of the wire's edge `feature` over which a fold on the wire
/// leads on in line with it: kPastEnd cells of length `cell` (m) past a free end. Past a corner where other
/// wires go on, as in a closed wire, only as far as cloth lies on the corner. 0 for other features, and where
/// the polyline goes on.
double reach_past_end(const Obstacle& obstacle, int feature, int end, double thickness, double cell);

}  // namespace arris
