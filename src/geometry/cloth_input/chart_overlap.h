// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// Finds the lowest pair of faces (f < g) whose interiors share a point in material space (exact); nothing if
/// there is none. Faces must be counter-clockwise with area. Faces that touch at vertices or along edges do
/// not overlap.
std::optional<std::array<int, 2>> find_overlap(const std::vector<Vec2>& material,
                                               const std::vector<Face>& faces);

}  // namespace arris
