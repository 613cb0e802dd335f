// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "physics/linearization.h"
#include "solver/contact/contacts.h"
#include "solver/eol/eol_coordinates.h"
#include "solver/model/pin_targets.h"
#include "solver/velocity_solve/velocity_solve.h"

namespace arris {

/// Gives every vertex its coordinates, v' = drift + basis u, in which pins are u = 0 and its contacts are u
/// >= bound: u_j = n_j . (v' - drift), n_1.. the pinned axes, then the normals of its contacts, completed to
/// a basis. A contact whose normal depends too much on those before it, and one of an edge or face, becomes a
/// row. Fills `at.drift`, `at.basis`, `at.has_basis`, of `problem` the bounds, rows, what is fixed, and the
/// guess (what was active, and what would arrive at its last velocity), and of `contacts` which constraint
/// they are. A constraint is gap + gamma n . v' >= 0. EOL vertices have the coordinates of `eol` instead:
/// relative to their place on the obstacle, their own contact a bound on the first, any others rows.
void build_constraints(const std::vector<PinTarget>& held, const std::vector<EolCoordinates>& eol,
                       const Prediction& prediction, const State& state, std::vector<Contact>& contacts,
                       Linearization& at, VelocityProblem& problem);

/// Adds the contacts from `first` on as rows in the coordinates that are there.
void append_rows(const Prediction& prediction, const Linearization& at, std::size_t first,
                 std::vector<Contact>& contacts, VelocityProblem& problem);

/// One a contact, N s: of its bound or row.
std::vector<double> contact_multipliers(const std::vector<Contact>& contacts,
                                        const VelocitySolution& solution);

}  // namespace arris
