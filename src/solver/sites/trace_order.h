// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include "solver/eol/eol_features.h"

namespace arris {

/// Pairs of EOL vertices that are neighbours along a feature: polyline by polyline, from its start to its
/// end. For a closed polyline of more than two, also the last and the first. A corner's vertex is at an end
/// of each polyline that ends there. `placed` holds their places at `time` (s); the
/// pointers are to its vertices.
std::vector<std::pair<const EolVertex*, const EolVertex*>> find_trace_neighbours(
    const std::vector<MovingObstacle>& obstacles, double time, const std::vector<PlacedEol>& placed);

}  // namespace arris
