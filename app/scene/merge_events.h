// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "app/scene/run_config.h"

namespace arris {

/// Moves times of the scene that all but fall on a frame, on the end of the run or on each other (nearer than
/// 1e-9 of the longest step) onto them, so that what wrote 0.30000000000000004 for 0.3 does not make a step
/// of 5e-17 s. All that asks whether something acts at a time must see the moved ones, so this comes first.
/// `motions`: of obstacles that are not in the scene yet.
void merge_events(RunConfig& config, const std::vector<RigidMotion*>& motions = {});

}  // namespace arris
