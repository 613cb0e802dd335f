// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/export/resampled_frames.h"
#include "app/export/up_axis.h"

namespace arris {

/// Properties of the run that exported formats need.
struct ExportOptions {
    std::string title;
    double frames_per_second = 24.0;    ///< > 0
    bool is_topology_constant = false;  ///< every format is made from resampled_frames
    std::optional<GridSize> grid = {};  ///< of the constant mesh; without it, the first frame's mesh
    UpAxis up = UpAxis::Z;              ///< of formats that state no axis of their own
    bool is_overwriting = false;        ///< whether files of other content may be replaced
};

/// Path of a format's file, or a pattern where there is one file per frame.
std::string exported_path(const std::string& run_dir, const std::string& format);

/// Throws InputError naming the format and the allowed ones unless export_frames supports all of them.
void require_known_formats(const std::vector<std::string>& formats);

/// Makes formats from the frames in run_dir/frames and the obstacles in run_dir/obstacles; each file is
/// written atomically. "pc2", "mdd" and "gltf" always have constant topology.
///
/// By default the files are those that the run itself makes of a format, and replace them. With another
/// topology, grid or axis a file that is there is replaced only if `is_overwriting`.
///
/// Throws InputError for an unknown format, a viewer of constant topology, a grid that no format uses, y up
/// for a format that states its axis, a file that may not be replaced, a run without frames or an invalid
/// frame file, std::system_error if writing fails.
void export_frames(const std::string& run_dir, const std::vector<std::string>& formats,
                   const ExportOptions& options);

}  // namespace arris
