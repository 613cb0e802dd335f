// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "app/scene/keys/scene_document.h"
#include "app/scene/parts/run_config.h"
#include "geometry/obstacle/deformation.h"
#include "geometry/obstacle_input/obstacle_file.h"
#include "geometry/rigid_motion.h"

namespace arris {

/// Reads the samples of the `index`-th obstacle in `config.as_run` once, and stores them as poses of `mesh`,
/// which is scaled. They are stored in a temporary file, of which the run's folder gets a copy. So memory
/// stays bounded, a check writes into no folder of the user, and a source that changes during the run does no
/// harm. Times that nearly coincide with events, also those of `motions` of obstacles not yet in the scene,
/// are merged with them. Adds a note that says what was read, and warnings. Throws InputError naming the key.
std::shared_ptr<const Deformation> load_deformation(const SceneDocument& document, std::size_t index,
                                                    const ObstacleFile& mesh,
                                                    const std::vector<RigidMotion>& motions,
                                                    RunConfig& config);

}  // namespace arris
