// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/obstacle/obstacle.h"
#include "geometry/rigid_motion.h"
#include "geometry/surgery/cloth_surgery.h"

namespace arris {

/// Whether an operation keeps the cloth free of an obstacle whose frame is at `placement`. No new face may
/// touch the obstacle, and no part of it may be between the old and the new surface. So no corner, wire or
/// nail gets to the other side of the cloth. A split does not change the surface and is always free.
bool is_free(const SurgeryEvent& event, const Obstacle& obstacle, const Placement& placement,
             double thickness);

}  // namespace arris
