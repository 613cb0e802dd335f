// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/model/target_length.h"

namespace arris {

double target_length(const Scene& scene, const State& state, const Vec2& X)
{
    return scene.remesh ? interpolate(scene.remesh->grid, state.sizing_field, X) : scene.eol->length(X);
}

double shortest_cell(const Scene& scene)
{
    return scene.remesh ? kMeanEdge * scene.remesh->shortest : scene.eol->shortest;
}

double longest_cell(const Scene& scene)
{
    return scene.remesh ? kMeanEdge * scene.remesh->longest : scene.eol->longest;
}

MeshTarget surgery_target(const Scene& scene, const State& state)
{
    MeshTarget target = initial_target(scene);
    if (!scene.remesh) return target;
    target.length = [&scene, &state](const Vec2& X) { return target_length(scene, state, X); };
    target.shortest = shortest_cell(scene);
    target.longest = longest_cell(scene);
    return target;
}

}  // namespace arris
