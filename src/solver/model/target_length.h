// SPDX-License-Identifier: GPL-3.0-or-later
// How long the edges of the mesh are to be. Without remeshing that is as in the initial mesh; with it, as the
// state's cell lengths say.
#pragma once

#include <numbers>

#include "geometry/cloth/mesh_target.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// Whether the mesh ever changes: for EOL vertices or by remeshing.
inline bool changes_mesh(const Scene& scene)
{
    return scene.eol || scene.remesh;
}

/// Target of the initial mesh, in a scene whose mesh changes.
inline const MeshTarget& initial_target(const Scene& scene)
{
    return scene.remesh ? scene.remesh->initial : *scene.eol;
}

/// Target edge length, m, at a material point: one cell. The scene's mesh changes.
double target_length(const Scene& scene, const State& state, const Vec2& X);

/// Bounds of `target_length`, m. They save most calls of it.
double shortest_cell(const Scene& scene);
double longest_cell(const Scene& scene);

/// Target of mesh surgery on this state, which must outlive it.
MeshTarget surgery_target(const Scene& scene, const State& state);

/// Edges of a mesh that fits have this part, on average, of the edge length that is asked for: they lie
/// between half and twice this value.
inline constexpr double kMeanEdge = 0.7;

/// Material for each vertex, m^2, in an even mesh of equilateral faces with edges of this length, m.
inline double vertex_area(double cell)
{
    return 0.5 * std::numbers::sqrt3 * cell * cell;
}

}  // namespace arris
