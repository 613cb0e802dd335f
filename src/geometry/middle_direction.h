// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// The least scalar product of `along` with one of `directions` (all unit vectors); 1 for none.
double least_part(const std::vector<Vec3>& directions, const Vec3& along);

/// The unit vector whose least scalar product with unit `directions` is greatest, where that is positive:
/// that of the point of their convex hull nearest to the origin.
std::optional<Vec3> find_middle(const std::vector<Vec3>& directions);

}  // namespace arris
