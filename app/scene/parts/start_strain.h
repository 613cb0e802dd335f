// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "geometry/cloth/cloth_mesh.h"

namespace arris {

/// Range of the initial strain of a cloth.
struct StrainRange {
    double least = 0.0,
           greatest = 0.0;  ///< extremes of principal stretch - 1 over all faces; least <= 0 <= greatest

    void extend(const StrainRange& other);

    /// Whether a strain exceeds 10 %, which is probably a mistake in the scene.
    bool is_surprising() const;
};

StrainRange measure_strain(const ClothMesh& cloth);

/// "from -3 % to +12 %".
std::string in_words(const StrainRange& strain);

}  // namespace arris
