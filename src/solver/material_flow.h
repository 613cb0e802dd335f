// SPDX-License-Identifier: GPL-3.0-or-later
// Flow of material through EOL vertices in a step. No face beside them may turn over or lose more than
// kMostFaceTaken of its material. A strain that changes more than one linearisation can follow raises the
// energy, and forces are then linearised again (relinearization.h). So a fast but steady flow, as over an
// edge, needs no shorter step.
#pragma once

#include "solver/eol/eol_coordinates.h"
#include "solver/mesh_change/mesh_cache.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"
#include "solver/model/time_integration.h"
#include "solver/retry_policy.h"

namespace arris {

/// Number of equal parts, at most 4, in which a step of `dt` (s) is made. No part then takes more material
/// than cells usually have to give. Depends only on the state.
int find_flow_parts(const Scene& scene, const State& state, double dt);

/// EOL vertices of faces that would turn over in `dt` (s), or keep too little of their material at the step's
/// start for a meaningful strain: one entry a face. `material`: of all vertices at the step's end, m. `mesh`
/// belongs to the step's start. Whether one linearisation can follow the flow is judged by the energy balance
/// instead.
std::vector<Overrun> find_overrun(const std::vector<Vec2>& material, const std::vector<EolCoordinates>& eol,
                                  const MeshCache& mesh, double dt);

/// Material around which forces are linearised, and the v^ that belongs to it.
struct LinearisedFlow {
    ClothVelocity expansion;
    std::vector<Vec2> position;  ///< X^, m
    ExtrapolatedState extrapolated;
    std::vector<Overrun> overrun;  ///< vertices that leave too little material even so
};

/// The flow of a part of a step of `dt` (s), at q^ = q~ + gamma `expansion` and at the extrapolated state.
/// The part ends at neither. So vertices that would leave too little material there go back on their way,
/// both in the world and in the material. Even this leaves too little where a value is not finite.
LinearisedFlow linearise_flow(const State& state, const Prediction& prediction, ClothVelocity expansion,
                              const std::vector<EolCoordinates>& eol, const MeshCache& mesh, double dt);

/// Material of all vertices, m, and its velocity, m/s.
struct FlowedMaterial {
    std::vector<Vec2> material, velocity;
};

/// X' = X~ + gamma V' of the solved `velocity` (coordinates of the solve, three a vertex).
FlowedMaterial find_flowed_material(const Prediction& prediction, const std::vector<EolCoordinates>& eol,
                                    const Eigen::VectorXd& velocity);

}  // namespace arris
