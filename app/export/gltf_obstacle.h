// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <string>

#include "app/export/gltf_asset.h"
#include "app/files/atomic_file.h"
#include "app/scene/parts/obstacle_records.h"

namespace arris {

/// The frames of an animation.
struct GltfTimeline {
    std::size_t frame_count;
    double frames_per_second;
    std::size_t times = 0, weights = 0;  ///< accessors of the animation, if there is more than one frame

    double time(std::size_t frame) const { return static_cast<double>(frame) / frames_per_second; }
};

/// x, y, z, w, as glTF stores rotations.
std::array<float, 4> to_float4(const Eigen::Quaterniond& rotation);

/// Adds the node of an obstacle, which is animated if the obstacle moves, and its mesh, which has morph
/// targets if the obstacle deforms; returns the node's index. Throws InputError naming `path` for a number
/// too large.
std::size_t add_gltf_obstacle(GltfAsset& asset, const std::string& path, const ObstacleRecord& obstacle,
                              const GltfTimeline& timeline, std::size_t material);

/// Writes the arrays that the morph targets of an obstacle stream; none if it does not deform.
void write_gltf_poses(AtomicFile& file, const std::string& path, const ObstacleRecord& obstacle,
                      const GltfTimeline& timeline);

}  // namespace arris
