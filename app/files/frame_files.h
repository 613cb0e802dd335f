// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

namespace arris {

/// Where a run keeps its frames: <run_dir>/frames.
std::string frames_directory(const std::string& run_dir);

/// <run_dir>/frames/cloth_%05d.<extension>; more digits where five do not do. `name`: of an obstacle, instead
/// of the cloth.
std::string frame_file(const std::string& run_dir, std::int64_t index, const std::string& extension,
                       const std::string& name = "cloth");

/// How many frames (cloth_%05d.ply) a run has; 0 if none. InputError naming the file if one is missing
/// between.
std::int64_t count_frames(const std::string& run_dir);

}  // namespace arris
