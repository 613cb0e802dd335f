// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/friction/friction_pairs.h"
#include "solver/workspace.h"

namespace arris {

/// Residual of friction, relative to the largest budget, above which friction is off its law. A step that
/// ends with more is made again, if there is a shorter one.
inline constexpr double kOffLaw = 1e-3;

/// The parts of a step that friction reads.
SlippingCloth slipping_cloth(const Scene& scene, const State& state, const Workspace& work);

/// Gives `work.problem` the law of its friction pairs. It refers to all three arguments.
void set_friction_law(const Scene& scene, const State& state, Workspace& work);

/// Stores the solution's friction at the contacts, where the next solve starts from it, and the outcome in
/// `report`.
void note_friction(const State& state, Workspace& work, StepReport& report);

}  // namespace arris
