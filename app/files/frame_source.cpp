// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/files/frame_source.h"

#include "app/files/frame_files.h"

namespace arris {

FrameSource read_frames_of(const std::string& run_dir)
{
    return {static_cast<std::size_t>(count_frames(run_dir)), [run_dir](std::size_t i) {
                return read_frame(frame_file(run_dir, static_cast<std::int64_t>(i), "ply"));
            }};
}

}  // namespace arris
