// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/symmetric_product.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "tests/solver/cloth_system.h"

namespace arris {
namespace {

/// Large enough for two batches of columns.
Eigen::SparseMatrix<double> large_matrix()
{
    testing::ClothShape shape;
    shape.side = 60;
    return testing::make_cloth_system(shape).matrix;
}

TEST(SymmetricProduct, IsThatOfTheWholeMatrix)
{
    const Eigen::SparseMatrix<double> matrix = large_matrix();
    const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(matrix.rows(), -1.0, 2.0);
    const Eigen::VectorXd expected = matrix.selfadjointView<Eigen::Lower>() * x;
    EXPECT_LE((symmetric_product(matrix, x) - expected).norm(), 1e-13 * expected.norm());
    const Eigen::VectorXd magnitude =
        Eigen::SparseMatrix<double>(matrix.cwiseAbs()).selfadjointView<Eigen::Lower>() * x.cwiseAbs();
    EXPECT_LE((product_of_magnitudes(matrix, x) - magnitude).norm(), 1e-13 * magnitude.norm());
}

TEST(SymmetricProduct, ReadsNothingAboveTheDiagonal)
{
    const Eigen::MatrixXd random = Eigen::MatrixXd::Random(12, 12), symmetric = random + random.transpose();
    const Eigen::SparseMatrix<double> lower = testing::lower_blocks(symmetric);  // nonsense above
    const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(12, -1.0, 2.0);
    EXPECT_LE((symmetric_product(lower, x) - symmetric * x).norm(), 1e-13);
    EXPECT_LE((product_of_magnitudes(lower, x) - symmetric.cwiseAbs() * x.cwiseAbs()).norm(), 1e-13);
}

TEST(SymmetricProduct, IsTheSameWithAnyNumberOfThreads)
{
    const Eigen::SparseMatrix<double> matrix = large_matrix();
    const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(matrix.rows(), -1.0, 2.0);
    const Eigen::VectorXd expected = symmetric_product(matrix, x);
    for (const std::size_t threads : {1, 2, 4}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        EXPECT_EQ(symmetric_product(matrix, x), expected) << threads;
    }
}

TEST(SymmetricProduct, OfNothingIsNothing)
{
    EXPECT_EQ(symmetric_product(Eigen::SparseMatrix<double>(0, 0), Eigen::VectorXd()).size(), 0);
}

}  // namespace
}  // namespace arris
