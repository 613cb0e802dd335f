// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/penetration.h"
#include "solver/scene.h"
#include "solver/state.h"

namespace arris {

struct Audit {
    int obstacle = -1;  ///< index in the scene; -1 where the cloth is free of all
    Penetration found;  ///< of that obstacle; `place` in the world
};

/// The deepest penetration of the cloth as it is. Classifies the surface anew and knows nothing of how the
/// steps got there, so it would find what their own check had missed.
Audit audit(const Scene& scene, const State& state);

}  // namespace arris
