// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/scene/keys/scene_document.h"
#include "geometry/cloth/mesh_topology.h"
#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/obstacle/moving_obstacle.h"

namespace arris {

/// Estimated size of a run, before anything is built. Doubles, so that absurdly large requests do not
/// overflow.
struct SceneEstimate {
    double vertices = 0.0;
    double faces = 0.0;
    double steps = 0.0;
    double frames = 0.0;
    double obstacle_elements = 0.0;  ///< triangles, wire segments and points of all obstacles
    double moving_elements = 0.0;    ///< elements of moving obstacles
    double pose_bytes = 0.0;         ///< of the files of deforming obstacles' poses
    double memory_bytes = 0.0;
    double disk_bytes = 0.0;
};

// Limits of a run.
inline constexpr double kMaxVertices = kMostGridVertices;
inline constexpr double kMaxSteps = 1e8;
inline constexpr double kMaxFrames = 1e6;
inline constexpr double kMaxObstacleElements = 5e6;

/// An estimate with the vertices and faces of the cloth alone.
SceneEstimate to_estimate(const GridCount& count);

/// Refuses a scene because of `key`: the run would have `count` of `what`, and at most `most` are allowed.
[[noreturn]] void refuse_estimate(const SceneDocument& document, const std::string& key, double count,
                                  const std::string& what, double most);

/// Lengths of the cloth's edges in the material, m.
struct EdgeLengths {
    double least = 0.0, mean = 0.0, greatest = 0.0;
};
EdgeLengths measure_edges(const ClothMesh& cloth, const MeshTopology& topology);

/// Number of frames from time 0 to `duration` (s), inclusive.
double count_frames(double duration, double frames_per_second);

/// Number of steps. Frames, `jumps` (s, ascending) and the end delimit intervals, each of which is divided
/// into ceil(interval / step - 1e-9) equal steps. Linear in frames and jumps, so check the number of frames
/// first.
double count_steps(double duration, double step, double frames_per_second, const std::vector<double>& jumps);

/// Adds the elements of the obstacles to the estimate.
void add_obstacles(const std::vector<MovingObstacle>& obstacles, SceneEstimate& estimate);

/// Fills `memory_bytes` and `disk_bytes` from the counts, for the given output formats.
void estimate_bytes(const std::vector<std::string>& formats, SceneEstimate& estimate);

/// The parts of an error message: what exceeds a limit, and the limit.
struct Excess {
    std::string wrong, allowed;
};

/// Nothing if the expected memory fits into `available` bytes.
std::optional<Excess> find_memory_excess(const SceneEstimate& estimate, double available);

/// Physical memory of this machine; infinity if unknown.
double machine_memory_bytes();

/// "1.5 GB".
std::string human_bytes(double bytes);

}  // namespace arris
