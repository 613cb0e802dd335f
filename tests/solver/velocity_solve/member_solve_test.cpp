// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/member_solve.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <random>

#include "solver/velocity_solve/slip_law.h"

namespace arris {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// Members that depend on each other, as in a stack: the mobility has few large eigenvalues, budgets are
/// spread over six orders, and half of the rows and pairs have springs in the base.
MemberProblem make_members(int pairs, int rows, int bounds, int rank, std::mt19937& random)
{
    constexpr double kCompliance = 1e-4;
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> order(-6.0, 0.0);
    const int size = 2 * pairs + rows + bounds;
    const Eigen::MatrixXd g = Eigen::MatrixXd::NullaryExpr(size, rank, [&] { return normal(random); });
    MemberProblem problem;
    problem.mobility = g * g.transpose() / rank + 1e-3 * Eigen::MatrixXd::Identity(size, size);
    problem.offset = g * Eigen::VectorXd::NullaryExpr(rank, [&] { return normal(random); });
    problem.now = Eigen::VectorXd::Zero(size);
    // A spring in the base leaves a mobility that is less than its compliance.
    Eigen::VectorXd stiffness = Eigen::VectorXd::Zero(size);
    for (int p = 0; p < pairs; ++p)
        if (p % 2 == 0) stiffness[2 * p] = stiffness[2 * p + 1] = 0.5 / kCompliance;
    for (int k = 0; k < rows; ++k)
        if (k % 2 == 0) stiffness[2 * pairs + k] = 1.0 / kCompliance;
    const Eigen::MatrixXd with_springs =
        (Eigen::MatrixXd::Identity(size, size) + problem.mobility * stiffness.asDiagonal())
            .lu()
            .solve(problem.mobility);
    problem.mobility = 0.5 * (with_springs + with_springs.transpose());
    for (int p = 0; p < pairs; ++p)
        problem.slipping.push_back({{2 * p, 2 * p + 1},
                                    kCompliance,
                                    std::pow(10.0, order(random)),
                                    Eigen::Vector2d(0.01 * normal(random), 0.0),
                                    stiffness[2 * p] * Eigen::Matrix2d::Identity(),
                                    Eigen::Vector2d::Zero()});
    for (int k = 2 * pairs; k < 2 * pairs + rows; ++k)
        problem.rows.push_back({k, kCompliance, 0.01 * normal(random), stiffness[k]});
    for (int k = 2 * pairs + rows; k < size; ++k) problem.bounds.push_back({k, 0.0});
    return problem;
}

/// Largest difference of the forces from what the laws give, N s; of bounds from complementarity.
double error_of(const MemberProblem& problem, const Eigen::VectorXd& forces)
{
    const Eigen::VectorXd change = problem.mobility * forces + problem.offset,
                          displacement = problem.now + change;
    double error = 0.0;
    for (const BoundMember& member : problem.bounds) {
        const double mobility = problem.mobility(member.place, member.place);
        error = std::max(error, std::abs(std::min(displacement[member.place] / mobility,
                                                  forces[member.place] + member.force)));
    }
    for (const RowMember& member : problem.rows) {
        const double x = displacement[member.place], whole = forces[member.place] + member.force -
                                                             member.base_stiffness * change[member.place];
        error = std::max(error, std::abs(whole - std::max(-x, 0.0) / member.compliance));
    }
    for (const SlipMember& pair : problem.slipping) {
        const Eigen::Vector2d x = displacement(pair.place), whole = forces(pair.place) + pair.force -
                                                                    pair.base_stiffness * change(pair.place);
        error = std::max(error, (whole - project_on_disc(-x / pair.compliance, pair.budget)).norm());
    }
    return error;
}

TEST(MemberSolve, MeetsAllLawsWhereMembersDependOnEachOther)
{
    std::mt19937 random(1);
    for (int trial = 0; trial < 60; ++trial) {
        MemberProblem problem =
            make_members(5 + trial, trial % 4 * 10, trial % 3 * 10, 6 + trial / 2, random);
        DenseBudget budget = {kUnlimited};
        int evaluations = 0;
        const auto forces = solve_members(problem, 1e-9, budget, evaluations);
        ASSERT_TRUE(forces) << trial;
        // A bound gives way by 1e-8 of its force.
        EXPECT_LE(error_of(problem, *forces), 1e-6 * (1.0 + forces->lpNorm<Eigen::Infinity>())) << trial;
    }
}

TEST(MemberSolve, WithoutFrictionIsExactByNlopt)
{
    std::mt19937 random(2);
    int evaluations = 0;
    for (int trial = 0; trial < 60; ++trial) {
        MemberProblem problem = make_members(0, 1 + trial, trial % 3 * 20, 6 + trial / 2, random);
        DenseBudget budget = {kUnlimited};
        const auto forces = solve_members(problem, 0.0, budget, evaluations);
        ASSERT_TRUE(forces) << trial;
        EXPECT_LE(error_of(problem, *forces), 1e-9 * (1.0 + forces->lpNorm<Eigen::Infinity>())) << trial;
    }
    EXPECT_GT(evaluations, 60);
}

TEST(MemberSolve, EndsWhereItsWorkIsUsedUp)
{
    std::mt19937 random(3);
    MemberProblem problem = make_members(30, 10, 10, 20, random);
    DenseBudget budget = {1e4};
    int evaluations = 0;
    EXPECT_FALSE(solve_members(problem, 1e-9, budget, evaluations));
    EXPECT_EQ(evaluations, 0);
}

TEST(MemberSolve, RefusesWhatIsNotFinite)
{
    std::mt19937 random(4);
    MemberProblem problem = make_members(3, 3, 3, 4, random);
    problem.offset[2] = std::numeric_limits<double>::quiet_NaN();
    DenseBudget budget = {kUnlimited};
    int evaluations = 0;
    EXPECT_FALSE(solve_members(problem, 1e-9, budget, evaluations));
}

}  // namespace
}  // namespace arris
