// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "solver/velocity_solve/condensed_qp.h"

namespace arris {

/// The springs that a base has for members of a working set. With w0 = g u - lower they give the multipliers
/// f - K w0.
struct MemberSprings {
    std::vector<int> members;               ///< places in the working set
    Eigen::SparseMatrix<double> stiffness;  ///< K: 1 / give for a row, a block for a friction pair
    Eigen::VectorXd force;                  ///< f, N s
    Eigen::VectorXd gives;                  ///< 1/kg: w = w0 + give z
};

/// Lets the multipliers of these members take the place of their springs. `qp` is the problem with the
/// springs acting, and without the members' gives: w0 = S (z - f + K w0) + q, so with the springs taken out
/// w0 = (1 - S K)^-1 (S z + q - S f).
void take_out_springs(const MemberSprings& springs, CondensedQp& qp);

/// The part of the multipliers z that the springs do not give, at these members: z - f + K w0.
/// `answer`: of the problem without the springs.
Eigen::VectorXd beyond_springs(const MemberSprings& springs, const CondensedAnswer& answer);

}  // namespace arris
