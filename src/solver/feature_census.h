// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/model/row_cause.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"
#include "solver/workspace.h"

namespace arris {

/// What presses on sharp edges, corners, wires and points at a step's end.
struct FeatureCensus {
    int eol = 0;           ///< EOL vertices
    int rows = 0;          ///< other contacts, also of vertices that touch a feature
    RowCounts by_cause{};  ///< of these rows, where the scene has EOL vertices; else zero
};

/// Of a solved step from `state`, before it is committed; `multiplier` is of each of the workspace's
/// contacts.
FeatureCensus take_census(const Scene& scene, const State& state, const Workspace& work,
                          const std::vector<double>& multiplier);

/// Whether a contact touches a sharp feature: its point is on one (edges and faces of the cloth touch a
/// smooth obstacle's edges and vertices, too), and the plane of a vertex's contact is none of a face.
bool touches_feature(const Obstacle& obstacle, const ObstacleContact& contact, double thickness);

}  // namespace arris
