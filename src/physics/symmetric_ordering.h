// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

namespace arris {

/// AMD for Eigen's sparse Cholesky of small systems, the same order as Eigen's: that adds the matrix's
/// transpose to it first, but here it is symmetric already, and of a patch that costs as much as the order.
struct SymmetricAmdOrdering {
    using PermutationType = Eigen::AMDOrdering<int>::PermutationType;

    template <typename Matrix>
    void operator()(const Matrix& symmetric, PermutationType& order) const
    {
        Eigen::AMDOrdering<int>()(symmetric.template selfadjointView<Eigen::Lower>(), order);
    }
};

}  // namespace arris
