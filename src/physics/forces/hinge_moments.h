// SPDX-License-Identifier: GPL-3.0-or-later
// Bending moments of a plate of straight-edged triangles, one a hinge: the lowest-order
// Hellan-Herrmann-Johnson (HHJ) element, Comodi 1989, in the form of Neunteufel and Schoeberl 2019 for
// shells. The energy is
//
//   V = max over m of  sum_hinges L m s  -  sum_faces A/2 M : S(M),      s = 2 sin(theta/2),
//
// with L an edge's length, A a face's area, both in the material. M is the symmetric moment tensor (2x2, N)
// of a face with n . M n = m on its three edges. S(M) = ((1 + nu) M - nu tr(M) I) / K is the curvature that M
// causes. (The paper has the angle theta for s. Both agree to third order, and s is bounded.)
//
// Neighbouring faces share m, so a hinge's angle is split between its two faces as the least energy has it.
// That makes the plate's rigidity that of the material on any mesh: for a surface of constant curvature the
// maximum is at the exact M. Fixed shares, as half of theta for each face, have a rigidity that depends on
// the mesh. Without a moment an edge is free: borders, and creases, which have an energy of their own.
//
// The moments solve B m = L s, one equation a hinge, with at most five entries a row. They are functions of
// positions alone, and no unknowns of a step.
//
// In the step's matrix each hinge has a stiffness of its own, W, a diagonal that is nowhere below B^-1. In
// the elastic force this only weighs the change of velocity, q' - q^. Damping would be W s' instead of
// B^-1 s', about twice as much: so B^-1 s_k' + W (s' - s_k') is taken, with s_k' of the velocity before the
// step. As 0 <= B^-1 <= W, it takes energy for any step: (M + a W)^-1 (M + a (W - B^-1)) contracts.
#pragma once

#include <array>
#include <vector>

#include "physics/elements/cloth_elements.h"
#include "physics/elements/linearization.h"
#include "physics/elements/term.h"

namespace arris {

/// The material of a plate.
struct PlateMaterial {
    double stiffness;      ///< K, J: a strip with free sides and curvature k has the moment K k per width
    double poisson_ratio;  ///< between -1 and 1
};

/// Moments of all hinges at `position`, one entry per hinge; zero on creases and on pieces without stiffness.
/// `plates`: the material of each piece. With `at->flow`, faces with an EOL
/// vertex are those at flow->position. Where `at` has damping, the moments' rates at v_k are found, too.
/// Linear in face count on well-shaped meshes, where the condition of the equations does not depend on the
/// cells' size. Serial, so independent of the number of threads.
std::vector<HingeMoment> find_hinge_moments(const std::vector<PlateMaterial>& plates,
                                            const ClothElements& elements, const std::vector<Vec3>& position,
                                            const Linearization* at);

/// Compliance of a face, 1/J: A M : S(M) = sum_ij y_i y_j (i, j), where y_i = L_i^2 m_i belongs to the edge
/// opposite corner i.
Mat3 plate_compliance(const PlateMaterial& plate, const FaceElement& face);

/// Derivatives of A/2 M : S(M) by the material coordinates of the face's corners, N, where `y` stays.
std::array<Vec2, 3> plate_energy_gradients(const PlateMaterial& plate, const FaceElement& face,
                                           const Vec3& y);

}  // namespace arris
