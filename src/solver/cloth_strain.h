// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <vector>

#include "physics/cloth_elements.h"
#include "physics/material.h"
#include "solver/eol/cloth_stars.h"

namespace arris {

/// A principal strain, stretch - 1, of a face; of no face where there is none.
struct FaceStrain {
    double strain = 0.0;
    int face = -1;
};

/// The extreme strains of a cloth at one moment.
struct ClothStrain {
    FaceStrain stretch;      ///< the greatest principal strain, > 0
    FaceStrain compression;  ///< the least principal strain, < 0
    FaceStrain in_plane;     ///< the greatest compression, < 0, of a face under compressive tension whose
                             ///< surroundings lie in a plane: real cloth would fold there

    /// Size of the greatest principal strain, stretch or compression.
    double greatest() const { return std::max(stretch.strain, -compression.strain); }
};

/// Linear in face count. `elements` and `stars` belong to the cloth at `positions`.
ClothStrain measure_cloth_strain(const Material& material, const ClothElements& elements,
                                 const ClothStars& stars, const std::vector<Vec3>& positions);

}  // namespace arris
