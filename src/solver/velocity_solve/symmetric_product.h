// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>

namespace arris {

/// A x, where `matrix` holds the lower triangle of the symmetric A in whole 3x3 blocks; entries above the
/// diagonal are ignored.
Eigen::VectorXd symmetric_product(const Eigen::SparseMatrix<double>& matrix, const Eigen::VectorXd& x);

/// |A| |x|, the scale of the round-off in A x.
Eigen::VectorXd product_of_magnitudes(const Eigen::SparseMatrix<double>& matrix, const Eigen::VectorXd& x);

}  // namespace arris
