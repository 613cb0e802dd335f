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

/// Called when a part of a step has been made; its report counts the attempts that failed before it, too.
/// False: stop here.
using AcceptPart = std::function<bool(const StepReport& report, bool is_halved)>;

/// Advances `state` to `end` (s) in one step, or, where material flows too fast for one, in as many parts as
/// `find_flow_parts` says. BDF2 that has no past makes a third of a step first and then the rest: half of its
/// error in a second of sliding would else be that of one implicit Euler step. Where that fails because
/// energy would rise, it is tried without history; where it fails otherwise, the rest of it is made in twice
/// as many equal parts, at most six times, the last of them with the last resort. Returns the report of what
/// failed even so; `state` is then where the last accepted part left it.
std::optional<StepReport> advance(const Scene& scene, const Settings& settings, double end, State& state,
                                  Workspace& work, const AcceptPart& accept);

}  // namespace arris
