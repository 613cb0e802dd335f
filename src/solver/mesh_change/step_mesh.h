// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses the mesh that a step is made on, and rebuilds the data derived from it.
#pragma once

#include "solver/mesh_change/mesh_cache.h"
#include "solver/model/failed_flow.h"
#include "solver/model/planned_step.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"
#include "solver/model/step_report.h"

namespace arris {

/// The state that a step starts from, and whether its elements or creases have changed since the last step.
struct StepMesh {
    State& start;
    bool is_changed;
};

/// Chooses the mesh of the part of a step to `end` (s): `state` as it is, or `cache.conformed`, the state's
/// cloth on a mesh with EOL vertices where features press. Where the mesh stays and a vertex can no longer
/// have material coordinates, `cache.conformed` is the state with that flow stopped. Only the first part of
/// `planned` may remesh. `failed` holds the failures of earlier attempts at the step. On return, `cache`
/// belongs to the mesh chosen.
StepMesh choose_step_mesh(const Scene& scene, const PlannedStep& planned, double end,
                          const FailedFlow& failed, State& state, MeshCache& cache, StepReport& report);

/// Principal stretches of the state's faces. `cache` must belong to the state's mesh. Computed once for the
/// state, by whoever asks first.
const std::vector<Vec2>& find_stretches(const State& state, MeshCache& cache);

/// Rebuilds the data in `cache` that do not belong to the state's mesh. True where elements or creases have
/// changed.
bool update_mesh_cache(const Scene& scene, const State& state, MeshCache& cache);

}  // namespace arris
