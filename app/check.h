// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "app/scene/run_config.h"

namespace arris {

/// What `arris check` says of a scene, one line an entry, fit for a terminal: sizes, the mesh's edges,
/// material, obstacles with their sharp features against these edges and what intersects them at time 0,
/// effects and why, what pins, pulls and probes meet, steps, frames, expected memory and disk, warnings.
/// Writes nothing.
std::vector<std::string> describe_scene(const RunConfig& config);

}  // namespace arris
