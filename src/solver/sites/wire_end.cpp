// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/sites/wire_end.h"

#include "geometry/obstacle/feature_nodes.h"
#include "solver/model/eol_limits.h"

namespace arris {

double reach_past_end(const Obstacle& obstacle, int feature, int end, double thickness, double cell)
{
    if (obstacle.features().edges[feature].kind != FeatureKind::Wire || !is_corner(obstacle.features(), end))
        return 0.0;
    const bool is_free = obstacle.topology().edge_count_at(end) == 1;
    return is_free ? kPastEnd * cell : kPastJoinedEnd * thickness;
}

}  // namespace arris
