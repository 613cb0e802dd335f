// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "app/scene/keys/scene_document.h"
#include "app/scene/parts/run_config.h"

namespace arris {

/// Moves the cloth where it crosses itself or an obstacle at time 0 and the scene says `start = "untangle"`.
/// Adds a warning with what was moved. Returns how many pairs cross still, in words; "" if none.
std::string untangle_start(const SceneDocument& document, RunConfig& config);

}  // namespace arris
