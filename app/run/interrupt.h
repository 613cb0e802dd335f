// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace arris {

/// From here on the first Ctrl-C (or SIGTERM, SIGHUP) asks the run to stop at the end of its step and says
/// so; a second one ends the process at once, as by default: the last checkpoint is there all the same.
void watch_for_interrupt();

bool is_interrupted();

}  // namespace arris
