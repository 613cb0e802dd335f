// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/factorization.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <Eigen/Cholesky>
#include <limits>
#include <numeric>
#include <optional>
#include <random>

#include "tests/solver/cloth_system.h"

namespace arris {
namespace {

constexpr double kSolved = 1e-12;  // relative; condition numbers are below 1e3

Eigen::SparseMatrix<double> cloth_matrix(int side)
{
    testing::ClothShape shape;
    shape.side = side;
    shape.stretch = 10.0;
    return testing::make_cloth_system(shape).matrix;
}

std::vector<char> pin_every(int stride, Eigen::Index size)
{
    std::vector<char> is_pinned(static_cast<std::size_t>(size), 0);
    if (stride > 0)
        for (std::size_t i = 0; i < is_pinned.size(); i += static_cast<std::size_t>(stride)) is_pinned[i] = 1;
    return is_pinned;
}

/// 1 for each coordinate that is free.
Eigen::VectorXd free_of(const std::vector<char>& is_pinned)
{
    Eigen::VectorXd free(static_cast<Eigen::Index>(is_pinned.size()));
    for (int i = 0; i < free.size(); ++i) free[i] = is_pinned[i] ? 0.0 : 1.0;
    return free;
}

/// The matrix with the rows and columns of pinned coordinates replaced by those of the identity.
Eigen::MatrixXd pinned_densely(const Eigen::SparseMatrix<double>& matrix, const std::vector<char>& is_pinned)
{
    Eigen::MatrixXd dense = testing::dense_symmetric(matrix);
    for (int i = 0; i < dense.rows(); ++i) {
        if (!is_pinned[i]) continue;
        dense.row(i).setZero();
        dense.col(i).setZero();
        dense(i, i) = 1.0;
    }
    return dense;
}

void expect_solves(const Factorization& factorization, const Eigen::SparseMatrix<double>& matrix,
                   const std::vector<char>& is_pinned)
{
    Eigen::VectorXd rhs = Eigen::VectorXd::LinSpaced(matrix.rows(), -1.0, 2.0);
    for (int i = 0; i < rhs.size(); ++i)
        if (is_pinned[i]) rhs[i] = 0.0;
    const Eigen::VectorXd expected = pinned_densely(matrix, is_pinned).llt().solve(rhs);
    const Eigen::VectorXd solution = factorization.solve_backward(factorization.solve_forward(rhs));
    EXPECT_LE((solution - expected).norm(), kSolved * expected.norm());
}

/// Whether vertices have places in a plane, or METIS orders.
class EveryOrdering : public ::testing::TestWithParam<bool> {
  protected:
    void analyse(int side)
    {
        testing::ClothShape shape;
        shape.side = side;
        shape.stretch = 10.0;
        const testing::ClothSystem cloth = testing::make_cloth_system(shape);
        matrix = cloth.matrix;
        std::vector<Vec2> place;
        for (const Vec3& x : cloth.position) place.push_back(x.head<2>());
        factorization.analyse(matrix, GetParam() ? &place : nullptr);
    }

    Eigen::SparseMatrix<double> matrix;
    Factorization factorization;
};

TEST_P(EveryOrdering, SolvesWithAnyPinsOnOneAnalysis)
{
    analyse(9);
    for (const int stride : {0, 1, 2, 3, 7}) {
        const std::vector<char> is_pinned = pin_every(stride, matrix.rows());
        ASSERT_TRUE(factorization.factorise(matrix, is_pinned));
        expect_solves(factorization, matrix, is_pinned);
    }
}

TEST_P(EveryOrdering, EliminatesEveryUnknownOnce)
{
    for (const int side : {1, 2, 9}) {
        analyse(side);
        std::vector<int> position = factorization.position(), expected(position.size());
        std::sort(position.begin(), position.end());
        std::iota(expected.begin(), expected.end(), 0);
        EXPECT_EQ(position, expected);
    }
}

/// Large enough for several threads, and for fronts in tiles.
TEST_P(EveryOrdering, IsTheSameWithAnyNumberOfThreads)
{
    analyse(60);
    const EliminationTree& tree = factorization.tree();
    int largest = 0;
    for (int s = 0; s < tree.size(); ++s) largest = std::max(largest, tree.row_count(s));
    EXPECT_GT(largest, 250);
    const std::vector<char> is_pinned = pin_every(5, matrix.rows());
    Eigen::VectorXd rhs = Eigen::VectorXd::LinSpaced(matrix.rows(), -1.0, 2.0);
    std::optional<Eigen::VectorXd> first;
    for (const std::size_t threads : {1, 2, 4}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        for (int run = 0; run < 3; ++run) {
            ASSERT_TRUE(factorization.factorise(matrix, is_pinned));
            const Eigen::VectorXd solution = factorization.solve_backward(factorization.solve_forward(rhs));
            if (!first) {
                first = solution;
                Eigen::VectorXd residual =
                    matrix.selfadjointView<Eigen::Lower>() * solution.cwiseProduct(free_of(is_pinned)) - rhs;
                EXPECT_LE(residual.cwiseProduct(free_of(is_pinned)).norm(), 1e-10 * rhs.norm());
            }
            EXPECT_EQ(solution, *first);
        }
    }
}

/// Wherever it fails, a factorisation by several threads ends.
TEST_P(EveryOrdering, OfManyVerticesSaysWhereItIsNotPositiveDefinite)
{
    analyse(60);
    for (const int at : {0, 5000, static_cast<int>(matrix.rows()) - 1}) {
        const double value = matrix.coeff(at, at);
        matrix.coeffRef(at, at) = -value;
        EXPECT_FALSE(factorization.factorise(matrix, pin_every(0, matrix.rows())));
        matrix.coeffRef(at, at) = value;
        EXPECT_TRUE(factorization.factorise(matrix, pin_every(0, matrix.rows())));
    }
}

/// BLAS does not tell a NaN from a number: whoever uses the result does.
TEST_P(EveryOrdering, EndsWithValuesThatAreNoNumbers)
{
    analyse(60);
    matrix.coeffRef(5000, 5000) = std::numeric_limits<double>::quiet_NaN();
    const std::vector<char> is_pinned = pin_every(0, matrix.rows());
    if (!factorization.factorise(matrix, is_pinned)) return;
    EXPECT_FALSE(factorization.solve_forward(Eigen::VectorXd::Ones(matrix.rows())).allFinite());
}

INSTANTIATE_TEST_SUITE_P(Factorization, EveryOrdering, ::testing::Bool());

TEST(Factorization, SeesThatThePatternChanged)
{
    // Both lower triangles have equally many blocks in each column, so only their rows differ.
    Eigen::MatrixXd a = Eigen::MatrixXd::Identity(12, 12), b = a;
    a(3, 0) = 0.5;
    b(6, 0) = 0.5;
    const Eigen::SparseMatrix<double> first = testing::lower_blocks(a), second = testing::lower_blocks(b);
    Factorization factorization;
    for (const auto* matrix : {&first, &second, &first}) {
        factorization.analyse(*matrix);
        ASSERT_TRUE(factorization.factorise(*matrix, pin_every(0, 12)));
        expect_solves(factorization, *matrix, pin_every(0, 12));
    }
}

TEST(Factorization, HasNothingLeftOfWhatItFactorisedBefore)
{
    const Eigen::SparseMatrix<double> matrix = cloth_matrix(8), other = 2.0 * cloth_matrix(11);
    const Eigen::VectorXd rhs = Eigen::VectorXd::LinSpaced(matrix.rows(), -1.0, 2.0);
    Factorization fresh, used;
    fresh.analyse(matrix);
    ASSERT_TRUE(fresh.factorise(matrix, pin_every(5, matrix.rows())));
    used.analyse(other);
    ASSERT_TRUE(used.factorise(other, pin_every(0, other.rows())));
    used.analyse(matrix);
    ASSERT_FALSE(used.factorise(-matrix, pin_every(0, matrix.rows())));
    ASSERT_TRUE(used.factorise(matrix, pin_every(5, matrix.rows())));
    EXPECT_EQ(fresh.solve_forward(rhs), used.solve_forward(rhs));
}

TEST(Factorization, SaysWhereAMatrixIsNotPositiveDefinite)
{
    Eigen::SparseMatrix<double> matrix = cloth_matrix(6);
    Factorization factorization;
    factorization.analyse(matrix);
    matrix.coeffRef(20, 20) = -1.0;
    EXPECT_FALSE(factorization.factorise(matrix, pin_every(0, matrix.rows())));
    // The stiffness of a pinned coordinate does not matter.
    std::vector<char> is_pinned = pin_every(0, matrix.rows());
    is_pinned[20] = 1;
    ASSERT_TRUE(factorization.factorise(matrix, is_pinned));
    expect_solves(factorization, matrix, is_pinned);
}

TEST(Factorization, ReadsNothingAboveTheDiagonal)
{
    Eigen::SparseMatrix<double> matrix = cloth_matrix(5);
    Factorization factorization;
    factorization.analyse(matrix);
    for (int column = 0; column < matrix.cols(); ++column)
        for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, column); entry; ++entry)
            if (entry.row() < column) entry.valueRef() = 1e30;
    ASSERT_TRUE(factorization.factorise(matrix, pin_every(4, matrix.rows())));
    expect_solves(factorization, matrix, pin_every(4, matrix.rows()));
}

}  // namespace
}  // namespace arris
