// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/obstacle/obstacle_mesh.h"
#include "geometry/rigid_motion.h"

namespace arris {

/// An obstacle as stored in a run's folder. Export and resume read it, so the mesh file may change or vanish.
struct ObstacleRecord {
    std::string name;
    ObstacleMesh mesh;    ///< in the obstacle's frame, repaired and scaled
    Placement placement;  ///< of the obstacle's frame, before `motion`
    RigidMotion motion;

    /// Maps the obstacle's frame to the world at `time` (s).
    Placement at(double time) const { return motion.at(time) * placement; }
};

/// <run_dir>/obstacles
std::string obstacles_file(const std::string& run_dir);

/// Writes the file when a run starts, atomically. Throws std::system_error naming the path if that fails.
void write_obstacles(const std::string& run_dir, const std::vector<ObstacleRecord>& obstacles);

/// Reads the file of write_obstacles; empty if the file does not exist, as for a run without obstacles. The
/// file is untrusted: throws InputError naming it if it is of another kind or format, damaged, or holds an
/// invalid obstacle. Lengths are checked before memory is allocated.
std::vector<ObstacleRecord> read_obstacles(const std::string& run_dir);

/// Number of frames in which an obstacle is exported: `frame_count`, or at most 1 if it never moves.
std::size_t count_obstacle_frames(const ObstacleRecord& obstacle, std::size_t frame_count);

}  // namespace arris
