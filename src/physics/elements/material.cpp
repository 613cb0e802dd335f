// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/elements/material.h"

#include <algorithm>

namespace arris {

// Starting points, not measurements: cloth of one name varies by more than a factor of two. The bending
// stiffness K is that of the hinge energy. A plate with a bending rigidity of about 1.5 K corresponds to it
// on equilateral triangles. Fields: density, youngs_modulus, poisson_ratio, bending_stiffness. Damping and
// thickness are independent of the fabric.
const std::array<MaterialPreset, 6> kMaterialPresets = {{
    {"cotton",
     {0.15, 500.0, 0.3, 1e-5},
     "Weight of a shirting; bending rigidity of the order KES shows for cotton shirtings (0.1 gf cm^2/cm is "
     "1e-5 J); "
     "membrane stiffness by order of magnitude, at the soft end of woven cloth as computer graphics uses "
     "it."},
    {"silk",
     {0.07, 400.0, 0.3, 3e-6},
     "Weight of 16 momme habotai (69 g/m^2); bending rigidity of the order KES shows for light silks (0.03 "
     "to 0.05 gf "
     "cm^2/cm); membrane stiffness by order of magnitude, beside cotton's."},
    {"wool",
     {0.22, 300.0, 0.3, 1e-5},
     "Weight of a suiting; bending rigidity of the order KES shows for suitings (0.1 to 0.15 gf cm^2/cm); "
     "membrane "
     "stiffness by order of magnitude, beside cotton's, as wool stretches more."},
    {"denim",
     {0.4, 2000.0, 0.3, 1e-4},
     "Weight of 12 oz denim (407 g/m^2); both stiffnesses by order of magnitude, several times cotton's, as "
     "the denim "
     "among the fabrics measured by Wang, O'Brien and Ramamoorthi 2011 suggests."},
    {"leather",
     {0.7, 8000.0, 0.4, 3e-4},
     "Garment leather 0.8 mm thick, computed from a textbook density of 0.86 g/cm^3 and a modulus of 10 MPa "
     "(plate "
     "rigidity 5e-4 J over 1.5); tanning changes the modulus by a factor of ten."},
    {"rubber",
     {0.47, 750.0, 0.49, 1.4e-5},
     "Natural rubber sheet 0.5 mm thick, computed from textbook values of 0.94 g/cm^3 and 1.5 MPa, nearly "
     "incompressible (plate rigidity 2.1e-5 J over 1.5)."},
}};

double plate_rigidity(const Material& material)
{
    constexpr double kHinge = 4.0 / 3.0;  // docs/measured/validation.md, "Bending"
    return (material.bending_model == BendingModel::Plate ? 1.0 : kHinge) * material.bending_stiffness;
}

std::optional<Material> find_material_preset(std::string_view name)
{
    const auto preset = std::find_if(kMaterialPresets.begin(), kMaterialPresets.end(),
                                     [&](const MaterialPreset& candidate) { return candidate.name == name; });
    if (preset == kMaterialPresets.end()) return std::nullopt;
    return preset->material;
}

}  // namespace arris
