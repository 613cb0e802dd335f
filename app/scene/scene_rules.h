// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>

#include "app/scene/keys/scene_document.h"

namespace arris {

/// Applies the rules between keys to a scene from complete_scene: fills in defaults that depend on other keys
/// (title, material, names of obstacles), refuses keys that contradict each other, and removes keys that
/// others exclude (`pattern` beside a cloth file). Throws InputError.
void apply_scene_rules(const SceneDocument& document, nlohmann::ordered_json& scene);

}  // namespace arris
