// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "app/scene/parts/run_config.h"

namespace arris {

/// A line that says how many vertices the cloth of a scene will have, to be printed before load_scene; none
/// where its mesh is made in a moment, or read from a file. Throws InputError as load_scene does.
std::optional<std::string> forecast_long_meshing(const SceneSource& source);

}  // namespace arris
