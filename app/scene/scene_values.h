// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>

#include "app/scene/scene_document.h"

namespace arris {

/// The scene with every default written out, in the order of the table of keys: each value of `document`
/// checked by itself (known, built, of the right type, finite, in range), each absent one filled in. What
/// depends on several keys is load_scene's: there a default "(words)" stands as null, as does "never". Throws
/// InputError.
nlohmann::ordered_json complete_scene(const SceneDocument& document);

}  // namespace arris
