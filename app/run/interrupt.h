// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace arris {

/// Installs signal handlers. The first Ctrl-C (or SIGTERM, SIGHUP) makes is_interrupted() true, so that the
/// run stops within its step, and prints `message`, which must live as long as the process. A second signal
/// ends the process at once; the last checkpoint remains.
void watch_for_interrupt(std::string_view message);

bool is_interrupted();

}  // namespace arris
