// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/dense_solve.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <Eigen/Dense>
#include <cmath>
#include <optional>

namespace arris {
namespace {

/// Needs its pivots: the diagonal is zero, and rows are of sizes from 1 to 1e6.
Eigen::MatrixXd make_matrix(int size)
{
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Random(size, size);
    if (size > 1) matrix.diagonal().setZero();
    for (int i = 0; i < size; ++i) matrix.row(i) *= std::pow(10.0, i % 7);
    return matrix;
}

TEST(DenseSolve, IsAccurateForSizesAroundAPanel)
{
    for (const int size : {1, 2, 63, 64, 65, 128, 200, 321})
        for (const int columns : {1, 3, 64, 130}) {
            const Eigen::MatrixXd matrix = make_matrix(size),
                                  expected = Eigen::MatrixXd::Random(size, columns);
            const Eigen::MatrixXd solution = solve_dense(matrix, matrix * expected);
            EXPECT_LE((solution - expected).norm(), 1e-9 * expected.norm()) << size << " x " << columns;
        }
}

TEST(DenseSolve, IsTheSameWithAnyNumberOfThreads)
{
    const Eigen::MatrixXd matrix = make_matrix(321), rhs = Eigen::MatrixXd::Random(321, 70);
    std::optional<Eigen::MatrixXd> first;
    for (const std::size_t threads : {1, 2, 4}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        const Eigen::MatrixXd solution = solve_dense(matrix, rhs);
        if (!first) first = solution;
        EXPECT_EQ(solution, *first) << threads;
    }
}

TEST(DenseSolve, IsNotFiniteWhereTheMatrixIsSingular)
{
    for (const int size : {1, 64, 150}) {
        Eigen::MatrixXd matrix = make_matrix(size);
        matrix.col(size - 1).setZero();
        EXPECT_FALSE(solve_dense(matrix, Eigen::MatrixXd::Ones(size, 2)).allFinite()) << size;
    }
}

TEST(DenseSolve, OfNothingIsNothing)
{
    EXPECT_EQ(solve_dense(Eigen::MatrixXd(0, 0), Eigen::MatrixXd(0, 3)).cols(), 3);
    EXPECT_EQ(solve_dense(Eigen::MatrixXd::Identity(3, 3), Eigen::MatrixXd(3, 0)).rows(), 3);
}

}  // namespace
}  // namespace arris
