// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace arris {

/// Entry point of the importer process that read_obstacle_file starts. `arguments` (`count` of them): a file
/// descriptor for the reply, metres per unit or "-", up axis or "-", path. Prints nothing. Returns the exit
/// status, 0 if the reply (a mesh or an error) was written.
int import_obstacle_command(int count, char** arguments);

}  // namespace arris
