// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "app/scene/parts/run_config.h"
#include "app/scene/warnings/warnings.h"

namespace arris {

/// Warns of cloth and obstacles whose sizes, places or gravity do not fit together, mostly because of a unit
/// or the upward axis: file obstacles that are far larger or smaller than the cloth, gravity that does not
/// point down, and cloth that can only fall past all obstacles.
void check_placement(const RunConfig& config, Warnings& warnings);

}  // namespace arris
