// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// Two faces (f < g) whose interiors share a point in material space, if there are any; exact, and the lowest
/// such pair. Faces must be counter-clockwise with area; touching in vertices or along edges is no overlap.
std::optional<std::array<int, 2>> find_overlap(const std::vector<Vec2>& material,
                                               const std::vector<Face>& faces);

}  // namespace arris
