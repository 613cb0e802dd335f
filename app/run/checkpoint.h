// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/run/friction_warning.h"
#include "app/run/strain_warnings.h"
#include "app/run/timeline.h"
#include "app/scene/parts/run_config.h"
#include "solver/model/state.h"

namespace arris {

/// The part of a checkpoint that changes from step to step.
struct RunProgress {
    State state;
    TimelinePosition position;
    std::int64_t frames = 0;  ///< written so far
    std::int64_t rows = 0;    ///< rows of steps.csv and probes.csv so far
    StrainPeaks strain;       ///< of the rows so far
    FrictionPeak friction;    ///< of the rows so far
};

/// The input of `resume`. Contains no wall times, so that checkpoints of a resumed and an uninterrupted run
/// are identical.
struct Checkpoint : RunProgress {
    SceneSource source;
    std::vector<std::string> warnings;  ///< from loading the scene and from resuming
    std::string kernel;                 ///< BLAS kernel of the last step
    std::vector<ClothPiece> pieces;     ///< their names, places and sizes
};

/// Replaces the file atomically. Throws std::system_error naming the path if writing fails.
void write_checkpoint(const std::string& path, const Checkpoint& checkpoint);

/// Reads a checkpoint. The file is untrusted: throws InputError naming it if it is not a checkpoint, of
/// another version, truncated, damaged (checksum), or holds an invalid state. Lengths are checked before
/// memory is allocated.
Checkpoint read_checkpoint(const std::string& path);

}  // namespace arris
