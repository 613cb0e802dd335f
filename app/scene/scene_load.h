// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "app/scene/parts/obstacle_records.h"
#include "app/scene/parts/run_config.h"

namespace arris {

/// Reads a scene file. Throws InputError if it is missing, not a regular file, or larger than 16 MiB.
SceneSource read_scene_source(const std::string& path, const std::vector<std::string>& overrides);

/// Loads and validates a scene with its overrides. Throws InputError.
RunConfig load_scene(const SceneSource& source, const LoadOptions& options = {});
inline RunConfig load_scene(const std::string& path, const std::vector<std::string>& overrides,
                            const LoadOptions& options = {})
{
    return load_scene(read_scene_source(path, overrides), options);
}

/// The obstacles of a run in the form in which the run stores them.
std::vector<ObstacleRecord> record_obstacles(const RunConfig& config);

}  // namespace arris
