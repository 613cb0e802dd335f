// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/forces/make_terms.h"

#include <utility>

#include "physics/forces/bending.h"
#include "physics/forces/gravity_force.h"
#include "physics/forces/inertia.h"
#include "physics/forces/membrane.h"
#include "physics/forces/plate_bending.h"
#include "physics/forces/pull_force.h"
#include "physics/forces/seam_spring.h"
#include "physics/forces/wind_force.h"

namespace arris {

namespace {

/// One term for each bending model that any piece has.
void add_bending(const Materials& materials, Terms& terms)
{
    std::vector<double> hinges;
    std::vector<PlateMaterial> plates;
    bool has_hinges = false, has_plates = false;
    for (const Material& material : materials) {
        const bool is_plate = material.bending_model == BendingModel::Plate;
        hinges.push_back(is_plate ? 0.0 : material.bending_stiffness);
        plates.push_back({is_plate ? material.bending_stiffness : 0.0, material.poisson_ratio});
        has_hinges |= hinges.back() > 0.0;
        has_plates |= plates.back().stiffness > 0.0;
    }
    if (has_hinges) terms.hinges.push_back(std::make_unique<Bending>(std::move(hinges)));
    if (has_plates) terms.hinges.push_back(std::make_unique<PlateBending>(std::move(plates)));
}

}  // namespace

Terms make_terms(const Materials& materials, const std::optional<Gravity>& gravity,
                 const std::optional<Wind>& wind, const std::vector<Pull>& pulls, bool has_springs)
{
    Terms terms;
    terms.materials = materials;
    terms.faces.push_back(std::make_unique<Inertia>(materials));
    terms.faces.push_back(std::make_unique<Membrane>(materials));
    add_bending(materials, terms);
    if (gravity) terms.faces.push_back(std::make_unique<GravityForce>(materials, *gravity));
    if (wind) terms.faces.push_back(std::make_unique<WindForce>(*wind));
    if (has_springs) terms.springs.push_back(std::make_unique<SeamSpring>());
    for (const Pull& pull : pulls) terms.loads.push_back(std::make_unique<PullForce>(pull));
    return terms;
}

}  // namespace arris
