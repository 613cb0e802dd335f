// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/scene/obstacle_records.h"

namespace arris {

struct ViewerOptions {
    std::string title;                ///< shown as text, whatever it holds
    double frames_per_second = 24.0;  ///< frame k is at time k / frames_per_second; positive, finite
    std::size_t most_bytes =
        72'000'000;  ///< of compressed frames; raising it costs the browser memory, 4/3 of it
};

/// Makes run_directory/viewer.html from run_directory/frames/cloth_%05d.ply: one page that shows the frames
/// in a browser, from disk and without a network (its source and data format: viewer/README.md). Linear in
/// the size of the frames; holds one frame and at most `most_bytes` of compressed ones. Where these do not
/// fit, every second, fourth, ... frame is left out (the last one never is), and the page says so. Positions
/// are kept to 1/65535 of the frame's bounding box in each direction, strains of the frame's range.
///
/// `obstacles` are stored once, in single precision about their centre, and a placement for each frame of
/// those that move. They take at most half of `most_bytes`: of the rest the page tells the names.
///
/// The page is replaced atomically: it is whole or as it was. Throws InputError naming the file where there
/// is no frame, one is missing between others, or one cannot be read; std::system_error naming the path where
/// the disk refuses.
void write_viewer(const std::string& run_directory, const ViewerOptions& options,
                  const std::vector<ObstacleRecord>& obstacles = {});

}  // namespace arris
