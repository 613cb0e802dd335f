// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/obstacle/obstacle.h"

namespace arris {

/// Where a cloth face is, as far as is known.
enum class ClothSide : char { Outside, Inside, Unknown };

/// The point of the cloth that is deepest inside an obstacle's solids.
struct DeepestPoint {
    double depth = 0.0;  ///< m, distance to the nearest face of a solid; 0 where no point inside was found
    int face = -1;       ///< of the cloth; -1 where none
    Vec3 place = Vec3::Zero();
};

/// Over the cloth faces that are not outside; one side a face. Those that touch a solid are unknown. The
/// obstacle must have a solid. Accuracy: `Penetration::depth`.
DeepestPoint find_deepest(const Obstacle& obstacle, const std::vector<Vec3>& positions,
                          const std::vector<Face>& faces, const std::vector<ClothSide>& sides);

}  // namespace arris
