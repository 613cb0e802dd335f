// SPDX-License-Identifier: GPL-3.0-or-later
// Cloth that gathers along a feature, as drawn through a ring or over the inside corner of a bent wire. More
// cloth comes to the trace than the feature is long, and wants to leave it in pleats. EOL vertices in a row
// cannot pass each other and keep the cloth on the feature, which strains it up to a hundredfold. Such cloth
// needs constraints, between which it can rise.
#pragma once

#include <vector>

#include "solver/eol/cloth_stars.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// Updates `EolVertex::gathering` after a step of `dt` (s). The compression e is that of the cloth on the
/// trace. A pleat takes up e over a wavelength 2 pi / q of two or four cells. It costs bending and
/// the work against the force F with which the feature presses on the area A of a vertex. With E, N/m, and
/// the plate's bending stiffness D, a wave (a / 2)(1 + cos q s) has the amplitude a = 4 sqrt(e) / q, and pays
/// where
///   X = E e / 2 - D q^2 - 2 F / (A q sqrt(e)) > 0.
/// It then grows by exp(sigma dt), sigma = q sqrt(2 X / rho); else it shrinks likewise. `gathering` is the
/// sum of sigma dt, at least 0.
void grow_gathering(const Scene& scene, const ClothStars& stars, double dt, State& state);

/// Whether a pleat has grown at an EOL vertex, by a factor of 20.
bool has_gathered(const EolVertex& vertex);

/// Whether a pleat would pay at vertex `v` of the cloth along `tangent` (unit, world) at 1 / kStayRatio of
/// its present compression: a trace begins only where it would not soon be released.
bool is_near_gathering(const Scene& scene, const State& state, const ClothStars& stars, int v,
                       const Vec3& tangent);

}  // namespace arris
