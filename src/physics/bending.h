// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "physics/term.h"

namespace arris {

/// Hinge bending: V = K 3 |e|^2 / A sin^2(theta/2), e the shared edge and A the area of both faces in
/// material space, theta the angle between the faces' normals (the report, section 2.4). The stiffness is
/// Gauss-Newton in sin(theta/2), so positive semi-definite: 2 K w grad s grad s^T, s = sin(theta/2). A hinge
/// with a face collapsed to a line has no angle: it exerts no force.
///
/// Where material flows the weight 3 |e|^2 / A changes: -dV/dX_i = -K sin^2(theta/2) dw/dX_i at fixed x.
/// (With -F^T f in its place, as if material carried the fold along, a strip in balance over a ridge would
/// creep.)
class Bending : public HingeTerm {
  public:
    explicit Bending(double stiffness) : stiffness_(stiffness) {}

    EnergyKind energy_kind() const override { return EnergyKind::Bending; }
    double energy(const HingeState& hinge) const override;
    void add(const HingeState& hinge, HingeSystem& system) const override;

  private:
    double stiffness_;  ///< K, J
};

}  // namespace arris
