// SPDX-License-Identifier: GPL-3.0-or-later
// Implicit Euler, q' = q + h v', and variable-step BDF2: with w = h_k / h_(k-1),
//
//   q~ = ((1+w)^2 q_k - w^2 q_(k-1)) / (1+2w),   v~ alike,   gamma = h (1+w)/(1+2w),   q' = q~ + gamma v'.
//
// Forces are linearised at q^ = q~ + gamma v^ with v^ = v_k (BDF2) or 0 (implicit Euler): at q~ any stiffness
// that is not the true Hessian would make BDF2 first order, as q' - q~ is O(h) where q' - q^ is O(h^2).
#pragma once

#include <vector>

#include "solver/model/settings.h"
#include "solver/model/state.h"

namespace arris {

/// Where a step starts from, one entry a vertex.
struct Prediction {
    double gamma = 0.0;                   ///< s
    bool has_history = false;             ///< BDF2 with a step behind it; else implicit Euler
    double ratio = 0.0;                   ///< of this step to the last
    double forward = 0.0;                 ///< q~ = q_k + forward (q_k - q_(k-1))
    std::vector<Vec3> position;           ///< q~, m
    std::vector<Vec3> velocity;           ///< v~, m/s
    std::vector<Vec2> material;           ///< X~, m
    std::vector<Vec2> material_velocity;  ///< V~, m/s
};

/// Velocities of vertices, m/s; `material` is that with which their material coordinates move.
struct ClothVelocity {
    std::vector<Vec3> world;
    std::vector<Vec2> material;
};

/// `share` of the way from one to the other.
ClothVelocity blend(const ClothVelocity& from, const ClothVelocity& to, double share);

/// The cloth's vertices at one moment, in the world and in the material, and how they move.
struct MovingCloth {
    std::vector<Vec3> world;     ///< m
    std::vector<Vec2> material;  ///< m
    ClothVelocity velocity;
};

/// Where a step ends with this velocity: q' = q~ + gamma v'.
MovingCloth find_end(const Prediction& prediction, const ClothVelocity& velocity);

/// Where the cloth would be at the step's end by its past alone; implicit Euler: as it is.
MovingCloth extrapolate(const State& state, const Prediction& prediction);

/// Whether a step of `dt` (s) has one behind it that BDF2 can use: there is none after a jump, and after one
/// so short variable-step BDF2 were not stable.
bool has_past(const State& state, double dt);

/// BDF2 is implicit Euler where it has no past.
Prediction predict(const State& state, Integrator integrator, double dt);

}  // namespace arris
