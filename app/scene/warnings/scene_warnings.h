// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "app/scene/keys/scene_document.h"
#include "app/scene/parts/run_config.h"
#include "app/scene/parts/start_strain.h"

namespace arris {

/// Warnings, one line each: written keys that are valid but have no effect in this scene, and keys with a
/// surprising effect. `placed`: strain of each piece as the scene places it, before it is moved out to its
/// stand-off.
std::vector<std::string> find_ineffective_keys(const SceneDocument& document, const RunConfig& config,
                                               const std::vector<StrainRange>& placed);

}  // namespace arris
