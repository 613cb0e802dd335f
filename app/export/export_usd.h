// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "app/scene/obstacle_records.h"

namespace arris {

/// What a USD stage says about itself.
struct UsdOptions {
    std::string title;                ///< any text; it becomes the stage's documentation
    double frames_per_second = 24.0;  ///< > 0
};

/// All frames as one text USD stage: z up, metres, time code i for frame_paths[i]; one Mesh /cloth, the
/// default prim, with
/// points, velocities and extent at every time code, primvars:st likewise if material coordinates ever
/// change, and faces at the time codes where they change. Numbers read back to the same double. At most two
/// frames are held in memory: the frame files are read once for each attribute. Whole or absent. Throws
/// InputError for a bad frame file, std::system_error where the disk refuses.
///
/// Each obstacle is an Xform /<its name>, with an xformOp:transform that is sampled at every time code if it
/// moves (USD's linear interpolation of matrices between them is not rigid), above a Mesh "surface", linear
/// BasisCurves "wires" and Points "points", as far as it has them, in its own frame. Wires and points are
/// drawn 2 mm wide: USD has no lines without a width.
void write_usd(const std::string& path, const std::vector<std::string>& frame_paths,
               const UsdOptions& options, const std::vector<ObstacleRecord>& obstacles = {});

}  // namespace arris
