// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/model/state.h"
#include "solver/workspace.h"

namespace arris {

/// Impulse, N s, in the world, with which features hold their EOL vertices in the step from `state`; one
/// entry a vertex of the mesh, zero for other vertices. It includes the direction across the feature, in
/// which material flows, and friction. Normal impulses of other contacts of the vertex are left out.
/// `multiplier`: of `work.contacts`.
std::vector<Vec3> find_feature_impulses(const State& state, const std::vector<double>& multiplier,
                                        const Workspace& work);

/// Stores with each EOL vertex of `state`, which is at the step's start, the force of its feature.
void store_feature_forces(const std::vector<double>& multiplier, const Workspace& work, State& state);

}  // namespace arris
