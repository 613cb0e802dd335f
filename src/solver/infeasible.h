// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "solver/model/state.h"
#include "solver/model/step_report.h"
#include "solver/workspace.h"

namespace arris {

/// Whether the last velocity solve could not meet the row (index); false for -1, a contact without a row.
bool is_unmet(const Workspace& work, int row);

/// Names what an infeasible step cannot meet together: a vertex, the pin that holds it, and the obstacles of
/// its contacts. `overconstrained` is a vertex (index) without room between two contacts (`share_room`).
/// Without one, the vertex is that of a row that the velocity solve could not meet, a pinned one if there is
/// any. Where this is a contact of the cloth with itself, the pin of the other layer is named, too, or else
/// the obstacle that presses the two layers together.
Infeasible name_infeasible(const State& state, const Workspace& work,
                           const std::optional<int>& overconstrained = std::nullopt);

}  // namespace arris
