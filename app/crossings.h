// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "app/scene/parts/run_config.h"

namespace arris {

/// Writes an OBJ file of what crosses or touches at time 0, in the world, m: the object `cloth` with faces of
/// the cloth that meet an obstacle or other cloth, and an object for each obstacle with the faces (`f`),
/// segments of wires (`l`) and points (`p`) that meet the cloth. Of cloth that lies inside an obstacle and
/// meets none of its faces: the face that is deepest. Throws InputError if another file has that name,
/// std::system_error if writing fails.
void write_crossings(const std::string& path, const RunConfig& config);

}  // namespace arris
