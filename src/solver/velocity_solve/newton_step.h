// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "solver/velocity_solve/contact_laws.h"
#include "solver/velocity_solve/member_solve.h"
#include "solver/velocity_solve/members.h"

namespace arris {

struct NewtonStep {
    ContactPoint change;
    bool is_finite = true;
    int nlopt_evaluations = 0;
};

/// Newton's step from `at` to the solution of a linear model, that of the base, with the laws of its members:
/// one forward and one backward solve, and the members' dense problem between. Sets multipliers, impulses and
/// active bounds of `at` to those of this model. Nothing where the work is spent or the dense problem is
/// singular.
std::optional<NewtonStep> find_step(const ContactLaws& laws, const SpringBase& base, Members& members,
                                    DenseBudget& work, ContactIterate& at);

}  // namespace arris
