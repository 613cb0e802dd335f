// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/system/block_ordering.h"

#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <vector>

namespace arris {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

/// Positive definite matrix of an n x n grid of vertices, with a 3 x 3 block for each vertex and each grid
/// edge.
Matrix make_grid_matrix(int n)
{
    std::vector<Eigen::Triplet<double>> entries;
    const auto add_block = [&](int v, int w, double diagonal) {
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c)
                entries.emplace_back(3 * v + r, 3 * w + c, r == c ? diagonal : 0.01 * (r + c));
    };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const int v = i * n + j;
            add_block(v, v, 5.0);
            for (const int w : {j + 1 < n ? v + 1 : -1, i + 1 < n ? v + n : -1}) {
                if (w < 0) continue;
                add_block(v, w, -1.0);
                add_block(w, v, -1.0);
            }
        }
    Matrix matrix(3 * n * n, 3 * n * n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

template <typename Ordering>
using Factor = Eigen::SimplicialLDLT<Matrix, Eigen::Lower, Ordering>;

TEST(BlockOrdering, FillsInAsLittleAsAmdOfTheRowsAndKeepsAVertexTogether)
{
    for (const int n : {1, 2, 7, 20}) {
        const Matrix matrix = make_grid_matrix(n), lower = matrix.triangularView<Eigen::Lower>();
        const Factor<BlockAmdOrdering> factor(lower);
        const Factor<Eigen::AMDOrdering<int>> of_rows(lower);
        ASSERT_EQ(factor.info(), Eigen::Success);
        const auto& order = factor.permutationP().indices();
        std::vector<char> is_taken(matrix.rows(), 0);
        for (int row = 0; row < matrix.rows(); ++row) {
            EXPECT_EQ(is_taken[order[row]]++, 0);
            EXPECT_EQ(order[row], order[row - row % 3] + row % 3) << n;
        }
        const Matrix fill = factor.matrixL(), fill_of_rows = of_rows.matrixL();
        constexpr int kTies = 20;  // AMD breaks ties by input order; this allows a difference of 5 %
        EXPECT_LE(fill.nonZeros(), fill_of_rows.nonZeros() + fill_of_rows.nonZeros() / kTies) << n;
        const Eigen::VectorXd rhs = Eigen::VectorXd::LinSpaced(matrix.rows(), -1.0, 1.0);
        EXPECT_LT((matrix * factor.solve(rhs) - rhs).norm(), 1e-12 * rhs.norm()) << n;
    }
}

TEST(BlockOrdering, SeesWhatAnyOfAVertexsRowsHasInCommonWithAnothers)
{
    // The first rows are not coupled to others, as for vertices that leave a feature straight up.
    const auto is_apart = [](Eigen::Index row, Eigen::Index column, double) {
        return row / 3 == column / 3 || (row % 3 != 0 && column % 3 != 0);
    };
    Matrix matrix = make_grid_matrix(20);
    matrix.prune(is_apart);
    const Matrix lower = matrix.triangularView<Eigen::Lower>();
    const Factor<BlockAmdOrdering> factor(lower);
    const Factor<Eigen::AMDOrdering<int>> of_rows(lower);
    ASSERT_EQ(factor.info(), Eigen::Success);
    const Matrix fill = factor.matrixL(), fill_of_rows = of_rows.matrixL();
    EXPECT_LE(fill.nonZeros(), fill_of_rows.nonZeros() + fill_of_rows.nonZeros() / 10);
}

}  // namespace
}  // namespace arris
