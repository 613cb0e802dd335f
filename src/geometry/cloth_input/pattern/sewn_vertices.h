// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

namespace arris {

/// The vertex of each of `point_count` points when pairs of points become one vertex, as `sew` needs it:
/// vertices are numbered from 0 in the order of their first points. A point may be in several pairs.
std::vector<int> number_vertices(int point_count, const std::vector<std::array<int, 2>>& pairs);

}  // namespace arris
