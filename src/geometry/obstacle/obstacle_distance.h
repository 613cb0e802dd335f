// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/obstacle/obstacle.h"

namespace arris {

/// From `place` (frame, finite) to the nearest of the obstacle's faces, wires and lone points, whichever side
/// it is on; `most` where none is nearer (m).
double distance_to(const Obstacle& obstacle, const Vec3& place, double most);

}  // namespace arris
