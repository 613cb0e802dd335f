// SPDX-License-Identifier: GPL-3.0-or-later
// The velocity step is linear in the new velocity v' of every point:
//
//   f(q', v') ~ f(q^, v_k) - H (q' - q^) - damping H v' - D (v' - v_k),      H = -df/dq,  D = -df/dv,
//   q' = q~ + gamma v',   q^ = q~ + gamma v^,   M (v' - v~) = gamma f,
//
// with q~, v~, gamma those of the integrator (implicit Euler: q~ = q_k, v~ = v_k, gamma = h, v^ = 0;
// BDF2: v^ = v_k). So with v' = drift + B u (B: a vertex's basis, drift: what is prescribed)
//
//   B^T (M + (gamma^2 + gamma damping) H + gamma D) B u =
//   B^T (M (v~ - drift) + gamma f + H (gamma^2 (v^ - drift) - gamma damping drift) + gamma D (v_k - drift)).
#pragma once

#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// Where, when and with which weights a step's forces are linearised. All vectors have one entry a vertex.
struct Linearization {
    double time = 0.0;              ///< s, the step's end: forces are taken then
    double begin = 0.0;             ///< s, the step's start
    double gamma = 0.0;             ///< s
    double damping = 0.0;           ///< s, stiffness-proportional
    std::vector<Vec3> position;     ///< q^, m
    std::vector<Vec3> v_predicted;  ///< v~, m/s
    std::vector<Vec3> v_expansion;  ///< v^, m/s
    std::vector<Vec3> v_last;       ///< v_k, m/s

    // The vertex's coordinates: v' = drift + basis u.
    std::vector<Vec3> drift;  ///< m/s
    std::vector<Mat3> basis;
    std::vector<char> has_basis;  ///< 0 where `basis` is the identity
};

}  // namespace arris
