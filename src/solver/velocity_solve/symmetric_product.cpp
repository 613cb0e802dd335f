// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/symmetric_product.h"

#include <cmath>

namespace arris {

using Matrix = Eigen::SparseMatrix<double>;

Eigen::VectorXd symmetric_product(const Matrix& matrix, const Eigen::VectorXd& x)
{
    Eigen::VectorXd product = Eigen::VectorXd::Zero(x.size());
    for (int column = 0; column < matrix.cols(); ++column) {
        double sum = 0.0;
        for (Matrix::InnerIterator entry(matrix, column); entry; ++entry) {
            const auto row = entry.row();
            if (row < column) continue;
            sum += entry.value() * x[row];
            if (row > column) product[row] += entry.value() * x[column];
        }
        product[column] += sum;
    }
    return product;
}

SymmetricProduct symmetric_product_with_magnitude(const Matrix& matrix, const Eigen::VectorXd& x)
{
    SymmetricProduct product = {Eigen::VectorXd::Zero(x.size()), Eigen::VectorXd::Zero(x.size())};
    for (int column = 0; column < matrix.cols(); ++column) {
        double sum = 0.0, magnitude = 0.0;
        for (Matrix::InnerIterator entry(matrix, column); entry; ++entry) {
            const auto row = entry.row();
            if (row < column) continue;
            const double right = entry.value() * x[row];
            sum += right;
            magnitude += std::abs(right);
            if (row == column) continue;
            const double left = entry.value() * x[column];
            product.value[row] += left;
            product.magnitude[row] += std::abs(left);
        }
        product.value[column] += sum;
        product.magnitude[column] += magnitude;
    }
    return product;
}

}  // namespace arris
