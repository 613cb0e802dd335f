// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/obstacle/obstacle.h"

namespace arris {

/// Indices of boxes in an order in which each run of `group_size` (the last one shorter) lies close together,
/// so that one query serves a run: halved by the median along the longest side, again and again. A function
/// of the boxes alone; n log n.
std::vector<int> order_by_place(const std::vector<Box3>& boxes, int group_size);

}  // namespace arris
