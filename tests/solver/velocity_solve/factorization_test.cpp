// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/factorization.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <numeric>
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

class EveryOrdering : public ::testing::TestWithParam<VertexOrdering> {};

TEST_P(EveryOrdering, SolvesWithAnyPinsOnOneAnalysis)
{
    const Eigen::SparseMatrix<double> matrix = cloth_matrix(9);
    Factorization factorization(GetParam());
    factorization.analyse(matrix);
    for (const int stride : {0, 1, 2, 3, 7}) {
        const std::vector<char> is_pinned = pin_every(stride, matrix.rows());
        ASSERT_TRUE(factorization.factorise(matrix, is_pinned));
        expect_solves(factorization, matrix, is_pinned);
    }
}

TEST_P(EveryOrdering, EliminatesEveryUnknownOnce)
{
    for (const int side : {1, 2, 9}) {
        const Eigen::SparseMatrix<double> matrix = cloth_matrix(side);
        Factorization factorization(GetParam());
        factorization.analyse(matrix);
        std::vector<int> position = factorization.position(), expected(position.size());
        std::sort(position.begin(), position.end());
        std::iota(expected.begin(), expected.end(), 0);
        EXPECT_EQ(position, expected);
    }
}

INSTANTIATE_TEST_SUITE_P(Factorization, EveryOrdering,
                         ::testing::Values(VertexOrdering::Metis, VertexOrdering::NestedDissection,
                                           VertexOrdering::Amd));

TEST(Factorization, SeesThatThePatternChanged)
{
    // Both lower triangles have equally many entries in each column, so only the row indices differ.
    Eigen::MatrixXd a = Eigen::MatrixXd::Identity(12, 12), b = a;
    a(3, 0) = 0.5;
    b(6, 0) = 0.5;
    const Eigen::SparseMatrix<double> first = a.sparseView(), second = b.sparseView();
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
