// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/symmetric_product.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "geometry/batches.h"

namespace arris {

using Matrix = Eigen::SparseMatrix<double>;

namespace {

/// Calls `visit(row, column, value)` for each 3x3 block at or below the diagonal in the vertices' columns
/// [first, last); row and column are its first unknowns, and value(r, c) is an entry. Of a block on the
/// diagonal only r >= c counts.
template <class Visit>
void for_each_block(const Matrix& matrix, int first, int last, const Visit& visit)
{
    const int *outer = matrix.outerIndexPtr(), *inner = matrix.innerIndexPtr();
    for (int column = 3 * first; column < 3 * last; column += 3) {
        const int begin = outer[column], stride = outer[column + 1] - begin;
        const double* value = matrix.valuePtr() + begin;
        assert(stride % 3 == 0 && "whole blocks");
        for (int k = 0; k < stride; k += 3)
            visit(inner[begin + k], column,
                  [=](int r, int c) -> double { return value[c * stride + k + r]; });
    }
}

/// The sum of what `add(first, last, sum)` adds for the columns of each batch of vertices. Batches of columns
/// share rows: each has a sum of its own, so there are few.
template <class Add>
Eigen::VectorXd sum_columns(const Matrix& matrix, const Add& add)
{
    constexpr int kMostBatches = 8, kLeastSize = 3000;  // vertices, a third of a millisecond
    const int vertices = static_cast<int>(matrix.cols()) / 3,
              size = std::max(kLeastSize, (vertices + kMostBatches - 1) / kMostBatches);
    std::vector<Eigen::VectorXd> sums(static_cast<std::size_t>((vertices + size - 1) / size));
    for_each_batch(vertices, size, [&](int first, int last, int batch) {
        sums[batch] = Eigen::VectorXd::Zero(matrix.cols());
        add(first, last, sums[batch].data());
    });
    if (sums.empty()) return Eigen::VectorXd();
    for_each_batch(3 * vertices, 3 * size, [&](int first, int last, int) {
        for (std::size_t k = 1; k < sums.size(); ++k)
            sums[0].segment(first, last - first) += sums[k].segment(first, last - first);
    });
    return std::move(sums[0]);
}

}  // namespace

Eigen::VectorXd symmetric_product(const Matrix& matrix, const Eigen::VectorXd& x)
{
    const double* from = x.data();
    return sum_columns(matrix, [&](int first, int last, double* to) {
        for_each_block(matrix, first, last, [=](int row, int column, const auto& value) {
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
    });
}

Eigen::VectorXd product_of_magnitudes(const Matrix& matrix, const Eigen::VectorXd& x)
{
    const double* from = x.data();
    return sum_columns(matrix, [&](int first, int last, double* to) {
        for_each_block(matrix, first, last, [=](int row, int column, const auto& value) {
            const bool is_diagonal = row == column;
            for (int c = 0; c < 3; ++c)
                for (int r = is_diagonal ? c : 0; r < 3; ++r) {
                    to[row + r] += std::abs(value(r, c) * from[column + c]);
                    if (row + r != column + c) to[column + c] += std::abs(value(r, c) * from[row + r]);
                }
        });
    });
}

}  // namespace arris
