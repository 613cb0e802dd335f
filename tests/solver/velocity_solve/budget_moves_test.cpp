// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/budget_moves.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <functional>
#include <random>

namespace arris {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Moves until the map gives back what it got, to `accuracy` of the largest budget.
int count_moves(VectorXd budgets, const std::function<VectorXd(const VectorXd&)>& law, double accuracy)
{
    constexpr int kMost = 200;
    BudgetMoves moves;
    while (moves.count() < kMost) {
        const VectorXd wanted = law(budgets);
        if ((wanted - budgets).lpNorm<Eigen::Infinity>() <= accuracy * wanted.lpNorm<Eigen::Infinity>())
            break;
        budgets = moves.next(budgets, wanted);
        EXPECT_TRUE(budgets.allFinite());
        EXPECT_GE(budgets.minCoeff(), 0.0);
    }
    return moves.count();
}

TEST(BudgetMoves, FindTheFixedPointOfALinearMapInItsDimension)
{
    // One move to start from and one for each of three directions; repetition would need 100.
    const MatrixXd map = (MatrixXd(3, 3) << 0.5, 0.3, 0.1, 0.2, 0.4, 0.2, 0.1, 0.2, 0.4).finished();
    const VectorXd offset = VectorXd::LinSpaced(3, 1.0, 2.0);
    const auto law = [&](const VectorXd& b) { return VectorXd(map * b + offset); };
    EXPECT_LE(count_moves(offset, law, 1e-9), 8);
}

TEST(BudgetMoves, ReachFarAheadWhereForcesFollowSlowly)
{
    // Two contacts press the harder the more friction each has. Repetition comes nearer to the fixed point by
    // a share of 1 - rate a move.
    for (const double rate : {0.5, 0.9, 0.99, 0.997}) {
        const auto law = [&](const VectorXd& b) {
            return VectorXd((VectorXd(3) << (1.0 - rate) * 3.0 + rate * b[1],
                             (1.0 - rate) * 3.1 + rate * b[0], 2.0 + 0.1 * b[0])
                                .finished());
        };
        EXPECT_LE(count_moves(VectorXd::Ones(3), law, 1e-5), 8) << rate;
    }
}

TEST(BudgetMoves, FollowContactsThatCouple)
{
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    for (int run = 0; run < 50; ++run) {
        const Eigen::Index size = 40;
        MatrixXd map = MatrixXd::NullaryExpr(size, size, [&] { return normal(random); });
        map *= 0.6 / map.operatorNorm();
        const VectorXd offset = VectorXd::NullaryExpr(size, [&] { return std::abs(normal(random)) + 0.1; });
        const auto law = [&](const VectorXd& b) { return VectorXd((map * b + offset).cwiseMax(0.0)); };
        EXPECT_LE(count_moves(offset, law, 2e-5), 20) << run;
    }
}

TEST(BudgetMoves, SettleContactsThatTakeTurns)
{
    // Whoever has more than 1 loses half of it to the other: repeated, that goes to and fro without end.
    const auto law = [](const VectorXd& b) {
        return VectorXd((VectorXd(2) << 2.2 - b[1], 2.2 - b[0]).finished());
    };
    const VectorXd start = (VectorXd(2) << 0.4, 0.4).finished();
    EXPECT_LE(count_moves(start, law, 2e-5), 40);
}

TEST(BudgetMoves, AreZeroAtOnceWhereNothingPresses)
{
    BudgetMoves moves;
    VectorXd budgets = VectorXd::Constant(2, 3.0);
    for (int k = 0; k < 4; ++k) {
        const VectorXd wanted = (VectorXd(2) << 0.0, 1.0).finished();
        budgets = moves.next(budgets, wanted);
        EXPECT_EQ(budgets[0], 0.0);
        EXPECT_GT(budgets[1], 0.0);
    }
    EXPECT_NEAR(budgets[1], 1.0, 1e-12);
}

TEST(BudgetMoves, StayWithinThreeTimesWhatTheLawGives)
{
    // Differences that hardly differ make weights large.
    BudgetMoves moves;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(0.5, 1.0);
    VectorXd budgets = VectorXd::Ones(8);
    for (int k = 0; k < 10; ++k) {
        const VectorXd wanted = VectorXd::NullaryExpr(8, [&] { return uniform(random); });
        const VectorXd next = moves.next(budgets, wanted);
        for (Eigen::Index p = 0; p < 8; ++p) {
            EXPECT_LE(next[p], 3.0 * std::max(budgets[p], wanted[p]));
            EXPECT_GE(next[p], std::min(budgets[p], wanted[p]) / 3.0);
        }
        budgets = next;
    }
}

}  // namespace
}  // namespace arris
