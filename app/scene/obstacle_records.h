// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/obstacle/obstacle_mesh.h"
#include "geometry/rigid_motion.h"

namespace arris {

/// An obstacle as a run keeps it, for exports and for going on: whatever becomes of the file it came from.
struct ObstacleRecord {
    std::string name;
    ObstacleMesh mesh;    ///< in its own frame, repaired and scaled
    Placement placement;  ///< of that frame, before `motion`
    RigidMotion motion;

    /// Maps its frame to the world at `time` (s).
    Placement at(double time) const { return motion.at(time) * placement; }
};

/// <run_dir>/obstacles
std::string obstacles_file(const std::string& run_dir);

/// Written once, when a run starts; replaced atomically. std::system_error naming the path where the disk
/// refuses.
void write_obstacles(const std::string& run_dir, const std::vector<ObstacleRecord>& obstacles);

/// What write_obstacles wrote; empty where there is no such file: the run has no obstacles. Untrusted input:
/// InputError naming the file where it is none, of another format, damaged, or holds what no obstacle can
/// be. Lengths are checked before anything is allocated.
std::vector<ObstacleRecord> read_obstacles(const std::string& run_dir);

/// How many frames show where an obstacle was: all of `frame_count`, or the first alone if it never moves.
std::int64_t count_obstacle_frames(const ObstacleRecord& obstacle, std::int64_t frame_count);

}  // namespace arris
