// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "geometry/obstacle_input/obstacle_file.h"

namespace arris {

/// Does the work of read_obstacle_file in this process, unprotected from crashes of the import library.
/// Throws InputError without the file's name.
ObstacleFile import_obstacle(const std::string& path, std::optional<double> metres_per_unit,
                             std::optional<char> up);

}  // namespace arris
