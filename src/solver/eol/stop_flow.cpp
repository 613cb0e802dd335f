// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/eol/stop_flow.h"

#include <vector>

#include "physics/elements/deformation_gradient.h"
#include "solver/eol/eol_coordinates.h"
#include "solver/model/pin_targets.h"

namespace arris {

void stop_flow(const ClothStars& stars, int vertex, State& state)
{
    if (state.material_velocity[vertex].isZero(0.0)) return;
    const std::vector<Vec3>& x = state.mesh.world;
    Vec3 carried = Vec3::Zero();
    double area = 0.0;
    for (const int f : stars.faces[vertex]) {
        const auto& [a, b, c] = state.mesh.faces[f];
        const std::array<Vec2, 3> X = state.mesh.corners(f);
        const double weight = twice_area(X);
        const Mat32 F = deformation_gradient(X, {x[a], x[b], x[c]});
        carried += weight * (F * state.material_velocity[state.mesh.point_of(vertex, f)]);
        area += weight;
    }
    state.velocity[vertex] -= carried / area;
    for (int p = vertex; p >= 0; p = stars.next_point(p)) state.material_velocity[p].setZero();
}

void begin_history(const ClothStars& stars, int vertex, State& state)
{
    state.previous_world[vertex] = state.mesh.world[vertex] - state.previous_dt * state.velocity[vertex];
    state.previous_velocity[vertex] = state.velocity[vertex];
    for (int p = vertex; p >= 0; p = stars.next_point(p)) {
        state.previous_material[p] = state.mesh.material[p] - state.previous_dt * state.material_velocity[p];
        state.previous_material_velocity[p] = state.material_velocity[p];
    }
}

namespace {

/// Whether material flows through the vertex, or did in the last step.
bool is_flowing(const State& state, int v)
{
    return !state.material_velocity[v].isZero(0.0) || !state.previous_material_velocity[v].isZero(0.0);
}

}  // namespace

bool has_lost_flow(const Scene& scene, const State& state, const ClothStars& stars)
{
    EolPlacer placer(scene.obstacles, scene.materials.thickness(), state, stars);
    for (int entry = 0; entry < static_cast<int>(state.eol.size()); ++entry)
        if (is_flowing(state, state.index_of(state.eol[entry].vertex_id)) && !placer.place(entry).coordinates)
            return true;
    return false;
}

void settle_flow(const Scene& scene, const State& before, const ClothStars& stars, State& state)
{
    std::vector<char> is_placed(state.ids.size(), 0);
    EolPlacer placer(scene.obstacles, scene.materials.thickness(), state, stars);
    for (int entry = 0; entry < static_cast<int>(state.eol.size()); ++entry)
        if (const EolPlacing placing = placer.place(entry); placing.coordinates)
            is_placed[placing.coordinates->vertex] = 1;
    for (std::size_t v = 0; v < is_placed.size(); ++v)
        if (!is_placed[v]) stop_flow(stars, static_cast<int>(v), state);
    for (const EolVertex& eol : state.eol) {
        const int v = state.index_of(eol.vertex_id);
        if (before.eol_entry(eol.vertex_id) < 0 && is_placed[v]) begin_history(stars, v, state);
    }
    for (const EolVertex& eol : before.eol) {
        const int v = state.index_of(eol.vertex_id);
        if (v >= 0 && !is_placed[v]) begin_history(stars, v, state);
    }
}

void release_pinned(const Scene& scene, const ClothStars& stars, State& state)
{
    if (state.eol.empty()) return;
    for (const PinTarget& held : find_pin_targets(scene, state, state.time)) {
        const int entry = state.eol_entry(state.ids[held.vertex]);
        if (entry < 0) continue;
        stop_flow(stars, held.vertex, state);
        begin_history(stars, held.vertex, state);
        state.eol.erase(state.eol.begin() + entry);
    }
}

}  // namespace arris
