// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/forces/make_terms.h"

#include "physics/forces/bending.h"
#include "physics/forces/gravity_force.h"
#include "physics/forces/inertia.h"
#include "physics/forces/membrane.h"
#include "physics/forces/plate_bending.h"
#include "physics/forces/pull_force.h"
#include "physics/forces/wind_force.h"

namespace arris {

Terms make_terms(const Material& material, const std::optional<Gravity>& gravity,
                 const std::optional<Wind>& wind, const std::vector<Pull>& pulls)
{
    Terms terms;
    terms.density = material.density;
    terms.faces.push_back(std::make_unique<Inertia>(material.density));
    terms.faces.push_back(std::make_unique<Membrane>(material.youngs_modulus, material.poisson_ratio));
    if (material.bending_stiffness > 0.0) {
        if (material.bending_model == BendingModel::Plate)
            terms.hinges.push_back(
                std::make_unique<PlateBending>(material.bending_stiffness, material.poisson_ratio));
        else
            terms.hinges.push_back(std::make_unique<Bending>(material.bending_stiffness));
    }
    if (gravity) terms.faces.push_back(std::make_unique<GravityForce>(material.density, *gravity));
    if (wind) terms.faces.push_back(std::make_unique<WindForce>(*wind));
    for (const Pull& pull : pulls) terms.loads.push_back(std::make_unique<PullForce>(pull));
    return terms;
}

}  // namespace arris
