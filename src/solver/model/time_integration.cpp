// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/model/time_integration.h"

#include <numbers>

namespace arris {

bool has_past(const State& state, double dt)
{
    return dt <= (1.0 + std::numbers::sqrt2) * state.previous_dt;  // beyond, BDF2 is not zero-stable
}

Prediction predict(const State& state, Integrator integrator, double dt)
{
    Prediction prediction;
    prediction.has_history = integrator == Integrator::Bdf2 && has_past(state, dt);
    prediction.position = state.mesh.world;
    prediction.velocity = state.velocity;
    prediction.material = state.mesh.material;
    prediction.material_velocity = state.material_velocity;
    prediction.gamma = dt;
    if (!prediction.has_history) return prediction;

    // ((1+w)^2 a_k - w^2 a_(k-1)) / (1+2w) = a_k + w^2 / (1+2w) (a_k - a_(k-1))   exact for a resting vertex
    const double w = dt / state.previous_dt;
    const double forward = w * w / (1.0 + 2.0 * w);
    prediction.ratio = w;
    prediction.forward = forward;
    prediction.gamma = dt * (1.0 + w) / (1.0 + 2.0 * w);
    const auto extrapolate = [forward](auto& now, const auto& previous) {
        for (std::size_t v = 0; v < now.size(); ++v) now[v] += forward * (now[v] - previous[v]);
    };
    extrapolate(prediction.position, state.previous_world);
    extrapolate(prediction.velocity, state.previous_velocity);
    if (state.eol.empty()) return prediction;
    extrapolate(prediction.material, state.previous_material);
    extrapolate(prediction.material_velocity, state.previous_material_velocity);
    return prediction;
}

ClothVelocity blend(const ClothVelocity& from, const ClothVelocity& to, double share)
{
    ClothVelocity between = from;
    for (std::size_t v = 0; v < between.world.size(); ++v)
        between.world[v] = (1.0 - share) * from.world[v] + share * to.world[v];
    for (std::size_t p = 0; p < between.material.size(); ++p)
        between.material[p] = (1.0 - share) * from.material[p] + share * to.material[p];
    return between;
}

MovingCloth find_end(const Prediction& prediction, const ClothVelocity& velocity)
{
    MovingCloth end{prediction.position, prediction.material, velocity};
    for (std::size_t v = 0; v < end.world.size(); ++v) end.world[v] += prediction.gamma * velocity.world[v];
    for (std::size_t p = 0; p < end.material.size(); ++p)
        end.material[p] += prediction.gamma * velocity.material[p];
    return end;
}

MovingCloth extrapolate(const State& state, const Prediction& prediction)
{
    if (!prediction.has_history)
        return {state.mesh.world, state.mesh.material, {state.velocity, state.material_velocity}};
    ClothVelocity velocity{state.velocity, state.material_velocity};
    for (std::size_t v = 0; v < velocity.world.size(); ++v)
        velocity.world[v] += prediction.ratio * (state.velocity[v] - state.previous_velocity[v]);
    for (std::size_t p = 0; p < velocity.material.size(); ++p)
        velocity.material[p] +=
            prediction.ratio * (state.material_velocity[p] - state.previous_material_velocity[p]);
    return find_end(prediction, velocity);
}

}  // namespace arris
