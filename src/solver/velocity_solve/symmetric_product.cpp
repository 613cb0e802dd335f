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

/// Adds the columns of the vertices [first, last) to `to`: term(a, x) of each entry a of A, also of those
/// above the diagonal, which are not stored.
template <class Term>
void add_columns(const Matrix& matrix, int first, int last, const double* from, const Term& term, double* to)
{
    const int *outer = matrix.outerIndexPtr(), *inner = matrix.innerIndexPtr();
    for (int column = 3 * first; column < 3 * last; column += 3) {
        const int begin = outer[column], stride = outer[column + 1] - begin;
        assert(stride % 3 == 0 && inner[begin] == column && "whole blocks, that on the diagonal first");
        const double *value = matrix.valuePtr() + begin, *x = from + column;
        double sum[3];
        for (int c = 0; c < 3; ++c) {
            sum[c] = 0.0;
            for (int r = 0; r < 3; ++r)
                sum[c] += term(r >= c ? value[c * stride + r] : value[r * stride + c], x[r]);
        }
        for (int k = 3; k < stride; k += 3) {
            const int row = inner[begin + k];
            double below[3] = {};
            for (int c = 0; c < 3; ++c)
                for (int r = 0; r < 3; ++r) {
                    const double entry = value[c * stride + k + r];
                    below[r] += term(entry, x[c]);
                    sum[c] += term(entry, from[row + r]);
                }
            for (int r = 0; r < 3; ++r) to[row + r] += below[r];
        }
        for (int c = 0; c < 3; ++c) to[column + c] += sum[c];
    }
}

/// The sum of all columns' terms. Batches of columns share rows: each has a sum of its own, so there are few.
template <class Term>
Eigen::VectorXd sum_columns(const Matrix& matrix, const Eigen::VectorXd& x, const Term& term)
{
    constexpr int kMostBatches = 8, kLeastSize = 3000;  // vertices, a third of a millisecond
    const int vertices = static_cast<int>(matrix.cols()) / 3,
              size = std::max(kLeastSize, (vertices + kMostBatches - 1) / kMostBatches);
    std::vector<Eigen::VectorXd> sums(static_cast<std::size_t>((vertices + size - 1) / size));
    for_each_batch(vertices, size, [&](int first, int last, int batch) {
        sums[batch] = Eigen::VectorXd::Zero(matrix.cols());
        add_columns(matrix, first, last, x.data(), term, sums[batch].data());
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
    return sum_columns(matrix, x, [](double a, double b) { return a * b; });
}

Eigen::VectorXd product_of_magnitudes(const Matrix& matrix, const Eigen::VectorXd& x)
{
    return sum_columns(matrix, x, [](double a, double b) { return std::abs(a * b); });
}

}  // namespace arris
