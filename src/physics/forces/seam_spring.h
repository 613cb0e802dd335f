// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "physics/elements/term.h"

namespace arris {

/// Pulls the two sides of a seam together: V = k/2 max(0, d - l)^2 at distance d, with the spring's stiffness
/// k and length l.
class SeamSpring : public SpringTerm {
  public:
    EnergyKind energy_kind() const override { return EnergyKind::Seam; }
    double energy(const SpringState& spring) const override;
    void add(const SpringState& spring, SpringSystem& system) const override;
};

}  // namespace arris
