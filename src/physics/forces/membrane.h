// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "physics/elements/term.h"

namespace arris {

/// In-plane elasticity: V = A (mu |Fbar - R|^2 + lambda/2 tr^2(R^T Fbar - I)). Here Fbar = P F is the
/// deformation gradient in the face's plane and R its rotation. In plane stress mu = E / (2 (1 + nu)),
/// lambda = E nu / (1 - nu^2): a strip stretched by the strain e has the tension E e per width, to first
/// order.
///
/// The code needs no decomposition. Fbar has F's singular values s1, s2. With f1, f2 the columns of F,
/// J = s1 s2 = |f1 x f2| and S = s1 + s2 = sqrt(|F|^2 + 2 J):
///   V/A = mu sum (s_i - 1)^2 + lambda/2 (S - 2)^2
///   P = dV/dF / A = 2 mu (F - R) + lambda (S - 2) R
///   R = (F + [f2 x n, n x f1]) / S   (3x2, orthonormal columns, n the unit normal)
/// The Hessian's eigenvalues in the plane are 2 mu (flip), 2 mu and 2 mu + 2 lambda (scaling) and 2 (mu +
/// lambda) (S - 2) / S (twist). Out of the plane they are those of the 2x2 matrix W with P = F W. Twist and W
/// can become negative under compression. Negative values are set to zero, so the stiffness is always
/// positive semi-definite.
///
/// Where material flows (X of a corner moves at fixed x), dA = A b_i . dX_i and dF = -F dX_i b_i^T. So
/// -dV/dX_i = F^T (A P b_i) - V b_i. The second term is the energy of the material that enters the face.
class Membrane : public FaceTerm {
  public:
    explicit Membrane(const Materials& materials);

    bool is_elastic() const override { return true; }
    EnergyKind energy_kind() const override { return EnergyKind::Stretch; }
    double energy(const FaceState& face) const override;
    void add(const FaceState& face, FaceSystem& system) const override;

  private:
    /// Lame constants of the sheet in plane stress, N/m.
    struct Moduli {
        double mu, lambda;
    };

    std::vector<Moduli> moduli_;  ///< by piece
};

/// Singular values of F, greatest first.
Vec2 principal_stretches(const Mat32& F);

/// Principal stretches of each face at these positions.
std::vector<Vec2> compute_stretches(const ClothElements& elements, const std::vector<Vec3>& position);

/// Tensions, N/m, along the principal directions of a face with these principal stretches: dV/ds_i / A.
/// Negative where the face is compressed. A strip that is compressed by the strain e has -E e.
Vec2 principal_tensions(const Vec2& stretches, const Material& material);

}  // namespace arris
