// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/obstacle/deformation.h"
#include "geometry/obstacle/obstacle_mesh.h"
#include "geometry/rigid_motion.h"

namespace arris {

/// An obstacle as stored in a run's folder. Export and resume read it, so the mesh file may change or vanish.
struct ObstacleRecord {
    std::string name;
    ObstacleMesh mesh;    ///< in the obstacle's frame, repaired and scaled
    Placement placement;  ///< of the obstacle's frame, before `motion`
    RigidMotion motion;
    std::shared_ptr<const Deformation> deformation = nullptr;  ///< in the obstacle's frame; null if rigid

    /// Maps the obstacle's frame to the world at `time` (s).
    Placement at(double time) const { return motion.at(time) * placement; }

    /// Places (m) of the mesh's points in the obstacle's frame at `time` (s).
    std::vector<Vec3> points_at(double time) const;

    /// World places (m) of the mesh's points at `time` (s).
    std::vector<Vec3> world_points(double time) const;

    /// Whether its points are at other places in its frame at other times.
    bool is_deforming() const { return deformation && deformation->sample_times().size() > 1; }

    /// Whether its points are at other places in the world at other times.
    bool is_moving() const { return motion.is_moving() || is_deforming(); }
};

/// <run_dir>/obstacles
std::string obstacles_file(const std::string& run_dir);

/// <run_dir>/obstacle_<name>.poses: the poses of a deforming obstacle
std::string poses_file(const std::string& run_dir, const std::string& name);

/// Whether a file in a run's folder has a name of poses_file.
bool is_poses_file(std::string_view name);

/// Bytes that the poses of a deformation take in a run's folder. It must be a PointCache of a PoseFile.
std::uint64_t count_pose_bytes(const Deformation& deformation);

/// Writes the file when a run starts, and one of poses for each deforming obstacle, atomically. A deformation
/// must be a PointCache of a PoseFile. Throws std::system_error naming the path if that fails.
void write_obstacles(const std::string& run_dir, const std::vector<ObstacleRecord>& obstacles);

/// Reads the files of write_obstacles; empty if the file does not exist, as for a run without obstacles. The
/// files are untrusted: throws InputError naming it if it is of another kind or format, damaged, or holds an
/// invalid obstacle. Lengths are checked before memory is allocated.
std::vector<ObstacleRecord> read_obstacles(const std::string& run_dir);

/// Number of frames in which an obstacle is exported: `frame_count`, or at most 1 if it never moves.
std::size_t count_obstacle_frames(const ObstacleRecord& obstacle, std::size_t frame_count);

}  // namespace arris
