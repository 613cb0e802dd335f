// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "app/scene/parts/run_config.h"

namespace arris {

/// An effect, and why this scene does or does not simulate it.
struct SceneEffect {
    std::string name;  ///< as in report.json
    bool is_on = false;
    std::string reason;  ///< "[gravity] is given"; "no [wind]"
};

/// All effects: bending, damping, gravity, wind, pull, pin, obstacle, eol, remesh, friction, self_contact.
std::vector<SceneEffect> list_effects(const RunConfig& config);

/// Whether the effect of that name is among them and simulated.
bool is_on(const std::vector<SceneEffect>& effects, std::string_view name);

}  // namespace arris
