// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "app/export/viewer_meta.h"
#include "app/scene/parts/obstacle_records.h"

namespace arris {

/// Stores the meshes of the obstacles that fit into half of `most_bytes`, in their order. An obstacle that
/// deforms must fit with its points in the first and the last frame, which every page has; the latter is at
/// `last_time` (s). Frames hold the points themselves.
void store_meshes(const std::vector<ObstacleRecord>& obstacles, std::size_t most_bytes, double last_time,
                  ViewerBlocks& blocks);

/// The points at `time` (s) of those meshes that deform.
std::map<std::size_t, ViewerPoseBlock> make_pose_blocks(const std::vector<ViewerMeshBlock>& meshes,
                                                        double time);

}  // namespace arris
