// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/primal_prediction.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/solver/cloth_system.h"

namespace arris {
namespace {

std::vector<char> flags(const std::vector<int>& members, Eigen::Index size)
{
    std::vector<char> result(static_cast<std::size_t>(size), 0);
    for (const int i : members) result[i] = 1;
    return result;
}

int count_differences(const std::vector<char>& a, const std::vector<char>& b)
{
    int count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) count += (a[i] != 0) != (b[i] != 0);
    return count;
}

TEST(PrimalPrediction, FindsMostOfTheActiveSetFromTheUnconstrainedVelocity)
{
    testing::ClothShape shape;
    shape.side = 25;
    testing::OwnedProblem owned = testing::make_resting_cloth(shape, 0.5);
    owned.problem.is_fixed[2] = 1;
    const auto size = owned.rhs.size();
    const std::vector<int> active =
        testing::active_coordinates(VelocitySolver().solve(owned.problem, Settings()));
    testing::OwnedProblem unbounded = owned;
    unbounded.problem.lower.setConstant(-std::numeric_limits<double>::infinity());
    const Eigen::VectorXd start = VelocitySolver().solve(unbounded.problem, Settings()).velocity;

    const ActivePrediction prediction = predict_active_bounds(owned.problem, start);
    EXPECT_LE(prediction.nlopt_evaluations, 30);
    EXPECT_FALSE(prediction.is_active[2]);
    EXPECT_LE(5 * count_differences(prediction.is_active, flags(active, size)),
              static_cast<int>(active.size()));
}

TEST(PrimalPrediction, KeepsASolution)
{
    testing::ClothShape shape;
    shape.side = 12;
    const testing::OwnedProblem owned = testing::make_resting_cloth(shape, 0.5);
    const VelocitySolution solution = VelocitySolver().solve(owned.problem, Settings());
    const ActivePrediction prediction = predict_active_bounds(owned.problem, solution.velocity);
    EXPECT_EQ(count_differences(prediction.is_active,
                                flags(testing::active_coordinates(solution), owned.rhs.size())),
              0);
}

}  // namespace
}  // namespace arris
