// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace arris {

/// What the formats made from frames need to know about their run.
struct ExportOptions {
    std::string title;
    double frames_per_second = 24.0;  ///< > 0
};

/// Where a format's files are: a file, or the folder of one a frame.
std::string exported_path(const std::string& run_dir, const std::string& format);

/// InputError, naming the format and what is allowed, unless every one can be made by export_frames.
void require_known_formats(const std::vector<std::string>& formats);

/// Makes "obj", "usd", "viewer" from the frames in run_dir/frames and the obstacles in run_dir/obstacles,
/// each whole or absent. InputError for an unknown format, a run without frames or a bad frame file;
/// std::system_error where the disk refuses.
void export_frames(const std::string& run_dir, const std::vector<std::string>& formats,
                   const ExportOptions& options);

}  // namespace arris
