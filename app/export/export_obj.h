// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "app/files/frame.h"
#include "app/scene/obstacle_records.h"

namespace arris {

/// The cloth of one frame as Wavefront OBJ: `v` world positions and `vt` material coordinates, both in metres
/// and one a vertex, `f` triangles as v/vt, `l` EOL edges. Numbers read back to the same double. Whole or
/// absent; throws std::system_error naming the path where the disk refuses.
void write_obj(const std::string& path, const Frame& frame);

/// An obstacle where `placement` (of its frame, in the world) has it: `v` world positions in metres, `f`
/// triangles, `l` wires' segments, `p` lone points. Otherwise as above.
void write_obj(const std::string& path, const ObstacleRecord& obstacle, const Placement& placement);

}  // namespace arris
