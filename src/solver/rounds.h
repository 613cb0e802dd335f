// SPDX-License-Identifier: GPL-3.0-or-later
// Stages 4 to 6 of a step, in bounded rounds: assemble, solve, propose and check. The table in rounds.cpp
// says what follows each way in which a round ends; docs/method.md prints it.
#pragma once

#include <string_view>
#include <vector>

#include "solver/model/scene.h"
#include "solver/model/settings.h"
#include "solver/model/state.h"
#include "solver/model/step_report.h"
#include "solver/retry_policy.h"
#include "solver/workspace.h"

namespace arris {

/// Runs rounds from `state` to the time `end` (s) until one is accepted or the attempt has failed:
/// `report.status`. The accepted proposal is in `work`. Returns the EOL vertices for which the attempt has
/// failed with status Overrun.
std::vector<Overrun> run_rounds(const Scene& scene, const Settings& settings, double end, const State& state,
                                Attempt attempt, Workspace& work, StepReport& report);

/// A row of the table of rounds, in words.
struct RoundRule {
    std::string_view end, next, bound;
};
std::vector<RoundRule> list_round_rules();

}  // namespace arris
