// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// Makes one edge of the two sides of a seam whose pairs are close together, as a whole: a lone pair would be
/// a bow tie. Partners go to their common centre of mass, which keeps momentum; a rotation of the cloth's
/// piece keeps angular momentum. The way there must pass through nothing, and the new surface must be one
/// that `validate` accepts and that crosses itself nowhere near the seam; else false, and the state is as it
/// was. The history of the integrator ends.
bool weld(const Scene& scene, int seam, State& state);

}  // namespace arris
