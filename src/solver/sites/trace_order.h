// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include "solver/eol/eol_features.h"

namespace arris {

/// EOL vertices that are next to each other along a feature: polyline by polyline, from its start to its end,
/// and of a closed one of more than two the last and the first. A corner's vertex is at an end of each
/// polyline that ends there. They are `placed`'s own.
std::vector<std::pair<const EolVertex*, const EolVertex*>> find_trace_neighbours(
    const std::vector<Obstacle>& obstacles, const std::vector<PlacedEol>& placed);

}  // namespace arris
