// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "physics/elements/term.h"

namespace arris {

/// Weight, exact for linear elements. Its energy is zero for cloth at the origin.
class GravityForce : public FaceTerm {
  public:
    GravityForce(double density, const Gravity& gravity) : areal_force_(density * gravity.acceleration) {}

    EnergyKind energy_kind() const override { return EnergyKind::Gravity; }
    double energy(const FaceState& face) const override;
    void add(const FaceState& face, FaceSystem& system) const override;

  private:
    Vec3 areal_force_;  ///< N/m^2 of material
};

}  // namespace arris
