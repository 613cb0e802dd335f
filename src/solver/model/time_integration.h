// SPDX-License-Identifier: GPL-3.0-or-later
// Implicit Euler, q' = q + h v', and variable-step BDF2: with w = h_k / h_(k-1),
//
//   q~ = ((1+w)^2 q_k - w^2 q_(k-1)) / (1+2w),   gamma = h (1+w)/(1+2w),   q' = q~ + gamma v',
//
// and v~ is extrapolated with the formula of q~. Forces are linearised at q^ = q~ + gamma v^ with v^ = v_k
// (BDF2) or 0 (implicit Euler). At q~, any stiffness but the true Hessian would make BDF2 first order: q' -
// q~ is O(h), q' - q^ is O(h^2).
#pragma once

#include <vector>

#include "solver/model/settings.h"
#include "solver/model/state.h"

namespace arris {

/// The start of a step's equations, one entry a vertex.
struct Prediction {
    double gamma = 0.0;                   ///< s
    bool has_history = false;             ///< BDF2 with a previous step; else implicit Euler
    double ratio = 0.0;                   ///< length of this step over the last
    double forward = 0.0;                 ///< q~ = q_k + forward (q_k - q_(k-1))
    std::vector<Vec3> position;           ///< q~, m
    std::vector<Vec3> velocity;           ///< v~, m/s
    std::vector<Vec2> material;           ///< X~, m
    std::vector<Vec2> material_velocity;  ///< V~, m/s
};

/// Velocities of vertices, m/s, in the world and of their material coordinates.
struct ClothVelocity {
    std::vector<Vec3> world;
    std::vector<Vec2> material;
};

/// from + `share` (to - from).
ClothVelocity blend(const ClothVelocity& from, const ClothVelocity& to, double share);

/// The cloth's vertices at one moment, in the world and in the material, with their velocities.
struct MovingCloth {
    std::vector<Vec3> world;     ///< m
    std::vector<Vec2> material;  ///< m
    ClothVelocity velocity;
};

/// End of the step with this velocity: q' = q~ + gamma v'.
MovingCloth find_end(const Prediction& prediction, const ClothVelocity& velocity);

/// The cloth at the step's end, extrapolated from its history alone; with implicit Euler, the cloth of
/// `state`.
MovingCloth extrapolate(const State& state, const Prediction& prediction);

/// Whether BDF2 can use the step before a step of `dt` (s). False after a jump, and after a step so much
/// shorter that variable-step BDF2 would be unstable.
bool has_past(const State& state, double dt);

/// The prediction for a step of `dt` (s). BDF2 without history is implicit Euler.
Prediction predict(const State& state, Integrator integrator, double dt);

}  // namespace arris
