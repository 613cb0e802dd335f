// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>

#include "solver/model/scene.h"
#include "solver/model/settings.h"
#include "solver/model/state.h"
#include "solver/model/step_report.h"
#include "solver/workspace.h"

namespace arris {

/// Called for each accepted part of a step. The report's costs include the failed attempts before that part.
/// `is_halved`: an ordinary part, shorter than the planned step, or than the parts that obstacles ask for.
/// Returning false stops `advance`.
using AcceptPart = std::function<bool(const StepReport& report, bool is_halved)>;

/// Advances `state` to `end` (s): in one step, or in equal parts where material flows too fast for one
/// (find_flow_parts) or where an obstacle's points move on too curved a way (find_motion_parts). A BDF2 step
/// without history is made in two parts, a third of the step and the rest. As one implicit Euler step it
/// would cause half of BDF2's error in a second of sliding. RetryPolicy (retry_policy.h) decides what follows
/// a failed attempt. The rest of the step may be made in twice as many equal parts, down to a 64th; after two
/// parts that succeed they are twice as long again. Returns the report of the attempt after which none was
/// left; `state` is then at the last accepted part. `state.step` counts this planned step once, with its last
/// part. Returns nothing where `end` was reached or `accept` stopped. Throws Interrupted; `state` is then at
/// the last accepted part.
std::optional<StepReport> advance(const Scene& scene, const Settings& settings, double end, State& state,
                                  Workspace& work, const AcceptPart& accept);

}  // namespace arris
