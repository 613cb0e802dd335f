// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/velocity_solve/condensed_qp.h"

namespace arris {

/// The value w = S z + q at one z. Elsewhere w is computed from this one, so that its round-off grows only
/// with the distance from z.
struct KnownGap {
    Eigen::VectorXd z, w;
};

/// Solves a condensed problem with a unit diagonal by descent, from `answer.z` moved into its bounds. For
/// matrices that are semidefinite to round-off, on which pivoting need not end. Each step frees the unknown
/// at a bound whose multiplier has the worst sign. The free unknowns then move towards their minimum as far
/// as the first bound, which holds its unknown from then on (Lawson and Hanson 1974, ch. 23; Stark and Parker
/// 1995 for caps). z never leaves its bounds and every move descends, so dependent constraints only cost
/// time. False where the limit on moves is hit or a number is not finite.
bool descend(const CondensedQp& qp, const KnownGap& known, CondensedAnswer& answer);

}  // namespace arris
