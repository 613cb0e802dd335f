// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// Least scalar product of `along` with any of `directions` (all unit vectors); 1 if there are none.
double least_part(const std::vector<Vec3>& directions, const Vec3& along);

/// The unit vector that maximises the least scalar product with the unit vectors `directions`; nothing if
/// that maximum is not positive. It points to the point of their convex hull nearest to the origin.
std::optional<Vec3> find_middle(const std::vector<Vec3>& directions);

}  // namespace arris
