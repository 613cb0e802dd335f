// SPDX-License-Identifier: GPL-3.0-or-later
// What EOL vertices make of the contacts that the search has found: each is held by a bound of its own, which
// covers what it, and the cloth's edges and faces from it, touch of its feature nearby.
#pragma once

#include <vector>

#include "solver/contact/contacts.h"
#include "solver/eol/eol_coordinates.h"

namespace arris {

/// The coordinates of the state's EOL vertices, whose own contact is the bound on their first: those that
/// the search found of them with the feature they are on are dropped, and the bounds are appended. Nothing
/// for a vertex that can have no coordinates any more: it is then like any other. For `turning` (s) vertices
/// go round wires and tips with the cloth.
std::vector<EolCoordinates> add_eol_contacts(const Scene& scene, const State& state, const ClothStars& stars,
                                             const Prediction& prediction, double turning,
                                             const std::vector<ObstacleStep>& steps,
                                             std::vector<Contact>& contacts);

}  // namespace arris
