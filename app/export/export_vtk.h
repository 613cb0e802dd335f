// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "app/files/frame.h"
#include "app/scene/parts/obstacle_records.h"

namespace arris {

/// Writes the cloth of one frame as VTK XML PolyData (.vtp), atomically: appended raw arrays, little-endian,
/// compressed by zlib. Lines are EOL edges, polys the faces. Point data: id, eol, contact, vertex_velocity
/// and material_velocity (m/s), material (u, v, 0; m). Cell data, lines first, then polys: strain (NaN on
/// lines), stretch_energy and bending_energy (J; 0 on lines). Numbers read back to the same double. Throws
/// std::system_error naming the path if writing fails.
void write_vtp(const std::string& path, const Frame& frame);

/// Writes an obstacle whose points are at `points` (m): verts are lone points, lines are segments of wires,
/// polys are faces. Otherwise as for the cloth.
void write_vtp(const std::string& path, const ObstacleRecord& obstacle, const std::vector<Vec3>& points);

/// Writes a ParaView collection, atomically: part 0 is the cloth, part k the k-th obstacle, at `frame_count`
/// times, one every 1 / `frames_per_second` seconds. Files are those in <run_dir>/frames; a still obstacle
/// has one, which every time names. Memory does not grow with the number of frames.
void write_pvd(const std::string& path, const std::vector<ObstacleRecord>& obstacles, std::size_t frame_count,
               double frames_per_second);

}  // namespace arris
