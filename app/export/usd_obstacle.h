// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "app/files/atomic_file.h"
#include "app/scene/parts/obstacle_records.h"

namespace arris {

/// Writes an obstacle as write_usd describes it, with samples at the time codes 0 to `frame_count` - 1. One
/// pose is in memory.
void write_usd_obstacle(AtomicFile& file, const ObstacleRecord& obstacle, std::size_t frame_count,
                        double frames_per_second);

}  // namespace arris
