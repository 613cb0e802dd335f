// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/forward_columns.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/solver/cloth_system.h"

namespace arris {
namespace {

constexpr double kRoundOff = 1e-12;

SparseVector random_column(int unknowns, std::mt19937& random)
{
    std::normal_distribution<double> normal;
    SparseVector column;
    const int entries = static_cast<int>(random() % 8);  // possibly empty: all its neighbours are pinned
    for (int k = 0; k < entries; ++k)
        column.emplace_back(static_cast<int>(random() % unknowns), normal(random));
    return column;
}

class ForwardColumnsOfACloth : public ::testing::Test {
  protected:
    void SetUp() override
    {
        testing::ClothShape shape;
        shape.side = 15;
        const Eigen::SparseMatrix<double> matrix = testing::make_cloth_system(shape).matrix;
        factorization.analyse(matrix);
        ASSERT_TRUE(
            factorization.factorise(matrix, std::vector<char>(static_cast<std::size_t>(matrix.rows()), 0)));
        unknowns = static_cast<int>(matrix.rows());
    }

    /// Compares batches smaller and larger than a panel with `dense`, the result of full forward solves.
    void fill(ForwardColumns& columns)
    {
        std::mt19937 random(1);
        for (const int count : {1, 16, 0, 17, 40}) {
            std::vector<SparseVector> batch;
            for (int c = 0; c < count; ++c) {
                batch.push_back(random_column(unknowns, random));
                Eigen::VectorXd rhs = Eigen::VectorXd::Zero(unknowns);
                for (const auto& [unknown, value] : batch.back()) rhs[unknown] += value;
                dense.conservativeResize(unknowns, dense.cols() + 1);
                dense.rightCols(1) = factorization.solve_forward(rhs);
            }
            columns.append(batch);
            ASSERT_EQ(columns.size(), dense.cols());
        }
    }

    Factorization factorization;
    int unknowns = 0;
    Eigen::MatrixXd dense;
};

TEST_F(ForwardColumnsOfACloth, GramMatrixIsThatOfDenseSolves)
{
    ForwardColumns columns(factorization);
    fill(columns);
    const Eigen::MatrixXd expected = dense.transpose() * dense;
    EXPECT_LE((columns.gram() - expected).norm(), kRoundOff * expected.norm());
}

TEST_F(ForwardColumnsOfACloth, ProductsAreThoseOfDenseSolves)
{
    ForwardColumns columns(factorization);
    fill(columns);
    const Eigen::VectorXd f = Eigen::VectorXd::LinSpaced(unknowns, -1.0, 1.0),
                          c = Eigen::VectorXd::LinSpaced(columns.size(), 1.0, 3.0);
    const Eigen::VectorXd dot = dense.transpose() * f, sum = f + dense * c;
    EXPECT_LE((columns.dot(f) - dot).norm(), kRoundOff * dot.norm());
    Eigen::VectorXd accumulated = f;
    columns.accumulate(c, accumulated);
    EXPECT_LE((accumulated - sum).norm(), kRoundOff * sum.norm());
}

}  // namespace
}  // namespace arris
