// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "app/files/frame_source.h"
#include "app/scene/parts/obstacle_records.h"

namespace arris {

/// Metadata of a USD stage.
struct UsdOptions {
    std::string title;                ///< any text; the stage's documentation
    double frames_per_second = 24.0;  ///< > 0
};

/// Writes all frames as one text USD stage, atomically: z up, metres, time code i for frame i. The
/// default prim is Xform /arris. Below is Mesh /arris/cloth, with points, velocities (of the vertices, per
/// second) and extent at every time code, primvars:st at every time code if material coordinates ever change,
/// and faces at the time codes where they change. EOL edges are creases of infinite sharpness, sampled where
/// they change; subdivisionScheme is "none", so that they act only where an application subdivides. Before a
/// frame i whose vertices or faces are others than in frame i - 1, that frame is repeated at i - 0.000001: in
/// between the cloth is held, since it cannot be interpolated. Numbers read back to the same double. At most
/// two frames are in memory: the frame files are read once per attribute. Throws InputError for an invalid
/// frame file, std::system_error if writing fails.
///
/// Each obstacle is an Xform /arris/obstacles/<name>. Its xformOp:transform is sampled at every time code if
/// the obstacle moves; between samples USD interpolates matrices linearly, which is not rigid. Below are, as
/// needed, a Mesh "surface", linear BasisCurves "wires" and Points "points", in the obstacle's frame. Where
/// the obstacle deforms, their points, velocities and extent are sampled at every time code. Wires and points
/// are 2 mm wide, since USD has no lines without a width.
void write_usd(const std::string& path, const FrameSource& frames, const UsdOptions& options,
               const std::vector<ObstacleRecord>& obstacles = {});

}  // namespace arris
