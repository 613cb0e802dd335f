// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/eol/stop_flow.h"

#include "physics/deformation_gradient.h"
#include "solver/model/pin_targets.h"

namespace arris {

void stop_flow(const ClothStars& stars, int vertex, State& state)
{
    if (state.material_velocity[vertex].isZero()) return;
    const std::vector<Vec2>& X = state.mesh.material;
    const std::vector<Vec3>& x = state.mesh.world;
    Vec3 carried = Vec3::Zero();
    double area = 0.0;
    for (const int f : stars.faces[vertex]) {
        const auto& [a, b, c] = state.mesh.faces[f];
        const double weight = twice_area(X[a], X[b], X[c]);
        const Mat32 F = deformation_gradient({X[a], X[b], X[c]}, {x[a], x[b], x[c]});
        carried += weight * (F * state.material_velocity[vertex]);
        area += weight;
    }
    state.velocity[vertex] -= carried / area;
    state.material_velocity[vertex].setZero();
}

void begin_history(int vertex, State& state)
{
    state.previous_world[vertex] = state.mesh.world[vertex] - state.previous_dt * state.velocity[vertex];
    state.previous_material[vertex] =
        state.mesh.material[vertex] - state.previous_dt * state.material_velocity[vertex];
    state.previous_velocity[vertex] = state.velocity[vertex];
    state.previous_material_velocity[vertex] = state.material_velocity[vertex];
}

void release_pinned(const Scene& scene, const ClothStars& stars, State& state)
{
    if (state.eol.empty()) return;
    for (const PinTarget& held : find_pin_targets(scene, state, state.time)) {
        const int entry = state.eol_entry(state.ids[held.vertex]);
        if (entry < 0) continue;
        stop_flow(stars, held.vertex, state);
        begin_history(held.vertex, state);
        state.eol.erase(state.eol.begin() + entry);
    }
}

}  // namespace arris
