// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "app/scene/parts/run_config.h"

namespace arris {

/// Writes a file of what crosses or touches at time 0: faces of the cloth that meet an obstacle or other
/// cloth, and what meets the cloth of each obstacle. Of cloth that lies inside an obstacle and meets none of
/// its faces: the face that is deepest. A path that ends in `.html` becomes a page of the viewer in which
/// they shine through all else. Any other is an OBJ file, in the world, m: the object `cloth` and one for
/// each obstacle, with faces (`f`), segments of wires (`l`) and points (`p`). Throws InputError if another
/// file has that name, std::system_error if writing fails.
void write_crossings(const std::string& path, const RunConfig& config);

}  // namespace arris
