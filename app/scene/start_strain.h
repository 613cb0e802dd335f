// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "geometry/cloth/cloth_mesh.h"

namespace arris {

/// How far a cloth is from its material's size.
struct StrainRange {
    double least = 0.0, greatest = 0.0;  ///< principal stretches less 1, of any face; 0 between them

    /// More than a tenth: more than was likely meant.
    bool is_surprising() const;
};

StrainRange measure_strain(const ClothMesh& cloth);

/// "from -3 % to +12 %".
std::string in_words(const StrainRange& strain);

}  // namespace arris
