// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "app/files/frame.h"
#include "app/scene/parts/obstacle_records.h"

namespace arris {

struct ViewerOptions {
    std::string title;                ///< shown as plain text
    double frames_per_second = 24.0;  ///< frame k is at time k / frames_per_second; positive, finite
    std::size_t most_bytes =
        37'500'000;  ///< limit for compressed data; the page takes 4/3 of it in the browser
};

/// Makes run_directory/viewer.html from run_directory/frames/cloth_%05d.ply: one page that shows the frames
/// in a browser, from disk and without a network (source and data format: viewer/README.md). Linear in the
/// size of the frames. Memory: one frame and at most `most_bytes` of compressed frames. If the frames do not
/// fit, only every second, fourth, ... frame and the last one are kept, and the page says so. Positions are
/// quantised to 1/65535 of the frame's bounding box in each direction, material coordinates likewise, strains
/// to 1/65535 of the frame's range, speeds to 1/255 of the frame's greatest.
///
/// Meshes of `obstacles` are stored once, in single precision relative to their centre; a moving obstacle has
/// a placement for each frame. An obstacle that deforms has points for each frame, quantised like positions;
/// they count as part of the frame. Meshes, with the points of the first and the last frame, take at most
/// half of `most_bytes`. The page lists the names of obstacles that do not fit.
///
/// The page is replaced atomically. Throws InputError naming the file if there is no frame, a frame is
/// missing before a later one, or a frame cannot be read; std::system_error naming the path if writing fails.
void write_viewer(const std::string& run_directory, const ViewerOptions& options,
                  const std::vector<ObstacleRecord>& obstacles = {});

/// One frame, the obstacles then, and meshes in the world that the page marks: they shine through all else.
struct ViewerStill {
    std::string title;  ///< shown as plain text
    Frame frame;
    std::vector<ObstacleRecord> obstacles, marks;
};

/// Makes a page of one frame, at time 0, atomically. `first_line` is HTML, and precedes the page. Throws
/// InputError if the frame has no face or a number is too large for the page; std::system_error naming the
/// path if writing fails.
void write_viewer_still(const std::string& path, std::string_view first_line, const ViewerStill& still);

}  // namespace arris
