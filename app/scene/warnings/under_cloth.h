// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "app/scene/parts/run_config.h"

namespace arris {

/// An obstacle that is under some of the cloth at time 0, seen along gravity. Extents are those of boxes
/// around cloth and obstacle, so they are rough.
struct UnderCloth {
    std::string name;
    Vec3 up;                        ///< unit, against gravity
    double width = 0.0;             ///< of the obstacle over that of the cloth, in the narrower direction
    double steepest = 0.0;          ///< rad, of its upward faces
    bool is_overhung = false;       ///< the cloth reaches beyond it
    bool is_around_corner = false;  ///< the cloth reaches beyond it in two directions, and so around a corner
    bool is_straddled = false;      ///< the cloth reaches beyond it on two opposite sides
    bool is_moving_along = false;   ///< it moves sideways or turns
};

/// Obstacles that the cloth lies on, or would fall on, in the scene's order. Gravity must be present and not
/// zero.
std::vector<UnderCloth> find_under_cloth(const RunConfig& config);

}  // namespace arris
