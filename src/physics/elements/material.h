// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace arris {

/// What bends: every hinge for itself (bending.h), with a rigidity that depends on the mesh; or the cloth as
/// a plate (plate_bending.h), with a rigidity that does not.
enum class BendingModel { Hinge, Plate };

/// The cloth's material. All values are those of a sheet: areal where a solid's would be volumetric.
struct Material {
    double density = 0.0;         ///< areal, kg/m^2
    double youngs_modulus = 0.0;  ///< membrane, N/m
    double poisson_ratio = 0.0;
    double bending_stiffness = 0.0;  ///< K, J, per width; 0 leaves bending out
    double damping = 0.0;            ///< s, stiffness-proportional; 0 leaves damping out
    double thickness = 1e-3;         ///< m, the distance kept between the cloth's surface and obstacles
    BendingModel bending_model = BendingModel::Hinge;
    double compression_modulus = 1e4;  ///< Pa: pressure on squeezed cloth, per share of the thickness missing
};

/// D, J: moment per width and curvature of smoothly bent cloth. K for BendingModel::Plate; 4/3 K for
/// BendingModel::Hinge, whose rigidity is that on equilateral faces.
double plate_rigidity(const Material& material);

struct MaterialPreset {
    std::string_view name;
    Material material;
    std::string_view source;  ///< one sentence on where the values are from
};

/// Presets cotton, silk, wool, denim, leather, rubber.
extern const std::array<MaterialPreset, 6> kMaterialPresets;

/// Returns nothing if no preset has that name.
std::optional<Material> find_material_preset(std::string_view name);

}  // namespace arris
