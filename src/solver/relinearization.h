// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/model/scene.h"
#include "solver/model/state.h"
#include "solver/model/step_report.h"
#include "solver/next.h"
#include "solver/retry_policy.h"
#include "solver/workspace.h"

namespace arris {

/// Checks two energies of the proposal: the rise beyond the work that drives the cloth, and the elastic
/// energy that the linear equations miss. If either is too large, relinearises at the velocity found (sets
/// `work.expansion`). Where no relinearisation is left, the attempt fails with `report.status` EnergyRise, or
/// the linearization with the least rise is taken. The last attempt always takes that linearization. Call
/// measure_proposal_energy first.
Next enforce_energy_balance(const Scene& scene, const State& state, Attempt attempt, bool may_solve_again,
                            Workspace& work, StepReport& report);

/// Returns a failed step to a linearization that raised no energy, if the step had one. True where the
/// velocity is to be solved once more.
bool restore_least_rise(Workspace& work, StepReport& report);

/// For a solved velocity (in `work.proposal`) that would take more material than faces can give. Relinearises
/// as far on the way to that velocity as material allows, and returns true: solve again. False where less
/// than a tenth of the way is possible. Such a flow is often no real one. Where a feature stops cloth that q^
/// took through it, the cloth at q^ is stretched over the feature and seems to pull material along. `dt`: of
/// the part of the step, s.
bool linearise_nearer(double dt, Workspace& work, StepReport& report);

}  // namespace arris
