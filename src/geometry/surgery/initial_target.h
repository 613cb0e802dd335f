// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/surgery/patch_quality.h"

namespace arris {

/// Target that keeps a mesh about as it was made. The target length at a vertex is the mean length of its
/// edges in the initial mesh; it is linear in between. The target angle is the least angle of the faces at
/// the corners of the face there, but at most `most_angle` degrees. Beyond the mesh (by rounding, at the
/// border) the nearest face counts.
/// If cells are more than about three times as long as wide, some of their edges count as short. The target
/// holds a copy of its data. A query takes constant time on average for faces of similar size. `initial` must
/// pass `validate`.
MeshTarget make_initial_target(const ClothMesh& initial, double most_angle = 15.0);

}  // namespace arris
