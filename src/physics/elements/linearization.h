// SPDX-License-Identifier: GPL-3.0-or-later
// The velocity step is linear in the new velocity v' of every point:
//
//   f(q', v') ~ f(q^, v_k) - H (q' - q^) - damping H v' - D (v' - v_k),      H = -df/dq,  D = -df/dv,
//   q' = q~ + gamma v',   q^ = q~ + gamma v^,   M (v' - v~) = gamma f,
//
// with q~, v~, gamma from the integrator (implicit Euler: q~ = q_k, v~ = v_k, gamma = h, v^ = 0;
// BDF2: v^ = v_k). With v' = drift + B u (B: a vertex's basis, drift: the prescribed velocity) this becomes
//
//   B^T (M + (gamma^2 + gamma damping) H + gamma D) B u =
//   B^T (M (v~ - drift) + gamma f + H (gamma^2 (v^ - drift) - gamma damping drift) + gamma D (v_k - drift)).
//
// Material flows through some vertices (Eulerian-on-Lagrangian, EOL). Their material coordinates move too:
// X' = X~ + gamma V', V' = E u. In a face with deformation gradient F, the material at corner i has the
// corner velocity w_i = v_i - F V_i. With b_i the gradients of the shape functions, its acceleration is
//
//   dw_i/dt = vdot_i - F Vdot_i - 2 Fdot V_i,   Fdot = sum_j w_j b_j^T
//
// One term Fdot V arises because F changes, the other because material moves through the velocity's gradient
// Fdot. So in every element with an EOL corner, G_i = B_i - F E_i replaces B, and w~ = v~ - F V~ replaces v~.
// Likewise w^ and w_k replace v^ and v_k, and M (2 gamma Fdot V) is added to the right-hand side.
//
// Loads act on the material: G^T f. Energies V(x, X) of the cloth's shape act on the coordinates of its
// vertices: B^T f_x + E^T f_X, with f_x = -dV/dx at fixed X and f_X = -dV/dX at fixed x. F, Fdot and V are
// those of q^ for elasticity, and those of the extrapolated state for inertia and loads.
#pragma once

#include <optional>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// G = B - F E: maps u to the corner velocity, in a face, of a vertex with v' = B u, V' = E u.
inline Mat3 corner_matrix(const Mat32& F, const Mat3& basis, const Mat23& material_basis)
{
    return basis - F * material_basis;
}

/// State of the cloth at the step's end according to its history alone. Implicit Euler: the state at the
/// start. BDF2, w = h_k / h_(k-1): v = (1+w) v_k - w v_(k-1), x = q~ + gamma v; likewise X and V.
struct ExtrapolatedState {
    std::vector<Vec3> position;           ///< x, m
    std::vector<Vec3> velocity;           ///< v, m/s
    std::vector<Vec2> material;           ///< X, m, of each point
    std::vector<Vec2> material_velocity;  ///< V, m/s, likewise
};

/// The material part of a linearisation. Vectors have one entry per point of the material (on a seam, each
/// point of a vertex flows along its own side), but `is_eulerian` one per vertex. Material velocities and
/// bases are zero where no material flows. Every face with an EOL corner must be counter-clockwise in the
/// material, both at X^ and extrapolated.
struct MaterialFlow {
    std::vector<char> is_eulerian;
    std::vector<Mat23> basis;       ///< E: V' = basis u
    std::vector<Vec2> position;     ///< X^, m
    std::vector<Vec2> v_predicted;  ///< V~, m/s
    std::vector<Vec2> v_expansion;  ///< V^, m/s
    std::vector<Vec2> v_last;       ///< V_k, m/s
    ExtrapolatedState extrapolated;
};

/// Time, state and weights at which a step's forces are linearised. All vectors have one entry per vertex.
struct Linearization {
    double time = 0.0;                    ///< s, the step's end, at which forces are evaluated
    double begin = 0.0;                   ///< s, the step's start
    double gamma = 0.0;                   ///< s
    std::vector<double> damping = {0.0};  ///< s, stiffness-proportional, of each piece of cloth
    std::vector<Vec3> position;           ///< q^, m
    std::vector<Vec3> v_predicted;        ///< v~, m/s
    std::vector<Vec3> v_expansion;        ///< v^, m/s
    std::vector<Vec3> v_last;             ///< v_k, m/s

    // Coordinates of each vertex: v' = drift + basis u.
    std::vector<Vec3> drift;  ///< m/s
    std::vector<Mat3> basis;
    std::vector<char> has_basis;  ///< 0 where `basis` is the identity

    std::optional<MaterialFlow> flow;  ///< absent where no vertex is EOL
};

}  // namespace arris
