// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

namespace arris {

/// The folder of a run's frames: <run_dir>/frames.
std::string frames_directory(const std::string& run_dir);

/// <run_dir>/frames/<name>_%05d.<extension>, with more digits where five do not suffice. `name`: "cloth" or
/// the name of an obstacle.
std::string frame_file(const std::string& run_dir, std::int64_t index, const std::string& extension,
                       const std::string& name = "cloth");

/// Number of frames (cloth_%05d.ply) of a run. Throws InputError naming a frame that is missing before a
/// later one.
std::int64_t count_frames(const std::string& run_dir);

/// Throws the InputError of a run without frames.
[[noreturn]] void refuse_no_frames(const std::string& run_dir);

}  // namespace arris
