// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/obstacle/obstacle.h"
#include "geometry/surgery/cloth_surgery.h"

namespace arris {

/// Whether an operation leaves the cloth free of an obstacle whose frame is at `placement`: no new face
/// touches it, and nothing of it is between the surface that was and the one that is to be, so that no
/// corner, wire or nail gets from one side to the other. A split changes no surface and is always free.
bool is_free(const SurgeryEvent& event, const Obstacle& obstacle, const Placement& placement,
             double thickness);

}  // namespace arris
