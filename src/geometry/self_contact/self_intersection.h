// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/self_contact/self_surface.h"
#include "geometry/vectors.h"

namespace arris {

/// Whether two faces of one cloth have more in common than shared vertices and edges; by exact predicates.
bool is_crossing(const std::vector<Vec3>& positions, const Face& first, const Face& second);

/// All pairs of faces that cross or touch, each with its lesser face first, in ascending order.
std::vector<std::array<int, 2>> find_self_intersections(const std::vector<Vec3>& positions,
                                                        const std::vector<Face>& faces);

/// As above, only pairs with a face of `of`, which ascends.
std::vector<std::array<int, 2>> find_self_intersections(const std::vector<Vec3>& positions,
                                                        const std::vector<Face>& faces,
                                                        const std::vector<int>& of);

}  // namespace arris
