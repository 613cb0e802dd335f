// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>

#include "app/scene/keys/scene_document.h"

namespace arris {

/// The part of apply_scene_rules for pieces of cloth and fabrics: each piece gets its name, one shape (size,
/// outline or file) and its material. Throws InputError.
void settle_pieces(const SceneDocument& document, nlohmann::ordered_json& scene);

}  // namespace arris
