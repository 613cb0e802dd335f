// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "app/report/report.h"
#include "solver/contact/audit.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"
#include "solver/model/step_report.h"

namespace arris {

/// How a run ended, and in words why it ended before its time.
struct RunEnding {
    RunStatus status = RunStatus::Finished;
    std::string message;
};

/// The ending of a run whose next step from `state` has failed; `tolerance`: of the velocity solve, as asked.
RunEnding explain_ending(const StepReport& report, double tolerance, const State& state);

/// The ending of a run whose audit has found the cloth inside an obstacle, which the check of every step
/// should have prevented.
RunEnding explain_ending(const Audit& audited, const Scene& scene, const State& state);

}  // namespace arris
