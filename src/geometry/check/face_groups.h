// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/obstacle/obstacle.h"

namespace arris {

/// Orders boxes so that each run of `group_size` (the last one may be shorter) lies close together, and one
/// query serves a run. Repeatedly halves the set at the median along its longest side. Returns indices, which
/// depend on the boxes alone. O(n log n).
std::vector<int> order_by_place(const std::vector<Box3>& boxes, int group_size);

}  // namespace arris
