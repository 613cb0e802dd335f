// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>

#include "app/scene/scene_document.h"

namespace arris {

/// The rules between keys, for a scene that complete_scene returned: fills in the defaults that depend on
/// other keys (title, material, obstacles' names), refuses keys that contradict each other, and removes those
/// that the others exclude (a cloth file's `pattern`). Throws InputError.
void apply_scene_rules(const SceneDocument& document, nlohmann::ordered_json& scene);

}  // namespace arris
