// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/run/timeline.h"
#include "app/scene/run_config.h"
#include "solver/model/state.h"

namespace arris {

/// All that `resume` needs. Holds no seconds, so that a resumed run's equals one run through to the byte.
struct Checkpoint {
    SceneSource source;
    std::vector<std::string> warnings;  ///< of loading the scene
    State state;
    TimelinePosition position;
    std::int64_t frames = 0;  ///< written so far
    std::int64_t rows = 0;    ///< rows of steps.csv and probes.csv so far
};

/// Replaces the file atomically. std::system_error naming the path where the disk refuses.
void write_checkpoint(const std::string& path, const Checkpoint& checkpoint);

/// Untrusted input: InputError naming the file if it is not a checkpoint, of another version (named),
/// truncated, damaged (a checksum), or holds a state that cannot be one. Lengths are checked before
/// allocating.
Checkpoint read_checkpoint(const std::string& path);

}  // namespace arris
