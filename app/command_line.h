// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace arris {

/// Parses the arguments and runs the command. Returns the exit status: 0 done, 1 the run stopped before its
/// end, 2 invalid arguments, 130 interrupted. Throws what the commands throw.
int run_command_line(int argc, char** argv);

}  // namespace arris
