// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "app/scene/keys/scene_document.h"
#include "app/scene/parts/run_config.h"

namespace arris {

/// Makes or reads the pieces of cloth of `config.as_run`, folds them, places them in the world and lays their
/// material out: `config.cloth`, `config.pieces` with a piece for each panel, seams and labels. Adds warnings
/// and notes to `config`. Throws InputError, also where the run would take more vertices or memory than is
/// allowed.
void make_scene_cloth(const SceneDocument& document, RunConfig& config);

/// The cloth and the pieces' places of a resumed run. Throws InputError where they are not those of the
/// scene.
void take_scene_cloth(const LoadOptions& options, RunConfig& config);

/// Mean edge length of each piece, m.
std::vector<double> mean_edges(const RunConfig& config);

}  // namespace arris
