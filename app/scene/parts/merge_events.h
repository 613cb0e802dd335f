// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "app/scene/parts/run_config.h"

namespace arris {

/// Merges times of the scene that nearly coincide with a frame, the end of the run or each other (nearer than
/// 1e-9 of the longest step). Otherwise 0.30000000000000004 for 0.3 would cause a step of 5e-17 s. Call this
/// before any test of whether an effect acts at a time. `motions`: motions of obstacles that are not yet in
/// the scene.
void merge_events(RunConfig& config, const std::vector<RigidMotion*>& motions = {});

/// Merges ascending times of an obstacle's samples with the events that they nearly coincide with, after
/// merge_events. `plans`: motions of obstacles that are not yet in the scene.
void merge_with_events(const RunConfig& config, const std::vector<RigidMotion>& plans,
                       std::vector<double>& times);

}  // namespace arris
