// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "app/export/up_axis.h"
#include "app/files/frame.h"
#include "app/scene/parts/obstacle_records.h"

namespace arris {

/// Writes the cloth of one frame as Wavefront OBJ, atomically: `v` world positions and `vt` material
/// coordinates, both in metres and one per vertex; object `cloth`: `f` triangles as v/vt; object `cloth_eol`,
/// if there are EOL edges: these as `l`. Numbers read back to the same double. The first line names `up`, to
/// which the positions have been turned. Throws std::system_error naming the path if writing fails.
void write_obj(const std::string& path, const Frame& frame, UpAxis up);

/// Writes an obstacle whose points are at `points` (m), turned to `up`: these as `v`, `f` triangles, `l`
/// segments of wires, `p` lone points. Otherwise as for the cloth.
void write_obj(const std::string& path, const ObstacleRecord& obstacle, const std::vector<Vec3>& points,
               UpAxis up);

}  // namespace arris
