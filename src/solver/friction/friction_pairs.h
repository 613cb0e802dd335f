// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "physics/elements/cloth_elements.h"
#include "physics/elements/linearization.h"
#include "solver/contact/contacts.h"
#include "solver/eol/cloth_stars.h"
#include "solver/velocity_solve/velocity_solve.h"

namespace arris {

/// A contact with friction; the problem's friction pair of the same index belongs to it.
struct SlipContact {
    int contact;  ///< index
    double coefficient;
    /// World directions of the pair's two components; at EOL vertices unit vectors X and Y (ContactFriction).
    std::array<Vec3, 2> directions;
};

/// The cloth and its contacts in a step, as far as friction needs them.
struct SlippingCloth {
    const Scene& scene;
    const State& state;
    const ClothStars& stars;
    const ClothElements& elements;
    const Prediction& prediction;
    const Carriers& carriers;
    const std::vector<EolCoordinates>& eol;
    const std::vector<Contact>& contacts;
    const Linearization& at;
};

/// Adds to `problem` a friction pair for each contact that can slip, and returns where they are. Slip is
/// measured against an obstacle's material that moves with a smooth rigid motion, so that sticking cloth
/// rides on the obstacle exactly. At an EOL vertex the material slips: along the feature by the motion of
/// vertex and material, across it by the flow. Parts of the cloth slip against each other by their
/// difference in velocity. Without friction: fold planes, and edges of the cloth on the polyline of an EOL
/// vertex at their end, which has the friction there.
std::vector<SlipContact> add_friction_pairs(const SlippingCloth& cloth, VelocityProblem& problem);

}  // namespace arris
