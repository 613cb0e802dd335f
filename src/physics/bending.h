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
///
/// A hinge on a sharp feature is a crease: V = K 3 |e| / h sigma (1 - sigma / 2 sigma_0) up to sigma = sin^2
/// (theta/2) = sigma_0, and as much beyond. Cloth that is folded so far within a cell is not resolved by it:
/// truly its tension T bends it within sqrt(K / T) of the feature, and a cell away nothing is felt. The
/// hinge's moment, which would be greatest there, pushes the rows beside the feature off and aside, by K / h
/// T, and as rows come and go with the sliding material that shakes the cloth. So where that bend
/// is as wide as the hinge, 2 sqrt(K / T) > h, there are no creases (solver/creases). Its width h is the
/// mesh's own, not that of the faces beside it, which change with the sliding: a fold would do work on them.
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
