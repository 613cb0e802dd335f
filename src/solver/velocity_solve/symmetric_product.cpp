// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/symmetric_product.h"

#include <cmath>

namespace arris {

using Matrix = Eigen::SparseMatrix<double>;

namespace {

/// Calls `visit(row, column, value)` for each 3x3 block at or below the diagonal, by their first unknowns;
/// value(r, c) is an entry. Of a block on the diagonal only r >= c counts.
template <class Visit>
void for_each_block(const Matrix& matrix, const Visit& visit)
{
    const int *outer = matrix.outerIndexPtr(), *inner = matrix.innerIndexPtr();
    for (int column = 0; column < static_cast<int>(matrix.cols()); column += 3) {
        const int first = outer[column], stride = outer[column + 1] - first;
        const double* value = matrix.valuePtr() + first;
        for (int k = 0; k < stride; k += 3)
            visit(inner[first + k], column,
                  [=](int r, int c) -> double { return value[c * stride + k + r]; });
    }
}

}  // namespace

Eigen::VectorXd symmetric_product(const Matrix& matrix, const Eigen::VectorXd& x)
{
    Eigen::VectorXd product = Eigen::VectorXd::Zero(x.size());
    const double* from = x.data();
    double* to = product.data();
    for_each_block(matrix, [&](int row, int column, const auto& value) {
        if (row == column) {
            for (int r = 0; r < 3; ++r)
                for (int c = 0; c < 3; ++c)
                    to[row + r] += (r >= c ? value(r, c) : value(c, r)) * from[column + c];
            return;
        }
        for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r) {
                to[row + r] += value(r, c) * from[column + c];
                to[column + c] += value(r, c) * from[row + r];
            }
    });
    return product;
}

SymmetricProduct symmetric_product_with_magnitude(const Matrix& matrix, const Eigen::VectorXd& x)
{
    SymmetricProduct product = {Eigen::VectorXd::Zero(x.size()), Eigen::VectorXd::Zero(x.size())};
    const auto add = [&](int to, double term) {
        product.value[to] += term;
        product.magnitude[to] += std::abs(term);
    };
    for_each_block(matrix, [&](int row, int column, const auto& value) {
        const bool is_diagonal = row == column;
        for (int c = 0; c < 3; ++c)
            for (int r = is_diagonal ? c : 0; r < 3; ++r) {
                add(row + r, value(r, c) * x[column + c]);
                if (row + r != column + c) add(column + c, value(r, c) * x[row + r]);
            }
    });
    return product;
}

}  // namespace arris
