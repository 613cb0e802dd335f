// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses the mesh that a step is made on, and rebuilds the data derived from it.
#pragma once

#include "solver/mesh_change/mesh_cache.h"
#include "solver/model/failed_flow.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"
#include "solver/model/step_report.h"

namespace arris {

/// The state that a step starts from, and whether its elements or creases differ from those of the last step.
struct StepMesh {
    State& start;
    bool is_changed;
};

/// Chooses the mesh of the step to `end` (s): `state` as it is, or `cache.conformed`, the same cloth on a
/// mesh with EOL vertices where features press. `failed` is what earlier attempts at the step have found out.
/// `cache` is up to date for the mesh chosen.
StepMesh choose_step_mesh(const Scene& scene, double end, const FailedFlow& failed, State& state,
                          MeshCache& cache, StepReport& report);

/// Rebuilds in `cache` what is not of the state's mesh; true where elements or creases have changed.
bool update_mesh_cache(const Scene& scene, const State& state, MeshCache& cache);

}  // namespace arris
