// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/velocity_solve/condensed_qp.h"

namespace arris {

/// What w = S z + q is at one z, so that elsewhere round-off is that of the distance alone.
struct KnownGap {
    Eigen::VectorXd z, w;
};

/// Solves a condensed problem with a unit diagonal from `answer.z` (moved into its bounds) by descent, for
/// matrices that are semidefinite to round-off, on which pivoting need not end: of those unknowns at a bound
/// that should leave it the worst is freed, and the free ones move towards their minimum as far as the first
/// bound met, which holds its unknown (Lawson and Hanson 1974, ch. 23; Stark and Parker 1995 for caps). z
/// never leaves its bounds and each move descends, so that dependent constraints are only work. False where
/// its bound on moves is hit, or a number is not finite.
bool descend(const CondensedQp& qp, const KnownGap& known, CondensedAnswer& answer);

}  // namespace arris
