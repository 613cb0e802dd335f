// SPDX-License-Identifier: GPL-3.0-or-later
// Material that flows around a crease changes its direction. If the crease moves through the material with
// velocity V, the material that passes per length and time is rho (V . n). Its velocity changes from w_d to
// w_c, the velocities on the crease's two sides:
//
//   w_c - w_d = -(F_c - F_d) V        (the crease itself has one velocity v = w_c + F_c V = w_d + F_d V).
//
// The inertia of the faces beside the crease contains the acceleration inside each face, but not this jump.
// The crease must provide the force for the jump. Without that force, cloth that slides over an edge presses
// on it as if at rest, and lifts off late.
//
// The virtual velocity of the crease's material is the mean over its sides, v - (F_c + F_d)/2 V. With this
// choice, the power of the force is the kinetic energy that the flow carries from one side to the other.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "physics/elements/cloth_elements.h"
#include "physics/elements/linearization.h"

namespace arris {

/// The resistance of a crease's material, at both ends of the crease.
struct CreaseForce {
    std::array<int, 2> vertices, points;
    std::array<Vec3, 2> force;  ///< N
    Mat32 F;                    ///< mean over the crease's two sides
};

/// Forces with which material that turns at creases resists, at the extrapolated state.
/// Empty where `at.flow` is absent. Visits every hinge once.
std::vector<CreaseForce> find_momentum_flux(const Materials& materials, const ClothElements& elements,
                                            const Linearization& at);

/// Adds these forces, in the coordinates of the vertices and times gamma, to `rhs` (3 entries per vertex).
void add_momentum_flux(const Materials& materials, const ClothElements& elements, const Linearization& at,
                       Eigen::VectorXd& rhs);

}  // namespace arris
