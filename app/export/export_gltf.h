// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "app/files/frame_source.h"
#include "app/scene/parts/obstacle_records.h"

namespace arris {

/// Metadata of a glTF asset.
struct GltfOptions {
    std::string title;                ///< name of the scene
    double frames_per_second = 24.0;  ///< > 0
};

/// Writes all frames, at least one and all of one mesh, as one binary glTF 2.0 file, atomically: metres, y up
/// by the rotation of the root node "arris", below which z is up. Node "cloth" has the first frame's
/// positions, normals and material coordinates. Frame i > 0 is morph target i - 1, with differences of
/// positions and normals. The animation gives weight 1 to one target at the time of each frame, and weights
/// are linear in between. Each obstacle is a node; one that moves has a translation and rotation at the time
/// of each frame, by the shorter arc, and one that deforms has morph targets with differences of positions.
/// Frames are read twice, one at a time. Throws InputError for an invalid
/// frame, another mesh, or a file above 4 GiB; std::system_error if writing fails.
void write_gltf(const std::string& path, const FrameSource& frames, const GltfOptions& options,
                const std::vector<ObstacleRecord>& obstacles = {});

}  // namespace arris
