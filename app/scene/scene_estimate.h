// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/cloth/mesh_topology.h"
#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/obstacle/obstacle.h"

namespace arris {

/// The size of a run before anything of it exists; doubles, so that absurd requests have an estimate too.
struct SceneEstimate {
    double vertices = 0.0;
    double faces = 0.0;
    double steps = 0.0;
    double frames = 0.0;
    double obstacle_elements = 0.0;  ///< triangles, wire segments and points of all obstacles
    double moving_elements = 0.0;    ///< of those that move
    double memory_bytes = 0.0;
    double disk_bytes = 0.0;
};

// What a run may ask for.
inline constexpr double kMaxVertices = kMostGridVertices;
inline constexpr double kMaxSteps = 1e8;
inline constexpr double kMaxFrames = 1e6;
inline constexpr double kMaxObstacleElements = 5e6;

/// Vertices and faces of a grid, before it is made; throws what estimate_cloth_grid throws.
void estimate_grid(const ClothGrid& grid, SceneEstimate& estimate);

/// Lengths of the cloth's edges in the material, m: what it can resolve.
struct EdgeLengths {
    double least = 0.0, mean = 0.0, greatest = 0.0;
};
EdgeLengths measure_edges(const ClothMesh& cloth, const MeshTopology& topology);

/// Frames from time 0 to `duration` (s), both included where a frame falls on them.
double count_frames(double duration, double frames_per_second);

/// Steps when each interval between frames, `jumps` (s, ascending) and the end is divided into
/// ceil(interval / step - 1e-9) equal steps. Linear in frames and jumps: count the frames first.
double count_steps(double duration, double step, double frames_per_second, const std::vector<double>& jumps);

/// Counts the elements of the obstacles.
void add_obstacles(const std::vector<Obstacle>& obstacles, SceneEstimate& estimate);

/// Fills `memory_bytes` and `disk_bytes` from the counts, for the given output formats.
void estimate_bytes(const std::vector<std::string>& formats, SceneEstimate& estimate);

/// What a run asks too much of, and how much there is, in words.
struct Excess {
    std::string wrong, allowed;
};

/// Empty where the expected memory fits into `available` bytes.
std::optional<Excess> find_memory_excess(const SceneEstimate& estimate, double available);

/// Physical memory of this machine; infinity where the system does not tell.
double machine_memory_bytes();

/// "1.5 GB".
std::string human_bytes(double bytes);

}  // namespace arris
