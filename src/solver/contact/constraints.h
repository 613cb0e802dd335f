// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "physics/elements/linearization.h"
#include "solver/contact/contacts.h"
#include "solver/eol/eol_coordinates.h"
#include "solver/model/pin_targets.h"
#include "solver/velocity_solve/velocity_solve.h"

namespace arris {

/// Gives every vertex coordinates v' = drift + basis u, in which pins are u = 0 and contacts are u >= bound.
/// u_j = n_j . (v' - drift), where n_1, n_2, .. are the pinned axes, then the normals of the vertex's
/// contacts, completed to a basis. A constraint is gap + gamma n . v' >= 0. Contacts of edges and faces
/// become constraints, and so do contacts of the cloth with itself, and those whose normal depends too much
/// on the earlier ones. EOL vertices have the coordinates of `eol` instead, relative to their place on the
/// obstacle. Their own contact is a bound on the first coordinate; their other contacts are constraints.
/// Fills `at.drift`, `at.basis`, `at.has_basis`; in `problem` the bounds, constraints, fixed coordinates and
/// the guess (active before, or closing at the last velocity); in `contacts` the index of their bound or
/// constraint.
void build_constraints(const std::vector<PinTarget>& held, const std::vector<EolCoordinates>& eol,
                       const Prediction& prediction, const State& state, std::vector<Contact>& contacts,
                       Linearization& at, VelocityProblem& problem);

/// Adds the contacts from `first` on as constraints in the existing coordinates.
void append_rows(const Prediction& prediction, const Linearization& at, std::size_t first,
                 std::vector<Contact>& contacts, VelocityProblem& problem);

/// Multiplier, N s, of each contact's bound or constraint.
std::vector<double> contact_multipliers(const std::vector<Contact>& contacts,
                                        const VelocitySolution& solution);

}  // namespace arris
