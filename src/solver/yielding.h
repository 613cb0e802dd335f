// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/model/scene.h"
#include "solver/workspace.h"

namespace arris {

/// Lets contacts that cannot be met together keep less than their stand-off, in a new system. False where
/// none can yield. The velocity found is then discarded: impulses of rows that cannot be met are no contact
/// forces.
bool yield_infeasible(const Scene& scene, const State& state, Workspace& work);

/// Lets fold planes at wires yield where they press cloth against another obstacle, in a new system. False
/// where none does so.
bool yield_folds(const Scene& scene, Workspace& work);

}  // namespace arris
