// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/parts/start_strain.h"

#include <fmt/format.h>

#include <algorithm>

#include "physics/elements/cloth_elements.h"
#include "physics/forces/membrane.h"

namespace arris {

bool StrainRange::is_surprising() const
{
    constexpr double kSurprising = 0.1;
    return greatest > kSurprising || -least > kSurprising;
}

void StrainRange::extend(const StrainRange& other)
{
    least = std::min(least, other.least);
    greatest = std::max(greatest, other.greatest);
}

StrainRange measure_strain(const ClothMesh& cloth)
{
    StrainRange strain;
    for (int f = 0; f < cloth.face_count(); ++f) {
        const FaceElement element = make_face_element(cloth.material, cloth.faces[f], cloth.points_of(f));
        const Vec2 stretches = principal_stretches(FaceState(element, cloth.world).F);
        strain.greatest = std::max(strain.greatest, stretches[0] - 1.0);
        strain.least = std::min(strain.least, stretches[1] - 1.0);
    }
    return strain;
}

std::string in_words(const StrainRange& strain)
{
    return fmt::format("from {:.3g} % to {:+.3g} %", 100.0 * strain.least, 100.0 * strain.greatest);
}

}  // namespace arris
