// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace arris {

/// From here on the first Ctrl-C (or SIGTERM) asks the run to stop at the end of its step; a second one ends
/// the process at once, as by default.
void watch_for_interrupt();

bool is_interrupted();

}  // namespace arris
