// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>

#include "app/scene/keys/scene_document.h"
#include "app/scene/parts/run_config.h"
#include "geometry/obstacle/deformation.h"
#include "geometry/obstacle_input/obstacle_file.h"

namespace arris {

/// Reads the samples of the `index`-th obstacle in `config.as_run` once, and stores them as poses
/// of `mesh`, which is scaled. `origins`: of its points. They are stored in a temporary file, so that memory
/// stays bounded, a check writes into no folder of the user, and a file that changes during the run does no
/// harm; the run's folder gets a copy. Adds a note that says what was read, and warnings. Throws InputError
/// naming the key.
std::shared_ptr<const Deformation> load_deformation(const SceneDocument& document, std::size_t index,
                                                    const ObstacleMesh& mesh, const VertexOrigins& origins,
                                                    RunConfig& config);

}  // namespace arris
