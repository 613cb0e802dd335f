// SPDX-License-Identifier: GPL-3.0-or-later
// An EOL vertex moves in a plane or on a line only. What presses on it from two sides, one of which comes
// nearer, may then be impossible to meet, or drive it out along a wedge however fast that is: an ordinary
// vertex gives way. So it has to become one.
#pragma once

#include <vector>

#include "solver/model/state.h"
#include "solver/model/step_report.h"
#include "solver/workspace.h"

namespace arris {

/// EOL vertices whose contacts push against each other or against what holds the vertex to its feature, most
/// of their impulses in vain, and do work, J, on them all the same: more than a tenth of the energy at stake
/// in a step in which the cloth gains as much. The proposal in `work` is weighed.
std::vector<int> find_overpressed_vertices(const Workspace& work);

/// Contacts (indices) of folds' planes that press cloth against another obstacle: nothing is there that would
/// crush it.
std::vector<int> find_overconstraining_folds(const Workspace& work);

/// Those of an infeasible step: in contacts that no velocity meets, or squeezed.
std::vector<int> find_overconstrained_vertices(const State& state, const Workspace& work,
                                               const StepReport& report);

}  // namespace arris
