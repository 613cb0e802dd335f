// SPDX-License-Identifier: GPL-3.0-or-later
// Material that flows around a crease is turned: where the crease passes through the material with the
// velocity V, rho (V . n) of it a length and a second changes its velocity from w_d to w_c, those of the
// material on the crease's two sides,
//
//   w_c - w_d = -(F_c - F_d) V        (the crease itself has one velocity v = w_c + F_c V = w_d + F_d V).
//
// The inertia of the faces beside it knows the acceleration inside of each and nothing of this jump, which
// the crease has to provide: without it cloth that slides over an edge presses on it as if it were at rest,
// and lifts off late. The virtual velocity of the crease's material is the mean of its sides', v - (F_c +
// F_d)/2 V: then the power of this force is the kinetic energy that the flow carries from one side to the
// other.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "physics/cloth_elements.h"
#include "physics/linearization.h"

namespace arris {

/// A crease's resistance at both its ends.
struct CreaseForce {
    std::array<int, 2> vertices;
    std::array<Vec3, 2> force;  ///< N
    Mat32 F;                    ///< the mean of its sides'
};

/// The force with which material turned at creases resists, at the extrapolated state. `density` is areal,
/// kg/m^2. Nothing where `at.flow` is absent; the cost is a look at each hinge.
std::vector<CreaseForce> find_momentum_flux(double density, const ClothElements& elements,
                                            const Linearization& at);

/// The same in the vertices' coordinates, times gamma, added to `rhs` (3 a vertex).
void add_momentum_flux(double density, const ClothElements& elements, const Linearization& at,
                       Eigen::VectorXd& rhs);

}  // namespace arris
