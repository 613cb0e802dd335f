// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/surgery/patch_quality.h"

namespace arris {

/// Keeps a mesh about as it was made: the target length is the mean length of the initial mesh's edges at a
/// vertex, linear in between, the target angle the least of the faces at the corners of the face there, and
/// no more than `most_angle` degrees. Beyond the mesh (by rounding, at the border) the nearest face counts.
/// A mesh of cells more than about three times as long as wide has edges that count as short.
/// Holds a copy of what it needs; a query takes logarithmic time on average. `initial` must pass `validate`.
MeshTarget make_initial_target(const ClothMesh& initial, double most_angle = 15.0);

}  // namespace arris
