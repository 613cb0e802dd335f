// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/working_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/solver/cloth_system.h"
#include "tests/solver/dense_reference.h"

namespace arris {
namespace {

/// A small cloth on its floor. Half of its active bounds and some inactive ones are pinned; one vertex is
/// fixed.
class WorkingSetOfACloth : public ::testing::Test {
  protected:
    void SetUp() override
    {
        owned.problem.is_fixed[0] = owned.problem.is_fixed[1] = owned.problem.is_fixed[2] = 1;
        reference = testing::solve_densely(owned.problem);
        std::vector<char> is_active(owned.problem.is_fixed.size(), 0);
        for (int i = 0; i < reference.velocity.size(); ++i) {
            if (owned.problem.is_fixed[i] || std::isinf(owned.problem.lower[i])) continue;
            bounded.push_back(i);
            is_active[i] = reference.multipliers[i] > 0.0 ? i % 2 == 1 : i % 5 == 0;
        }
        factorization.analyse(owned.matrix);
        base = solve_pinned(owned.problem, constraints, is_active, {}, {}, factorization);
        ASSERT_TRUE(base);
    }

    static testing::ClothShape shape()
    {
        testing::ClothShape small;
        small.side = 6;
        return small;
    }

    double worst_residual_of_the_free(const Iterate& iterate) const
    {
        double worst = 0.0;
        for (int i = 0; i < iterate.gradient.size(); ++i)
            if (!owned.problem.is_fixed[i] && !iterate.is_active[i])
                worst = std::max(worst, std::abs(iterate.gradient[i]) / iterate.magnitude[i]);
        return worst;
    }

    testing::OwnedProblem owned = testing::make_resting_cloth(shape(), 0.6);
    ConstraintRows constraints;
    testing::DenseAnswer reference;
    std::vector<int> bounded;
    Factorization factorization;
    std::optional<PinnedBase> base;
    DenseBudget unlimited = {std::numeric_limits<double>::infinity()};
};

constexpr double kRoundOff = 1e-12;

TEST_F(WorkingSetOfACloth, BaseHoldsItsPinsAndSolvesTheRest)
{
    EXPECT_LE(worst_residual_of_the_free(base->iterate), kRoundOff);
    for (const int i : bounded)
        if (base->iterate.is_active[i]) {
            EXPECT_EQ(base->iterate.velocity[i], owned.problem.lower[i]);
        }
    for (int i = 0; i < 3; ++i) EXPECT_EQ(base->iterate.velocity[i], 0.0);
}

TEST_F(WorkingSetOfACloth, OfAllBoundsSolvesTheWholeProblem)
{
    WorkingSet set(*base);
    set.extend(bounded);
    Iterate iterate;
    int evaluations = 0;
    ASSERT_TRUE(set.solve(iterate, evaluations, unlimited));
    EXPECT_GT(evaluations, 0);
    EXPECT_LE((iterate.velocity - reference.velocity).norm(), 1e-10 * reference.velocity.norm());
    for (const int i : bounded) EXPECT_EQ(iterate.is_active[i] != 0, reference.multipliers[i] > 0.0);
}

TEST_F(WorkingSetOfACloth, GrowsInAnyOrderToTheSameAnswer)
{
    std::mt19937 random(1);
    std::shuffle(bounded.begin(), bounded.end(), random);
    WorkingSet set(*base);
    Iterate iterate;
    int evaluations = 0;
    for (std::size_t first = 0; first < bounded.size(); first += 5) {
        set.extend({bounded.begin() + static_cast<std::ptrdiff_t>(first),
                    bounded.begin() + static_cast<std::ptrdiff_t>(std::min(first + 5, bounded.size()))});
        ASSERT_TRUE(set.solve(iterate, evaluations, unlimited));
        EXPECT_LE(worst_residual_of_the_free(iterate), 1e-10);
    }
    EXPECT_EQ(set.size(), static_cast<int>(bounded.size()));
    EXPECT_LE((iterate.velocity - reference.velocity).norm(), 1e-10 * reference.velocity.norm());
}

TEST_F(WorkingSetOfACloth, RefinementTakesAnErrorOutAtOnce)
{
    WorkingSet set(*base);
    set.extend(bounded);
    Iterate iterate;
    int evaluations = 0;
    ASSERT_TRUE(set.solve(iterate, evaluations, unlimited));
    for (int i = 0; i < iterate.velocity.size(); ++i)
        if (!owned.problem.is_fixed[i] && !iterate.is_active[i]) iterate.velocity[i] += 1e-3 * std::cos(i);
    evaluate_gradient(*base, iterate);
    ASSERT_GT(worst_residual_of_the_free(iterate), 1e-4);
    ASSERT_TRUE(set.refine(iterate));
    EXPECT_LE(worst_residual_of_the_free(iterate), kRoundOff);
    EXPECT_LE((iterate.velocity - reference.velocity).norm(), 1e-10 * reference.velocity.norm());
}

}  // namespace
}  // namespace arris
