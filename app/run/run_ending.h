// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "app/report/report.h"
#include "solver/contact/audit.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"
#include "solver/model/step_report.h"

namespace arris {

/// Status of a run at its end, with the reason if it ended early.
struct RunEnding {
    RunStatus status = RunStatus::Finished;
    std::string message;
};

/// The ending of a run whose step from `state` has failed. `tolerance` is that of the velocity solve. An
/// infeasible step names the vertex, the pin by its index (pin.0) and the obstacles by their names.
RunEnding explain_ending(const StepReport& report, double tolerance, const Scene& scene, const State& state);

/// The ending of a run whose audit has found cloth inside an obstacle. The check of every step excludes this,
/// so the program has an error.
RunEnding explain_ending(const Audit& audited, const Scene& scene, const State& state);

/// The ending of an assembly whose seams have not closed in time.
RunEnding explain_unsewn(const Scene& scene, const State& state);

/// Ends a run whose cloth crosses itself.
RunEnding explain_ending(const SelfCrossings& crossings, const State& state);

}  // namespace arris
