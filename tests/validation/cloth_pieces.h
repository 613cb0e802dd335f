// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/cloth/cloth_mesh.h"
#include "geometry/vectors.h"

namespace arris {

/// Adds a sheet as a piece of its own: its corner in the world, turned about the vertical.
void add_piece(const ClothMesh& sheet, const Vec3& corner, double degrees, ClothMesh& cloth);

}  // namespace arris
