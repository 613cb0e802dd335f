// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/time_integration.h"

namespace arris {

Prediction predict(const State& state, Integrator integrator, double dt)
{
    Prediction prediction;
    constexpr double kGreatestRatio =
        2.4142135623730951;  // 1 + sqrt 2: beyond, variable-step BDF2 is not zero-stable
    prediction.has_history = integrator == Integrator::Bdf2 && dt <= kGreatestRatio * state.previous_dt;
    if (!prediction.has_history) {
        prediction.gamma = dt;
        prediction.position = state.mesh.world;
        prediction.velocity = state.velocity;
        return prediction;
    }

    // ((1+w)^2 a_k - w^2 a_(k-1)) / (1+2w) = a_k + w^2 / (1+2w) (a_k - a_(k-1))   exact for a resting vertex
    const double w = dt / state.previous_dt;
    const double forward = w * w / (1.0 + 2.0 * w);
    prediction.forward = forward;
    prediction.gamma = dt * (1.0 + w) / (1.0 + 2.0 * w);
    const std::size_t n = state.mesh.world.size();
    prediction.position.resize(n);
    prediction.velocity.resize(n);
    for (std::size_t v = 0; v < n; ++v) {
        prediction.position[v] =
            state.mesh.world[v] + forward * (state.mesh.world[v] - state.previous_world[v]);
        prediction.velocity[v] =
            state.velocity[v] + forward * (state.velocity[v] - state.previous_velocity[v]);
    }
    return prediction;
}

}  // namespace arris
