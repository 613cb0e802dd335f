// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/eol/cloth_stars.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// Distance, m, in the material, from point X near vertex v to where a trace leaves the cloth. On the cloth's
/// border it is measured to the corners of the cloth, elsewhere to borders that run along the trace. For a
/// vertex held at a point, borders in any direction count. Infinite where no such border is among the faces
/// at v. Only the feature of `eol` is used.
double room_to_border(const Scene& scene, const State& state, const ClothStars& stars, const Vec2& X, int v,
                      bool is_on_border, const EolVertex& eol);

/// Whether the feature of `eol` meets the cloth's border at less than 20 degrees in the world, where the
/// border passes through `edge`. If `edge` is one vertex twice, the border's direction is that between its
/// two neighbours on the border.
bool is_along_border(const Scene& scene, const State& state, const ClothStars& stars,
                     const std::array<int, 2>& edge, const EolVertex& eol);

}  // namespace arris
