// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>

#include "app/scene/keys/scene_document.h"

namespace arris {

/// The scene with every default filled in, in the order of the table of keys. Each value of `document` is
/// checked by itself: known, built, of the right type, finite, in range. Rules between keys are left to
/// apply_scene_rules: a default that depends on other keys is null here, and so is a time "never". Throws
/// InputError.
nlohmann::ordered_json complete_scene(const SceneDocument& document);

}  // namespace arris
