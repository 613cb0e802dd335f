// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/condensed_qp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace arris {
namespace {

constexpr double kComplementary = 1e-11;  // over the largest |q|; condition numbers are below 1e3

CondensedQp make_random_qp(int size, std::mt19937& random)
{
    std::normal_distribution<double> normal;
    const Eigen::MatrixXd g = Eigen::MatrixXd::NullaryExpr(size, size, [&] { return normal(random); });
    return {g * g.transpose() / size + 0.05 * Eigen::MatrixXd::Identity(size, size),
            Eigen::VectorXd::NullaryExpr(size, [&] { return normal(random); })};
}

std::optional<CondensedAnswer> solve(const CondensedQp& qp, const Eigen::VectorXd& start)
{
    DenseBudget unlimited = {std::numeric_limits<double>::infinity()};
    return solve_condensed_qp(qp, start, unlimited);
}

std::vector<char> make_random_set(int size, std::mt19937& random)
{
    std::vector<char> set(static_cast<std::size_t>(size));
    for (char& member : set) member = random() % 2;
    return set;
}

void expect_solved(const CondensedQp& qp, const std::optional<CondensedAnswer>& answer)
{
    ASSERT_TRUE(answer);
    const Eigen::VectorXd w = qp.hessian * answer->z + qp.linear;
    const double scale = qp.linear.lpNorm<Eigen::Infinity>();
    EXPECT_TRUE((answer->z.array() >= 0.0).all());
    EXPECT_LE((w - answer->w).lpNorm<Eigen::Infinity>(), kComplementary * scale);
    EXPECT_GE(w.minCoeff(), -kComplementary * scale);
    for (int i = 0; i < w.size(); ++i)
        EXPECT_TRUE(answer->is_positive[i] ? answer->w[i] <= 0.0 : answer->z[i] <= 0.0);
}

/// Exchanging all wrong members at once cycles from the empty set: {} -> {1,3} -> {0,1,2,3} -> {0,1} -> {}.
CondensedQp make_cycling_qp()
{
    const Eigen::Matrix4d s{{58, -2, 33, -16}, {-2, 7, 3, -9}, {33, 3, 28, -24}, {-16, -9, -24, 34}};
    return {s, Eigen::Vector4d(3, -6, 6, -3)};
}

TEST(CondensedQp, IsComplementaryToRoundOff)
{
    std::mt19937 random(1);
    for (int trial = 0; trial < 300; ++trial) {
        const CondensedQp qp = make_random_qp(1 + trial % 40, random);
        expect_solved(qp, solve(qp, Eigen::VectorXd::Zero(qp.linear.size())));
    }
}

TEST(CondensedQp, PivotingEndsInTheSameAnswerFromAnySet)
{
    std::mt19937 random(2);
    for (int trial = 0; trial < 200; ++trial) {
        const CondensedQp qp = make_random_qp(1 + trial % 25, random);
        const auto expected = solve(qp, Eigen::VectorXd::Zero(qp.linear.size()));
        const auto answer =
            solve_by_pivoting(qp, make_random_set(static_cast<int>(qp.linear.size()), random));
        expect_solved(qp, answer);
        ASSERT_TRUE(expected);
        EXPECT_EQ(answer->is_positive, expected->is_positive);
    }
}

TEST(CondensedQp, PivotingLeavesACycleOfBlockExchanges)
{
    const CondensedQp qp = make_cycling_qp();
    for (int set = 0; set < 16; ++set) {
        std::vector<char> start;
        for (int i = 0; i < 4; ++i) start.push_back(static_cast<char>(set >> i & 1));
        expect_solved(qp, solve_by_pivoting(qp, start));
    }
}

TEST(CondensedQp, UnitsChangeNothing)
{
    // Multipliers of 1e-12 N s and bounds of 1e12 are as exact as those of order 1. NLopt alone treats 1e-8
    // as zero.
    std::mt19937 random(4);
    for (const double unit : {1e-150, 1e-12, 1e-7, 1e7, 1e12, 1e150}) {
        const CondensedQp qp = make_random_qp(20, random);
        const auto expected = solve(qp, Eigen::VectorXd::Zero(20));
        const auto answer = solve({qp.hessian, qp.linear * unit}, Eigen::VectorXd::Zero(20));
        ASSERT_TRUE(expected && answer);
        EXPECT_GT(answer->nlopt_evaluations, 3);
        EXPECT_EQ(answer->is_positive, expected->is_positive);
        EXPECT_LE((answer->z / unit - expected->z).lpNorm<Eigen::Infinity>(), 1e-12);
        const auto stiffer = solve({qp.hessian * unit, qp.linear}, Eigen::VectorXd::Zero(20));
        ASSERT_TRUE(stiffer);
        EXPECT_LE((stiffer->z * unit - expected->z).lpNorm<Eigen::Infinity>(), 1e-12);
    }
}

TEST(CondensedQp, NLoptFindsTheSetSoThatPivotingHasNothingLeft)
{
    std::mt19937 random(5);
    const CondensedQp qp = make_random_qp(60, random);
    const auto answer = solve(qp, Eigen::VectorXd::Zero(60));
    ASSERT_TRUE(answer);
    EXPECT_LE(answer->nlopt_evaluations, 4 * 60 + 100);
    // Started from its own solution, the solver needs no iteration.
    const auto again = solve(qp, answer->z);
    ASSERT_TRUE(again);
    EXPECT_LE(again->nlopt_evaluations, 5);
    EXPECT_LE((again->z - answer->z).lpNorm<Eigen::Infinity>(), 1e-12);
}

TEST(CondensedQp, IsDecidedWithoutNLoptWhereNothingIsBelowItsBound)
{
    const CondensedQp qp = {Eigen::Matrix2d::Identity(), Eigen::Vector2d(0.0, 1.0)};
    const auto answer = solve(qp, Eigen::Vector2d::Zero());
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->nlopt_evaluations, 0);
    EXPECT_EQ(answer->z, Eigen::VectorXd(Eigen::Vector2d::Zero()));
}

TEST(CondensedQp, LivesWithTwoEqualBounds)
{
    // S is singular: the multipliers are not unique, but their effect is.
    const CondensedQp qp = {Eigen::Matrix2d::Ones(), Eigen::Vector2d(-1.0, -1.0)};
    const auto answer = solve(qp, Eigen::Vector2d::Zero());
    ASSERT_TRUE(answer);
    EXPECT_NEAR(answer->z.sum(), 1.0, 1e-11);
}

TEST(CondensedQp, RejectsWhatIsNotFiniteOrNotPositive)
{
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 infinity = std::numeric_limits<double>::infinity();
    Eigen::MatrixXd s = Eigen::Matrix2d::Identity();
    const Eigen::VectorXd q = Eigen::Vector2d(-1.0, -1.0), zero = Eigen::Vector2d::Zero();
    for (const double bad : {nan, infinity}) {
        s(1, 0) = bad;
        EXPECT_FALSE(solve({s, q}, zero));
        EXPECT_FALSE(solve({Eigen::Matrix2d::Identity(), Eigen::Vector2d(bad, -1.0)}, zero));
    }
    EXPECT_FALSE(solve({Eigen::Vector2d(1.0, 0.0).asDiagonal(), q}, zero));
    const Eigen::Matrix2d indefinite{{1.0, 2.0}, {2.0, 1.0}};
    EXPECT_FALSE(solve_by_pivoting({indefinite, q}, {1, 1}));
}

TEST(CondensedQp, IsSolvedWhereConstraintsDependOnEachOther)
{
    // S = G^T G with more columns than rows, some opposite or nearly equal, and the compliance of springs.
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    for (int trial = 0; trial < 100; ++trial) {
        const int rank = 1 + trial % 8, size = 4 * rank + 2;
        Eigen::MatrixXd g = Eigen::MatrixXd::NullaryExpr(rank, size, [&] { return normal(random); });
        g.col(1) = -g.col(0);
        for (int i = 2; i < rank + 2; ++i)
            g.col(i + rank) =
                (1.0 + std::pow(10.0, -(trial % 16))) * g.col(i) + Eigen::VectorXd::Constant(rank, 1e-9);
        const CondensedQp qp = {g.transpose() * g + 1e-4 * Eigen::MatrixXd::Identity(size, size),
                                Eigen::VectorXd::NullaryExpr(size, [&] { return normal(random); })};
        const Eigen::VectorXd zero = Eigen::VectorXd::Zero(size);
        const auto answer = solve(qp, zero);
        ASSERT_TRUE(answer);
        const Eigen::VectorXd w = qp.hessian * answer->z + qp.linear;
        const double slack = 1e-8 * qp.linear.lpNorm<Eigen::Infinity>();  // 1e-15 of S z, with z up to 1e4
        for (int i = 0; i < size; ++i) {
            EXPECT_GE(w[i], -slack);
            EXPECT_TRUE(answer->z[i] <= 0.0 || w[i] <= slack) << i << " " << w[i];
        }
    }
}

TEST(CondensedQp, EndsWhereItsWorkIsUsedUp)
{
    std::mt19937 random(8);
    const CondensedQp qp = make_random_qp(60, random);
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(60);
    DenseBudget budget = {1e9};
    ASSERT_TRUE(solve_condensed_qp(qp, zero, budget));
    const double used = 1e9 - budget.flops;
    EXPECT_GT(used, 60.0 * 60.0 * 10.0);
    budget.flops = 1.01 * used;
    EXPECT_TRUE(solve_condensed_qp(qp, zero, budget));
    budget.flops = 0.99 * used;
    EXPECT_FALSE(solve_condensed_qp(qp, zero, budget));
    EXPECT_LT(budget.flops, 0.0);
}

}  // namespace
}  // namespace arris
