// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/obstacle/obstacle.h"

namespace arris {

/// Side of a solid on which a cloth face lies, as far as known.
enum class ClothSide : char { Outside, Inside, Unknown };

/// The point of the cloth that is deepest inside an obstacle's solids.
struct DeepestPoint {
    double depth = 0.0;  ///< m, distance to the nearest face of a solid; 0 where no point inside was found
    int face = -1;       ///< cloth face; -1 where there is none
    Vec3 place = Vec3::Zero();
};

/// Searches the cloth faces that are not outside; `sides` has one entry per face, Unknown for faces that
/// touch a solid. The obstacle must have a solid. Accuracy: see `Penetration::depth`.
DeepestPoint find_deepest(const Obstacle& obstacle, const std::vector<Vec3>& positions,
                          const std::vector<Face>& faces, const std::vector<ClothSide>& sides);

}  // namespace arris
