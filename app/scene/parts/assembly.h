// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "app/scene/parts/run_config.h"

namespace arris {

/// Whether seams of the scene's cloth must be closed before time 0.
bool needs_assembly(const RunConfig& config);

/// Whether seams that do not close stay as they are.
bool keeps_unsewn(const RunConfig& config);

/// The run that closes them, with a time of its own: obstacles and labelled pins at rest where they are at
/// time 0, no gravity, wind, pull, friction or EOL vertices; the cloth is damped, and stiffer in bending. It
/// ends when all seams have been closed for the time to settle, or unsewn. `duration` (s): as of the assembly
/// that is resumed; else 0.
RunConfig make_assembly(const RunConfig& config, double duration = 0.0);

}  // namespace arris
