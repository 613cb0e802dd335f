// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "physics/cloth_elements.h"
#include "solver/eol_coordinates.h"
#include "solver/scene.h"
#include "solver/state.h"

namespace arris {

/// Makes those hinges of `elements` creases that lie along features between EOL vertices, where the mesh is
/// too coarse for the bend that the cloth has there, and the others none. `stars` and `elements` are the
/// state's. True where anything changed: energies known of these elements are old.
bool mark_creases(const Scene& scene, const State& state, const ClothStars& stars, ClothElements& elements);

}  // namespace arris
