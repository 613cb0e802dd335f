// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>

#include "app/files/frame.h"

namespace arris {

/// The frames of a run, in order of time. Formats read them one by one, so that memory does not grow with
/// their number.
struct FrameSource {
    std::size_t count = 0;
    std::function<Frame(std::size_t)> read;  ///< frame i < count; throws InputError for an invalid file
};

/// The frames in run_dir/frames, as the run wrote them. Throws InputError naming a frame that is missing
/// before a later one.
FrameSource read_frames_of(const std::string& run_dir);

}  // namespace arris
