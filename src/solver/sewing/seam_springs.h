// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "physics/elements/cloth_elements.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// A spring for each pair of the state's open seams, at their lengths of the state's time.
std::vector<SpringElement> list_springs(const Scene& scene, const State& state);

/// Sets the lengths and stiffnesses that the springs have at `time` (s). Those of seams whose turn has not
/// come have none.
void set_spring_lengths(const Scene& scene, const State& state, double time,
                        std::vector<SpringElement>& springs);

/// Vertices that open seams join, directly or by way of others, have the same number, others -1: as
/// SelfSurface has it. Empty where no seam is open.
std::vector<int> number_joined(const State& state);

}  // namespace arris
