// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "app/scene/run_config.h"
#include "app/scene/scene_document.h"
#include "app/scene/start_strain.h"

namespace arris {

/// One line for each key that is written, valid, and can have no effect in this scene, or one that surprises.
/// `placed`: how the cloth is strained where the scene places it, before it keeps its stand-off.
std::vector<std::string> find_ineffective_keys(const SceneDocument& document, const RunConfig& config,
                                               const StrainRange& placed);

}  // namespace arris
