// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "physics/elements/term.h"

namespace arris {

/// Weight, exact for linear elements. Its energy is zero for cloth at the origin.
class GravityForce : public FaceTerm {
  public:
    GravityForce(const Materials& materials, const Gravity& gravity)
    {
        for (const Material& material : materials)
            areal_forces_.push_back(material.density * gravity.acceleration);
    }

    EnergyKind energy_kind() const override { return EnergyKind::Gravity; }
    double energy(const FaceState& face) const override;
    void add(const FaceState& face, FaceSystem& system) const override;

  private:
    std::vector<Vec3> areal_forces_;  ///< N/m^2 of material, by piece
};

}  // namespace arris
