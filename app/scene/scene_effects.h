// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "app/scene/run_config.h"

namespace arris {

/// An effect a scene can have, and why it is or is not simulated in this one.
struct SceneEffect {
    std::string name;  ///< as report.json has it
    bool is_on = false;
    std::string reason;  ///< "[gravity] is there"; "no [wind]"
};

/// All effects: bending, damping, gravity, wind, pull, pin, obstacle, eol, remesh, friction, self_contact.
std::vector<SceneEffect> list_effects(const RunConfig& config);

}  // namespace arris
