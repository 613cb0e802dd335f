// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/contact_laws.h"

#include <gtest/gtest.h>

#include <Eigen/Sparse>
#include <cmath>

#include "tests/solver/cloth_system.h"

namespace arris {
namespace {

using Eigen::Vector2d;
using Eigen::VectorXd;

/// One particle of 2 kg: a bound along x, a row along y, friction in the plane of y and z.
class LawsOfAParticle : public ::testing::Test {
  protected:
    void SetUp() override
    {
        VelocityProblem& problem = owned.problem;
        problem.lower[0] = 0.5;
        problem.rows.push_back(unit_row(1));
        problem.rows[0].lower = 0.25;
        FrictionPair pair;
        pair.slip = {unit_row(1), unit_row(2)};
        pair.budget = 3.0;
        pair.mass = 2.0;
        problem.friction.push_back(pair);
        problem.law = [](const VelocitySolution& solution) {
            return std::vector<double>{0.5 * solution.multipliers[0]};
        };
        constraints = scale_rows(problem, estimate_free_speed(problem));
        laws.emplace(problem, constraints);
    }

    static ConstraintRow unit_row(int coordinate)
    {
        ConstraintRow row;
        row.coordinate[0] = coordinate;
        row.coefficient[0] = 1.0;
        row.count = 1;
        return row;
    }

    ContactIterate evaluate_at(const Eigen::Vector3d& u)
    {
        ContactIterate at = laws->start_from_guess();
        at.point = laws->make_point(u);
        at.multipliers.setConstant(std::nan(""));
        laws->evaluate(std::vector<char>(constraints.rows.size(), 1), at);
        return at;
    }

    testing::OwnedProblem owned{testing::lower_blocks(2.0 * Eigen::MatrixXd::Identity(3, 3)),
                                VectorXd::Constant(3, -4.0)};
    ConstraintRows constraints;
    std::optional<ContactLaws> laws;
};

TEST_F(LawsOfAParticle, RowPushesByItsSpringOnly)
{
    const double compliance = constraints.rows[2].compliance;
    EXPECT_NEAR(evaluate_at({1.0, 0.25 - compliance, 0.0}).multipliers[2], 1.0, 1e-6);
    EXPECT_EQ(evaluate_at({1.0, 0.3, 0.0}).multipliers[2], 0.0);
    EXPECT_FALSE(evaluate_at({1.0, 0.3, 0.0}).wanted.is_pressing[2]);
    EXPECT_TRUE(evaluate_at({1.0, 0.2, 0.0}).wanted.is_pressing[2]);
}

TEST_F(LawsOfAParticle, FrictionSticksWithinItsBudgetAndOpposesSlipBeyond)
{
    const double compliance = constraints.rows[0].compliance;
    const ContactIterate sticking = evaluate_at({1.0, -compliance, 2.0 * compliance});
    EXPECT_LE((sticking.multipliers.head<2>() - Vector2d(1.0, -2.0)).norm(), 1e-6);
    EXPECT_LE((sticking.wanted.stiffness[0] - Eigen::Matrix2d::Identity() / compliance).norm(),
              1e-9 / compliance);
    const ContactIterate sliding = evaluate_at({1.0, -3.0, 4.0});
    EXPECT_LE((sliding.multipliers.head<2>() - 3.0 * Vector2d(0.6, -0.8)).norm(), 1e-9);
}

TEST_F(LawsOfAParticle, BoundHoldsByWhatIsLeftOver)
{
    const ContactIterate at = evaluate_at({0.5, 1.0, 0.0});
    EXPECT_TRUE(at.wanted.is_active[0]);
    EXPECT_NEAR(at.bound_force(0), 5.0, 1e-12);  // 2 * .5 + 4
    EXPECT_FALSE(evaluate_at({0.6, 1.0, 0.0}).wanted.is_active[0]);
    EXPECT_TRUE(evaluate_at({0.4, 1.0, 0.0}).wanted.is_active[0]);
}

TEST_F(LawsOfAParticle, BudgetsFollowTheForceOnTheBound)
{
    const LawfulBudgets lawful = laws->find_budgets(evaluate_at({0.5, 1.0, 4.0}));
    ASSERT_EQ(lawful.budgets.size(), 1);
    EXPECT_NEAR(lawful.budgets[0], 2.5, 1e-12);  // half of 5, where the problem has 3
    EXPECT_NEAR(lawful.error, 0.5 / 2.5, 1e-9);
    EXPECT_EQ(lawful.worst, 0);
}

TEST_F(LawsOfAParticle, ALawThatIsNotFiniteIsAnErrorThatIsNot)
{
    owned.problem.law = [](const VelocitySolution&) { return std::vector<double>{std::nan("")}; };
    const LawfulBudgets lawful = laws->find_budgets(evaluate_at({0.5, 1.0, 4.0}));
    EXPECT_FALSE(lawful.error <= 1.0);
}

TEST_F(LawsOfAParticle, AnAnswerIsWhereTheNextSolveStarts)
{
    ContactIterate at = evaluate_at({0.5, 1.0, 4.0});
    constraints.budgets[0] = 2.5;
    const ContactAnswer answer = laws->make_answer(at);
    constraints.budgets[0] = 3.0;
    const ContactIterate again = laws->start_from(answer);
    EXPECT_EQ(again.point.velocity, at.point.velocity);
    EXPECT_EQ(again.wanted.is_active, at.wanted.is_active);
    EXPECT_NEAR(constraints.budgets[0], 2.5, 1e-15);
}

}  // namespace
}  // namespace arris
