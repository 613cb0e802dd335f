// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "app/scene/parts/run_config.h"

namespace arris {

/// The output of `arris check`, one printable line per entry: size and material of the cloth, edges of its
/// mesh, obstacles with their sharp features relative to these edges and intersections at time 0, effects
/// with reasons and effects whose absence would show, vertices of pins and pulls, faces of probes, steps,
/// frames, expected memory and disk space, and notes. Warnings are in `config`.
std::vector<std::string> describe_scene(const RunConfig& config);

}  // namespace arris
