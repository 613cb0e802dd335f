// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/velocity_solve/contact_laws.h"
#include "solver/velocity_solve/members.h"

namespace arris {

/// Constraints whose linear model is not that of a base.
struct ModelChanges {
    std::vector<int> bounds,
        rows;       ///< that are no members yet: coordinates, and scaled rows, slip rows by pairs
    int count = 0;  ///< columns that they need as members, with those that are members
    int fresh() const { return static_cast<int>(bounds.size() + rows.size()); }
};

/// What differs between a base and the state wanted.
ModelChanges find_changes(const ConstraintRows& constraints, const SpringBase& base, const Members& members,
                          const ContactState& wanted);

/// Changes on the way of a step from `from`, those that come first, with at most `room` columns. `count` is
/// 0.
ModelChanges find_first_changes(const ContactLaws& laws, const SpringBase& base, const Members& members,
                                const ContactIterate& from, const ContactPoint& step, int room);

/// Share of a step from `from` at which the energy of all springs is least.
double find_share(const ContactLaws& laws, const ContactPoint& from, const ContactPoint& step);

}  // namespace arris
