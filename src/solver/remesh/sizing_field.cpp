// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/remesh/sizing_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/cloth/mesh_quality.h"
#include "geometry/surgery/initial_target.h"
#include "solver/model/target_length.h"
#include "solver/remesh/wanted_lengths.h"

namespace arris {

namespace {

constexpr double kRefineTime = 0.01;   // s, in which lengths may halve
constexpr double kCoarsenTime = 0.07;  // s, in which lengths may double
constexpr double kClearlyFiner = 0.8;  // a smaller change is no reason for surgery

constexpr int kMostNodes = 1 << 16;  // of the grid of cell lengths: they take a part of a step
constexpr int kMostGrowth = 8;       // vertices, times those of the first mesh

}  // namespace

void measure_first_mesh(const ClothMesh& first, Remeshing& remesh)
{
    remesh.initial = make_initial_target(first, std::asin(remesh.aspect) * 180.0 / std::numbers::pi);
    remesh.grid = make_material_grid(first.material, remesh.shortest, kMostNodes);
    if (remesh.most_vertices == 0) remesh.most_vertices = kMostGrowth * first.vertex_count();
    // Where even the longest edges need more vertices, they become longer.
    const double area = material_area(first) / remesh.most_vertices;
    remesh.longest *= std::max(1.0, std::sqrt(area / vertex_area(kMeanEdge * remesh.longest)));
}

void start_sizing_field(const Scene& scene, State& state)
{
    if (!scene.remesh) return;
    const MaterialGrid& grid = scene.remesh->grid;
    state.sizing_field.resize(static_cast<std::size_t>(grid.size()));
    for (int i = 0; i < grid.count[0]; ++i)
        for (int j = 0; j < grid.count[1]; ++j)
            state.sizing_field[grid.index(i, j)] = static_cast<float>(std::clamp(
                scene.remesh->initial.length(grid.node(i, j)), shortest_cell(scene), longest_cell(scene)));
}

void follow_wanted_lengths(const Scene& scene, const ClothStars& stars, double dt, State& state)
{
    if (!scene.remesh || state.step % kRemeshPeriod != 0) return;
    const std::vector<float> wanted = find_wanted_lengths(scene, state, stars);
    const double time = kRemeshPeriod * dt;
    const double finer = std::exp2(-time / kRefineTime), coarser = std::exp2(time / kCoarsenTime);
    for (std::size_t k = 0; k < wanted.size(); ++k) {
        const double length = state.sizing_field[k], goal = wanted[k];
        if (goal < kClearlyFiner * length)
            state.sizing_field[k] = static_cast<float>(std::max(goal, finer * length));
        else if (goal > length)
            state.sizing_field[k] = static_cast<float>(std::min(goal, coarser * length));
    }
}

}  // namespace arris
