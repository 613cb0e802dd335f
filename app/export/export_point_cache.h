// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "app/files/frame_source.h"

namespace arris {

// Caches of the points of one mesh: every frame must have as many vertices as the first. Positions are floats
// in metres, in the order of vertices. One frame is in memory. Both throw InputError for an invalid
// frame or more frames or vertices than the format's 32-bit counts hold, std::system_error if writing fails.

/// Writes a Point Cache 2 file, atomically: little-endian, sample i is frame i.
void write_pc2(const std::string& path, const FrameSource& frames);

/// Writes a Lightwave MDD file, atomically: big-endian, with the time of each frame in seconds.
void write_mdd(const std::string& path, const FrameSource& frames, double frames_per_second);

}  // namespace arris
