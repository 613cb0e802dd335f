// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "app/scene/parts/run_config.h"
#include "app/scene/warnings/warnings.h"

namespace arris {

/// Warns of times and motions of pins without effect, and of vertices that several pins hold at one time.
void check_pins(const RunConfig& config, Warnings& warnings);

/// Warns of the motion of the obstacle at `path`, where it has no effect.
void check_obstacle_motion(const RunConfig& config, const RigidMotion& motion, const std::string& path,
                           Warnings& warnings);

/// Warns of pins and obstacles that turn by more than half a turn between two keyframes.
void check_turns(const RunConfig& config, Warnings& warnings);

}  // namespace arris
