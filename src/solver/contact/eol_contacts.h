// SPDX-License-Identifier: GPL-3.0-or-later
// Replaces contacts that the search has found at EOL vertices. Each EOL vertex has a bound of its own. The
// bound covers the vertex's contacts with its feature nearby, and the contacts of the cloth's edges and faces
// at the vertex.
#pragma once

#include <vector>

#include "solver/contact/contacts.h"
#include "solver/eol/eol_coordinates.h"

namespace arris {

/// Coordinates of the state's EOL vertices, whose own contact is the bound on the first coordinate. Contacts
/// that the search found between these vertices and their features are dropped, and the bounds are appended.
/// A vertex that can have no coordinates any more has no entry and is ordinary in this step. `turning` (s) is
/// the time for which vertices may go round wires and tips with the cloth.
std::vector<EolCoordinates> add_eol_contacts(const Scene& scene, const State& state, const ClothStars& stars,
                                             const Prediction& prediction, double turning,
                                             const Carriers& carriers, std::vector<Contact>& contacts);

}  // namespace arris
