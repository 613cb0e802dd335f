// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "physics/forces/bending.h"
#include "physics/forces/hinge_moments.h"

namespace arris {

/// Bending of an isotropic plate, whose rigidity does not depend on the mesh. A strip with free sides has the
/// bending rigidity K per width; held as a cylinder it has K / (1 - nu^2). The energy and the moments are in
/// hinge_moments.h. A hinge with moment m L (N m) exerts the forces -m L ds/dx, s = 2 sin(theta/2). This is
/// the whole gradient, as the moments are where the energy is greatest.
///
/// The stiffness of a hinge is W grad s grad s^T with W at least the true one, so positive semi-definite, and
/// it couples the four vertices of the hinge only. The true stiffness couples all hinges. W is about twice
/// the stiffness against smooth bending. This changes how a step approaches the end, to the order of the
/// integrator, and no state at rest.
///
/// Where theta passes 180 degrees, faces lie on each other, s changes its sign, and the energy jumps.
///
/// Creases are those of Bending, with the same K.
class PlateBending : public HingeTerm {
  public:
    /// `plates`: the material of each piece; its stiffness is 0 where none.
    explicit PlateBending(std::vector<PlateMaterial> plates);

    EnergyKind energy_kind() const override { return EnergyKind::Bending; }
    bool is_coupled() const override { return true; }
    std::vector<HingeMoment> find_moments(const ClothElements& elements, const std::vector<Vec3>& position,
                                          const Linearization* at) const override
    {
        return find_hinge_moments(plates_, elements, position, at);
    }
    double energy(const HingeState& hinge) const override;
    void add(const HingeState& hinge, HingeSystem& system) const override;

  private:
    std::vector<PlateMaterial> plates_;
    Bending crease_;
};

}  // namespace arris
