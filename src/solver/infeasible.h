// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "solver/contact/contacts.h"
#include "solver/model/pin_targets.h"
#include "solver/model/state.h"
#include "solver/model/step_report.h"

namespace arris {

/// What a step cannot meet together is found among these: its contacts, the vertices that pins hold, and the
/// constraints (indices) that the last velocity solve could not meet.
struct UnmetStep {
    const std::vector<Contact>& contacts;
    const std::vector<PinTarget>& pin_targets;
    const std::vector<int>& rows;

    /// False for -1, a contact without a constraint.
    bool is_unmet(int row) const { return std::find(rows.begin(), rows.end(), row) != rows.end(); }
};

/// Names what an infeasible step cannot meet together: a vertex, the pin that holds it, and the obstacles of
/// its contacts. `overconstrained` is a vertex (index) without room between two contacts
/// (`squeeze_contacts`). Without one, the vertex is that of a constraint that the velocity solve could not
/// meet, a pinned one if there is any. Where this is a contact of the cloth with itself, the pin of the other
/// layer is named, too, or else the obstacle that presses the two layers together.
Infeasible name_infeasible(const State& state, const UnmetStep& step,
                           const std::optional<int>& overconstrained = std::nullopt);

}  // namespace arris
