// SPDX-License-Identifier: GPL-3.0-or-later
// Turns EOL vertices into ordinary ones.
#pragma once

#include "solver/eol/cloth_stars.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// Stops the flow of material through a vertex, which then moves with the material around it: the mean over
/// its faces of v - F V, weighted by material area.
void stop_flow(const ClothStars& stars, int vertex, State& state);

/// Gives a vertex the history of constant motion at its current velocity.
void begin_history(const ClothStars& stars, int vertex, State& state);

/// Whether material flows, or flowed in the last step, through an EOL vertex that cannot have coordinates
/// now.
bool has_lost_flow(const Scene& scene, const State& state, const ClothStars& stars);

/// Stops the flow through vertices that cannot have coordinates: they are Lagrangian in this step. Vertices
/// that have become or ceased to be EOL since `before` get a new history.
void settle_flow(const Scene& scene, const State& before, const ClothStars& stars, State& state);

/// Makes the EOL vertices that pins hold at the state's time ordinary ones: a pinned vertex is never EOL.
void release_pinned(const Scene& scene, const ClothStars& stars, State& state);

}  // namespace arris
