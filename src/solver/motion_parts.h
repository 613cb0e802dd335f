// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// Distance of an arc from its chord, as a share of the thickness, above which a step is made in parts.
inline constexpr double kMostChordShare = 0.25;

/// Number of equal parts, a power of two, in which a step of `dt` (s) must be made because of fast obstacles.
/// A step takes chords for the arcs on which their points move. By the distance of arc and chord, cloth would
/// meet a turning obstacle too early or too late: it must stay below a quarter of the cloth's thickness near
/// the cloth. A rigid obstacle may turn by no more than a quarter turn in a part. At most kMostMotionParts.
inline constexpr int kMostMotionParts = 64;
int find_motion_parts(const Scene& scene, const State& state, double dt);

}  // namespace arris
