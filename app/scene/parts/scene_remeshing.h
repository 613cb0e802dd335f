// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "app/scene/keys/scene_document.h"
#include "app/scene/parts/run_config.h"
#include "solver/model/remeshing.h"

namespace arris {

/// Reads the table [remesh] of `config.as_run`; `config.cloth` is the first mesh. Throws InputError if no
/// edge of the cloth can be as long as the smallest edge length.
Remeshing to_remeshing(const SceneDocument& document, const RunConfig& config);

}  // namespace arris
