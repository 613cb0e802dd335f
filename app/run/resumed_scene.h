// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/run/checkpoint.h"
#include "app/scene/parts/run_config.h"

namespace arris {

/// Checks indices of a checkpoint, which is untrusted, against its scene. Throws InputError naming the
/// checkpoint's file, `name`.
void check_references(const std::string& name, const Checkpoint& checkpoint, const Scene& scene);

/// Gives a scene the end `until`, s. Throws InputError unless it is later than the time that was `reached`,
/// s.
void set_end(double until, double reached, SceneSource& source);

/// Loads the scene of a checkpoint in `directory` with the cloth that it has at present, as needed to go on
/// with an assembly. `obstacles`: of the scene.
RunConfig load_stored(const std::string& directory, const Checkpoint& checkpoint,
                      const std::vector<ObstacleRecord>& obstacles);

/// The scene of `source` with its cloth as a finished assembly has left it; `unsewn`: before that. Throws
/// InputError where pins move that cloth through something at time 0.
RunConfig load_sewn(const SceneSource& source, const Checkpoint& sewn, const RunConfig& unsewn);

/// Loads the scene of a checkpoint in `directory`, with the end `until` if given. If the new end changes the
/// current interval of the timeline, the rest of the run is planned anew from the checkpoint's time. Where
/// another BLAS kernel than this process has made the steps so far, a warning says so.
RunConfig load_resumed(const std::string& directory, const std::optional<double>& until,
                       Checkpoint& checkpoint);

}  // namespace arris
