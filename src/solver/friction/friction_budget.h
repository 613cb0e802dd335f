// SPDX-License-Identifier: GPL-3.0-or-later
// How much friction a contact can give. On faces and points Coulomb's law, mu times the normal impulse. On a
// sharp edge or wire the cloth turns by an angle phi in no length, and the capstan's law holds: over a
// rounded edge, however small its radius, the tension T beyond rho V^2 grows by dT = mu p ds, so the tensions
// of both sides differ by a factor of at most exp(mu phi). In the impulses that the two sides ask of the
// vertex (physics/feature_impulse) the budget is
//
//   c = tanh(mu phi cos psi / 2) / cos psi (T_up + T_down + mu cos psi (P_up - P_down)) + mu (P_up + P_down)
//
// with psi the angle of the slip from across the feature, T the tensions, P the impulses of sides that lie on
// a face, "up" the side from which the material comes. Along the feature (cos psi = 0) it is mu phi / 2 (T_up
// + T_down).
#pragma once

#include <vector>

#include "physics/system/feature_impulse.h"
#include "solver/friction/friction_pairs.h"

namespace arris {

/// Budgets, N s, one a contact that can slip, from a solution's impulses. 0 where a contact does not press.
std::vector<double> compute_budgets(const SlippingCloth& cloth, const Terms& terms,
                                    const std::vector<SlipContact>& slip_contacts,
                                    const VelocitySolution& solution);

}  // namespace arris
