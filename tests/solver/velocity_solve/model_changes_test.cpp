// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/model_changes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "solver/velocity_solve/slip_law.h"
#include "tests/solver/cloth_system.h"
#include "tests/solver/row_problems.h"

namespace arris {
namespace {

using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Cloth that rests on its floor, with rows and with friction at every tenth vertex.
class ModelsOfACloth : public ::testing::Test {
  protected:
    void SetUp() override
    {
        VelocityProblem& problem = owned.problem;
        resting = VelocitySolver().solve(problem, Settings()).velocity;
        problem.rows = testing::make_rows(shape(), resting, testing::RowPattern::Spread, 12, 0.01, 3);
        for (int v = 0; 3 * v < resting.size(); v += 10) {
            FrictionPair pair;
            for (const int d : {0, 1}) {
                pair.slip[d].coordinate[0] = 3 * v + d;
                pair.slip[d].coefficient[0] = 1.0;
                pair.slip[d].count = 1;
            }
            pair.budget = 1e-4;
            pair.mass = 1e-3;
            problem.friction.push_back(pair);
        }
        constraints = scale_rows(problem, estimate_free_speed(problem));
        factorization.analyse(owned.matrix);
        laws.emplace(problem, constraints);
        base.emplace(problem, constraints, factorization);
        at = laws->start_from_guess();
        ASSERT_TRUE(base->factorise(at.wanted));
        members.emplace(*base, problem, constraints, unlimited);
    }

    static testing::ClothShape shape()
    {
        testing::ClothShape small;
        small.side = 6;
        return small;
    }

    /// Energy of cloth, rows, bounds and friction, by their definitions.
    double energy(const VectorXd& u) const
    {
        const VelocityProblem& problem = owned.problem;
        const Eigen::MatrixXd A = testing::dense_symmetric(owned.matrix);
        double sum = 0.5 * u.dot(A * u) - owned.rhs.dot(u);
        const auto push = [&](double depth, double compliance) {
            if (depth > 0.0) sum += 0.5 * depth * depth / compliance;
        };
        for (int i = 0; i < u.size(); ++i)
            if (std::isfinite(problem.lower[i])) push(problem.lower[i] - u[i], 1e-8 / A(i, i));
        for (int k = constraints.slip_count(); k < static_cast<int>(constraints.rows.size()); ++k)
            push(-gap(constraints.rows[k], u, 0.0), constraints.rows[k].compliance);
        for (int p = 0; p < constraints.pair_count(); ++p) {
            Vector2d y = Vector2d::Zero();
            for (const int d : {0, 1})
                for (const auto& [i, a] : constraints.rows[2 * p + d].entries) y[d] += a * u[i];
            const double v = unlimited_at(constraints, p, y).norm(), budget = constraints.budgets[p],
                         compliance = constraints.rows[2 * p].compliance;
            sum += compliance * (v <= budget ? 0.5 * v * v : budget * (v - 0.5 * budget));
        }
        return sum;
    }

    testing::OwnedProblem owned = testing::make_resting_cloth(shape(), 0.6);
    VectorXd resting;
    ConstraintRows constraints;
    Factorization factorization;
    DenseBudget unlimited = {kInfinity};
    std::optional<ContactLaws> laws;
    std::optional<SpringBase> base;
    std::optional<Members> members;
    ContactIterate at;
};

TEST_F(ModelsOfACloth, ABaseOfTheStateWantedHasNoChanges)
{
    EXPECT_EQ(find_changes(constraints, *base, *members, at.wanted).count, 0);
}

TEST_F(ModelsOfACloth, EveryDifferenceIsAChangeUntilItIsAMember)
{
    ContactState wanted = at.wanted;
    const int row = constraints.slip_count();
    wanted.is_pressing[row] = !wanted.is_pressing[row];
    wanted.stiffness[2] = Eigen::Matrix2d::Zero();
    int bound = 0;
    while (!std::isfinite(owned.problem.lower[bound])) ++bound;
    wanted.is_active[bound] = !wanted.is_active[bound];
    const ModelChanges changes = find_changes(constraints, *base, *members, wanted);
    EXPECT_EQ(changes.count, 4);
    EXPECT_EQ(changes.bounds, std::vector<int>{bound});
    EXPECT_EQ(changes.rows, (std::vector<int>{row, 4, 5}));
    members->extend(changes.bounds, changes.rows);
    const ModelChanges again = find_changes(constraints, *base, *members, wanted);
    EXPECT_EQ(again.count, 4);
    EXPECT_EQ(again.fresh(), 0);
}

TEST_F(ModelsOfACloth, AShareOfAStepHasTheLeastEnergyOnTheWay)
{
    const VectorXd solved = VelocitySolver().solve(owned.problem, Settings()).velocity,
                   zero = VectorXd::Zero(solved.size());
    for (const double length : {0.3, 1.0, 1.5, 4.0}) {  // of the way to the least energy of all
        const ContactPoint from = laws->make_point(zero), step = laws->make_point(length * solved);
        const double share = find_share(*laws, from, step);
        EXPECT_GT(share, 0.0);
        EXPECT_LE(share, 1.0);
        const double here = energy(share * step.velocity), gained = energy(zero) - here;
        EXPECT_GT(gained, 0.0);
        for (double other = 0.0; other <= 1.0; other += 0.01)  // it searches to a twentieth of the slope
            EXPECT_LE(here, energy(other * step.velocity) + 0.05 * gained) << length << ' ' << other;
    }
}

TEST_F(ModelsOfACloth, FirstChangesComeInTheOrderOfTheWay)
{
    // All of the cloth goes down: each row and bound is met where its gap is used up.
    VectorXd down = VectorXd::Zero(resting.size());
    for (Eigen::Index i = 2; i < down.size(); i += 3) down[i] = -1.0;
    const ContactPoint step = laws->make_point(down);
    at.point = laws->make_point(VectorXd::Zero(resting.size()));
    const ModelChanges all = find_first_changes(*laws, *base, *members, at, step, 10000);
    ASSERT_GT(all.fresh(), 6);
    const ModelChanges some = find_first_changes(*laws, *base, *members, at, step, 5);
    EXPECT_LE(some.fresh(), 5);
    EXPECT_GE(some.fresh(), 4);  // a pair needs two
    ASSERT_LE(some.bounds.size(), all.bounds.size());
    EXPECT_TRUE(std::equal(some.bounds.begin(), some.bounds.end(), all.bounds.begin()));
    EXPECT_TRUE(std::equal(some.rows.begin(), some.rows.end(), all.rows.begin()));
    double last = 0.0;
    for (const int i : all.bounds) {
        const double share = std::clamp(-owned.problem.lower[i], 0.0, 1.0);
        EXPECT_GE(share, last);
        last = share;
    }
}

}  // namespace
}  // namespace arris
