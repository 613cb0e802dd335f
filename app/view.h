// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace arris {

/// Makes the viewer.html of the run in `run_dir` unless there is one as new as the last frame, prints its
/// path and opens it with xdg-open. Without a display or without xdg-open, it says so. Throws InputError if
/// `run_dir` holds no run or no frames, std::system_error if writing fails.
void view(const std::string& run_dir);

}  // namespace arris
