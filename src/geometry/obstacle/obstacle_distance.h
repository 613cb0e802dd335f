// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/obstacle/obstacle.h"

namespace arris {

/// Unsigned distance (m) from `place` (in the obstacle's frame, finite) to the nearest of the obstacle's
/// faces, wires and lone points. Returns `most` where nothing is nearer than that.
double distance_to(const Obstacle& obstacle, const Vec3& place, double most);

}  // namespace arris
