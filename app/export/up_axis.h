// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "app/files/frame_source.h"
#include "geometry/rigid_motion.h"

namespace arris {

/// Axis that points upward in exported files. The world of a run has z.
enum class UpAxis { Y, Z };

/// "y" or "z".
const char* to_string(UpAxis up);

/// Maps the world to files with this axis: (x, y, z) to (x, z, -y) for y.
Placement turn_to(UpAxis up);

/// The frames with positions and velocities turned; `frames` itself for z.
FrameSource turned(const FrameSource& frames, UpAxis up);

}  // namespace arris
