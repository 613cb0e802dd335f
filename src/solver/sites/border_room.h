// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/eol/cloth_stars.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// How far, m, material point X near vertex v is from where a trace leaves the cloth: on the border from its
/// corners, else from borders that run along the trace; what is held at a point from any. Infinite where
/// there is none among the faces at v. Of `eol` the feature counts.
double room_to_border(const Scene& scene, const State& state, const ClothStars& stars, const Vec2& X, int v,
                      bool is_on_border, const EolVertex& eol);

/// Whether the feature of `eol` meets the cloth's border at less than 20 degrees where the border passes
/// through that edge of the cloth; `edge` twice the same vertex: through it, where both sides of it count. In
/// the world.
bool is_along_border(const Scene& scene, const State& state, const ClothStars& stars,
                     const std::array<int, 2>& edge, const EolVertex& eol);

}  // namespace arris
