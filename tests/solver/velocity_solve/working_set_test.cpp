// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/working_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/solver/cloth_system.h"
#include "tests/solver/dense_reference.h"
#include "tests/solver/row_problems.h"

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

// The base has a spring for every row, and so also for those that do not press: they pull.
TEST(WorkingSet, TakesOutTheSpringsThatPull)
{
    testing::ClothShape shape;
    shape.side = 10;
    testing::OwnedProblem owned = testing::make_resting_cloth(shape, 0.4);
    VelocityProblem& problem = owned.problem;
    const VelocitySolution resting = VelocitySolver().solve(problem, Settings());
    for (const testing::RowPattern pattern : {testing::RowPattern::Spread, testing::RowPattern::Clusters}) {
        problem.rows = testing::make_rows(shape, resting.velocity, pattern, 150, 0.01, 3);
        const VelocitySolution answer = VelocitySolver().solve(problem, Settings());
        ASSERT_EQ(answer.status, SolveStatus::Certified);

        const ConstraintRows constraints = scale_rows(problem, estimate_free_speed(problem));
        std::vector<char> is_active(problem.is_fixed.size(), 0);
        std::vector<int> bounded, rows;
        for (int i = 0; i < problem.lower.size(); ++i)
            if (std::isfinite(problem.lower[i]) && !problem.is_fixed[i]) bounded.push_back(i);
        for (int k = 0; k < static_cast<int>(constraints.rows.size()); ++k)
            if (!constraints.rows[k].entries.empty()) rows.push_back(k);
        Factorization factorization;
        factorization.analyse(owned.matrix);
        const std::optional<PinnedBase> base = solve_pinned(
            problem, constraints, is_active, std::vector<char>(rows.size(), 1), {}, factorization);
        ASSERT_TRUE(base);
        ASSERT_LT(base->iterate.row_multipliers.minCoeff(), 0.0) << "no spring pulls";

        WorkingSet set(*base);
        set.extend(bounded, rows);
        Iterate iterate;
        int evaluations = 0;
        DenseBudget unlimited = {std::numeric_limits<double>::infinity()};
        ASSERT_TRUE(set.solve(iterate, evaluations, unlimited));
        const auto expect_answer = [&] {
            EXPECT_LE((iterate.velocity - answer.velocity).norm(), 1e-10 * answer.velocity.norm());
            for (const int k : rows)
                EXPECT_NEAR(iterate.row_multipliers[k], answer.row_multipliers[k] * constraints.rows[k].scale,
                            1e-7 * answer.row_multipliers.maxCoeff());
            EXPECT_GE(iterate.row_multipliers.minCoeff(), 0.0);
        };
        expect_answer();
        // Refinement keeps them out, too.
        for (int i = 0; i < iterate.velocity.size(); ++i)
            if (!problem.is_fixed[i] && !iterate.is_active[i]) iterate.velocity[i] += 1e-3 * std::cos(i);
        evaluate_gradient(*base, iterate);
        ASSERT_TRUE(set.refine(iterate));
        expect_answer();
    }
}

}  // namespace
}  // namespace arris
