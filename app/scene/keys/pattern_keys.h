// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "app/scene/keys/scene_keys.h"

namespace arris {

/// Keys of a cloth that is sewn from panels, below "cloth": rows of the table of keys.
std::vector<SceneKey> pattern_keys();

}  // namespace arris
