// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/cloth/cloth_mesh.h"

namespace arris {

/// Vertices less edges plus faces: the number of parts, less the number of holes in them. 0 for a tube.
int euler_characteristic(const ClothMesh& mesh);

}  // namespace arris
