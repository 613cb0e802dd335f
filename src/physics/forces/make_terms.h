// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "physics/elements/effects.h"
#include "physics/elements/material.h"
#include "physics/elements/term.h"

namespace arris {

/// The effects on cloth of these materials. Always inertia and membrane; other terms if their effect is
/// present. A new term takes one file and one line here. `has_springs`: whether elements may have any.
Terms make_terms(const Materials& materials, const std::optional<Gravity>& gravity,
                 const std::optional<Wind>& wind, const std::vector<Pull>& pulls, bool has_springs = false);

}  // namespace arris
