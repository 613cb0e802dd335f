// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "app/run_config.h"

namespace arris {

/// An effect a scene can have, and why it is or is not simulated in this one.
struct SceneEffect {
    std::string name;  ///< as report.json has it
    bool is_on = false;
    std::string reason;  ///< "[gravity] is there"; "no [wind]"
};

/// All effects: bending, damping, gravity, wind, pull, pin, obstacle, eol, remesh, friction, self_contact.
std::vector<SceneEffect> list_effects(const RunConfig& config);

/// What `arris check` says of a scene, one line an entry, fit for a terminal: sizes, the mesh's edges,
/// material, obstacles with their sharp features against these edges and what intersects them at time 0,
/// effects and why, what pins, pulls and probes meet, steps, frames, expected memory and disk, warnings.
/// Writes nothing.
std::vector<std::string> describe_scene(const RunConfig& config);

}  // namespace arris
