// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>

namespace arris {

/// `value` = A x and `magnitude` = |A| |x|, the scale of the round-off in `value`.
struct SymmetricProduct {
    Eigen::VectorXd value, magnitude;
};

/// A is the symmetric matrix whose lower triangle `matrix` holds; entries above the diagonal are ignored.
Eigen::VectorXd symmetric_product(const Eigen::SparseMatrix<double>& matrix, const Eigen::VectorXd& x);
SymmetricProduct symmetric_product_with_magnitude(const Eigen::SparseMatrix<double>& matrix,
                                                  const Eigen::VectorXd& x);

}  // namespace arris
