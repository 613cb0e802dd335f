// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "app/run/friction_warning.h"
#include "app/run/strain_warnings.h"
#include "app/run/timeline.h"
#include "app/scene/parts/run_config.h"
#include "solver/model/state.h"

namespace arris {

/// A pin or an obstacle of the scene.
struct Mover {
    bool is_pin = false;
    std::int32_t index = 0;

    bool operator==(const Mover&) const = default;
};

/// A motion that a caller gave to a pin or an obstacle, in place of the scene's.
struct GivenMotion {
    Mover mover;
    std::vector<Keyframe> keyframes;       ///< of the last step that it was moved in; none before the first
    bool is_driven = false;                ///< goes on with the velocities below at each step
    Vec3 velocity = Vec3::Zero();          ///< m/s, of `pivot`
    Vec3 angular_velocity = Vec3::Zero();  ///< rad/s, about `pivot`
    Vec3 pivot = Vec3::Zero();             ///< m, world, where it is at `pivot_time`
    double pivot_time = 0.0;               ///< s
    bool is_jump = false;                  ///< whether the velocities are new since the last step
    Vec3 last_velocity = Vec3::Zero();     ///< m/s, of the frame's origin in the last step
    Vec3 last_turn = Vec3::Zero();         ///< rad/s, likewise
};

/// The part of a checkpoint that changes from step to step.
struct RunProgress {
    State state;
    TimelinePosition position;
    std::int64_t frames = 0;         ///< written so far
    std::int64_t rows = 0;           ///< rows of steps.csv and probes.csv so far
    StrainPeaks strain;              ///< of the rows so far
    FrictionPeak friction;           ///< of the rows so far
    std::int64_t touching_rows = 0;  ///< rows so far in which the cloth touches an obstacle
    double gamma = 0.0;  ///< s: multipliers of the last part divided by it are forces, N; 0 without one
    std::vector<GivenMotion> given;
};

/// The input of `resume`. Contains no wall times, so that checkpoints of a resumed and an uninterrupted run
/// are identical.
struct Checkpoint : RunProgress {
    SceneSource source;
    std::vector<std::string> warnings;  ///< from loading the scene and from resuming
    std::string kernel;                 ///< BLAS kernel of the last step
    std::vector<ClothPiece> pieces;     ///< their names, places and sizes
    std::vector<OpenSeam> seams;        ///< as the scene's sewing has them
    std::vector<SceneLabel> labels;
    double assembly_duration = 0.0;  ///< s, of an assembly; 0 of any other run
};

/// A checkpoint file's contents.
std::string to_bytes(const Checkpoint& checkpoint);

/// The checkpoint of these contents, as read_checkpoint; `name` stands for the file in errors.
Checkpoint parse_checkpoint(std::string_view bytes, const std::string& name);

/// Replaces the file atomically. Throws std::system_error naming the path if writing fails.
void write_checkpoint(const std::string& path, const Checkpoint& checkpoint);

/// Reads a checkpoint. The file is untrusted: throws InputError naming it if it is not a checkpoint, of
/// another version, truncated, damaged (checksum), or holds an invalid state. Lengths are checked before
/// memory is allocated.
Checkpoint read_checkpoint(const std::string& path);

}  // namespace arris
