// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace arris {

/// Parses the arguments and does what they say. Returns the exit status: 0 done, 1 the run stopped before its
/// end, 2 arguments that cannot be, 130 interrupted. Throws what the commands throw.
int run_command_line(int argc, char** argv);

}  // namespace arris
