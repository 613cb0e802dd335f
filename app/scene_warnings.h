// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "app/run_config.h"
#include "app/scene_document.h"

namespace arris {

/// One line for each key that is written, valid, and can have no effect in this scene.
std::vector<std::string> find_ineffective_keys(const SceneDocument& document, const RunConfig& config);

}  // namespace arris
