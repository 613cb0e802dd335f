// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "physics/linearization.h"
#include "solver/contacts.h"
#include "solver/velocity_solve.h"

namespace arris {

/// Gives every vertex its coordinates, v' = drift + basis u, in which pins are u = 0 and contacts are u >=
/// bound: pinned directions come first, then the contact's normal (its part across the pins), completed to a
/// basis. Fills `at.drift`, `at.basis`, `at.has_basis` and of `problem` the bounds, what is fixed, and the
/// guess (coordinates of `state.active`). Bounds let a gap close and no more, u >= -gap / gamma; a penetrated
/// gap is not pushed out.
void build_constraints(const std::vector<HeldVertex>& held, const std::vector<Contact>& contacts,
                       const Prediction& prediction, const State& state, Linearization& at,
                       VelocityProblem& problem);

/// The coordinate of `vertex` (0, 1, 2) that a contact bounds: the first one that no pin holds; -1 where all
/// are held.
int contact_coordinate(const std::vector<char>& is_fixed, int vertex);

}  // namespace arris
