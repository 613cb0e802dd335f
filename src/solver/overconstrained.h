// SPDX-License-Identifier: GPL-3.0-or-later
// EOL vertices and fold planes that are pressed from both sides. An EOL vertex moves only in a plane or on a
// line. Between contacts that approach each other no velocity may meet both, or the vertex is driven out of
// their wedge at any speed. An ordinary vertex gives way, so an overconstrained EOL vertex becomes ordinary
// for the step.
#pragma once

#include <vector>

#include "solver/model/state.h"
#include "solver/model/step_report.h"
#include "solver/workspace.h"

namespace arris {

/// EOL vertices whose contacts push against each other, or against the feature that holds the vertex: most of
/// their impulse cancels. These contacts also do work on the vertex, of more than 10 % of the energy scale.
/// The cloth's energy must rise by more than 10 % of that scale, too. Call measure_proposal_energy first.
std::vector<int> find_overconstrained_by_work(const Workspace& work);

/// Contacts (indices) of fold planes that press cloth against another obstacle. A fold plane is no surface,
/// so it can yield.
std::vector<int> find_overconstraining_fold_planes(const Workspace& work);

/// Overconstrained EOL vertices of an infeasible step: vertices in contacts that no velocity meets, or else
/// the result of `find_overconstrained_by_work`. Empty if the status is not Infeasible.
std::vector<int> find_overconstrained_vertices(const State& state, const Workspace& work,
                                               const StepReport& report);

}  // namespace arris
