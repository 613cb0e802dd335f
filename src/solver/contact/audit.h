// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/check/penetration.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

struct Audit {
    int obstacle = -1;  ///< index in the scene; -1 without penetration
    Penetration found;  ///< in that obstacle; `place` in the world
};

/// Pairs of faces of the cloth that cross or touch each other; none without self-contact in the scene.
struct SelfCrossings {
    int count = 0;
    Vec3 place = Vec3::Zero();          ///< of the first pair
    std::array<int, 2> pieces = {0, 0};  ///< of cloth, likewise
};
SelfCrossings find_self_crossings(const Scene& scene, const ClothMesh& mesh);

/// Every obstacle that contains cloth at `time` (s). Classifies the surface anew and ignores the cloth's
/// motion, so that errors of a step's own check are found.
std::vector<Audit> find_penetrations(const Scene& scene, const ClothMesh& mesh, double time);

/// As above for a state, whose cloth may touch wires and points beside the EOL vertices on them.
std::vector<Audit> find_penetrations(const Scene& scene, const State& state);

/// The deepest penetration.
Audit audit(const Scene& scene, const ClothMesh& mesh, double time);
Audit audit(const Scene& scene, const State& state);

}  // namespace arris
