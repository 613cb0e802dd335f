// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/model/constraint_cause.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"
#include "solver/workspace.h"

namespace arris {

/// Counts of the contacts that press on sharp edges, corners, wires and points at a step's end.
struct FeatureCensus {
    int eol = 0;                  ///< EOL vertices that press
    int rows = 0;                 ///< other pressing contacts, also of single vertices
    ConstraintCounts by_cause{};  ///< `rows` by cause; zero in a scene without EOL vertices
};

/// Counts for a solved step from `state`, before its commit. `multiplier` has one entry a contact of the
/// workspace (N s).
FeatureCensus take_census(const Scene& scene, const State& state, const Workspace& work,
                          const std::vector<double>& multiplier);

/// Whether a contact touches a sharp feature. Its point must lie on one, as cloth edges and faces also touch
/// edges and vertices of a smooth obstacle. The plane of a vertex's contact must not be that of a face.
bool touches_feature(const Obstacle& obstacle, const Contact& contact, double thickness);

}  // namespace arris
