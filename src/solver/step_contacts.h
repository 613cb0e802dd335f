// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "solver/model/scene.h"
#include "solver/model/state.h"
#include "solver/model/step_report.h"
#include "solver/next.h"
#include "solver/workspace.h"

namespace arris {

/// Stage 3 of a step: collects the contacts that the cloth may meet, and flattens history that runs into
/// them. False where a vertex has no room between two obstacles, and where a number is not finite.
bool find_contacts(const Scene& scene, const State& state, Workspace& work, StepReport& report);

/// Before A is assembled: gives the pattern the pairs of vertices that contacts of the cloth with itself
/// couple.
void make_room_for_layers(Workspace& work);

/// Lets the cloth be squeezed at contacts that cannot be met together, in a new system; fold planes keep
/// nothing. False where all these contacts are squeezed already. The velocity found is then discarded:
/// impulses of constraints that cannot be met are no contact forces.
bool squeeze_unmet(Workspace& work);

/// Drops fold planes at wires where they press cloth against another obstacle, in a new system. False where
/// none does so.
bool drop_overconstraining_fold_planes(Workspace& work);

/// Adds violations as constraints: to the existing system, or to a new one where they change history, or
/// squeeze the cloth. Nothing where the check names no contact.
std::optional<Next> add_violations(const Scene& scene, const State& state, const Violations& violations,
                                   Workspace& work);

}  // namespace arris
