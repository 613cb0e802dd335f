// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/eol/cloth_stars.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// Planned steps from one measurement to the next, and from one new mesh to the next: each takes half a
/// factorisation.
inline constexpr int kRemeshPeriod = 4;

/// Sets what depends on the first mesh: target, grid and, if it is 0, the number of vertices. Makes the
/// longest edges longer where they need more vertices than that.
void measure_first_mesh(const ClothMesh& first, Remeshing& remesh);

/// Lengths of a mesh as it was made, within the limits of remeshing. Nothing without remeshing.
void start_sizing_field(const Scene& scene, State& state);

/// Lets the state's cell lengths follow those that its shape and motion ask for, after each kRemeshPeriod-th
/// planned step. `dt`: of a planned step, s. Cells become finer at most twofold in kRefineTime, so that the
/// cloth takes a new shape before it is measured on the finer mesh; and coarser more slowly, so that no cell
/// is split and merged in turn.
void follow_wanted_lengths(const Scene& scene, const ClothStars& stars, double dt, State& state);

}  // namespace arris
