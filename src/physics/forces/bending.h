// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include "physics/elements/term.h"

namespace arris {

/// Hinge bending: V = K 3 |e|^2 / A sin^2(theta/2), where e is the shared edge, A the area of both faces in
/// material space, and theta the angle between the faces' normals. The stiffness is Gauss-Newton in
/// s = sin(theta/2), so positive semi-definite: 2 K w grad s grad s^T, w = 3 |e|^2 / A. A hinge with a face
/// collapsed to a line has no angle and exerts no force.
///
/// Where material flows, the weight w changes: -dV/dX_i = -K sin^2(theta/2) dw/dX_i at fixed x. The force
/// -F^T f in its place would let material carry the fold along: a strip in balance over a ridge would creep.
///
/// A hinge on a sharp feature is a crease of width h, with sigma = sin^2(theta/2):
///   V = K 3 |e| / h sigma (1 - sigma / (2 sigma_0))   up to sigma = sigma_0, and constant beyond.
/// The mesh does not resolve cloth folded that far within a cell. Real cloth of tension T bends within
/// sqrt(K / T) of the feature, and a cell away nothing of the bend is left. A plain hinge's moment, greatest
/// at such a fold, pushes vertices beside the feature away by K / (h T). As contacts of these vertices come
/// and go with the sliding material, that shakes the cloth.
/// Where the true bend is as wide as the hinge, 2 sqrt(K / T) > h, there are no creases (solver/eol/creases).
/// Their width h belongs to the mesh, not to the faces beside the feature. Those faces change as material
/// slides, so a fold would do work on them.
class Bending : public HingeTerm {
  public:
    /// `stiffness`: K, J, of each piece; 0 where none.
    explicit Bending(std::vector<double> stiffness) : stiffness_(std::move(stiffness)) {}

    EnergyKind energy_kind() const override { return EnergyKind::Bending; }
    double energy(const HingeState& hinge) const override;
    void add(const HingeState& hinge, HingeSystem& system) const override;

  private:
    /// K, J, of a hinge; on a seam that of two plates in series.
    double stiffness_of(const HingeElement& hinge) const;

    std::vector<double> stiffness_;  ///< by piece
};

}  // namespace arris
