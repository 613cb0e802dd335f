// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/eol_coordinates.h"
#include "solver/scene.h"
#include "solver/state.h"

namespace arris {

/// How fast, m/s, the material would flow through a vertex on obstacle `obstacle` that takes vertex v's
/// place: against the motion of the cloth around v over the obstacle. The mean over its faces, so that cloth
/// which slides over an edge flows as it does on either side. Zero where the faces tell nothing.
Vec2 find_feature_flow(const Scene& scene, const State& state, const ClothStars& stars, int v,
                       std::int32_t obstacle);

}  // namespace arris
