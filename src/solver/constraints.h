// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "physics/linearization.h"
#include "solver/contacts.h"
#include "solver/velocity_solve.h"

namespace arris {

/// Gives every vertex its coordinates, v' = drift + basis u, in which pins are u = 0 and contacts are u >=
/// bound: pinned directions come first, then the contact's normal (its part across the pins), completed to a
/// basis. Fills `at.drift`, `at.basis`, `at.has_basis` and of `problem` the bounds, what is fixed, and the
/// guess (coordinates of `state.active`, and of what would arrive at its last velocity). Bounds let a gap
/// close and no more, u >= -gap / gamma; a penetrated gap is not pushed out.
void build_constraints(const std::vector<HeldVertex>& held, const std::vector<Contact>& contacts,
                       const Prediction& prediction, const State& state, Linearization& at,
                       VelocityProblem& problem);

/// A vertex (index) whose contact was dropped, as pins hold all of its directions, and which they drive more
/// than `depth` (m) past the stand-off during the step: nothing can meet that.
std::optional<int> find_crushed_vertex(const std::vector<Contact>& contacts, double depth,
                                       const Linearization& at, const VelocityProblem& problem);

/// The coordinate of `vertex` (0, 1, 2) that a contact bounds: the first one that no pin holds; -1 where all
/// are held.
int contact_coordinate(const std::vector<char>& is_fixed, int vertex);

}  // namespace arris
