// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/check/penetration.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

struct Audit {
    int obstacle = -1;  ///< index in the scene; -1 where the cloth is free of all
    Penetration found;  ///< of that obstacle; `place` in the world
};

/// Every obstacle that the cloth is in at `time` (s). Classifies the surface anew and knows nothing of how it
/// got there, so it finds what a step's own check would have missed.
std::vector<Audit> find_penetrations(const Scene& scene, const ClothMesh& mesh, double time);

/// The same of a state, whose cloth may touch wires and points beside vertices on them.
std::vector<Audit> find_penetrations(const Scene& scene, const State& state);

/// The deepest of them.
Audit audit(const Scene& scene, const ClothMesh& mesh, double time);
Audit audit(const Scene& scene, const State& state);

}  // namespace arris
