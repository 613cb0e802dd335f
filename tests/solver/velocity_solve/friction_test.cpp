// SPDX-License-Identifier: GPL-3.0-or-later
// Friction in the velocity solve: yielding springs with given budgets (Tresca's friction).
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <random>

#include "solver/velocity_solve/constraint_rows.h"
#include "solver/velocity_solve/velocity_solve.h"
#include "tests/solver/cloth_system.h"

namespace arris {
namespace {

using testing::OwnedProblem;

constexpr double kCloseness = 1e-8;  // of the descent with stiff springs

ConstraintRow unit_row(int coordinate)
{
    ConstraintRow row;
    row.coordinate[0] = coordinate;
    row.coefficient[0] = 1.0;
    row.count = 1;
    return row;
}

/// Vertices that rest on bounds of their first coordinate and slip along the other two; some pairs and rows
/// lie across three vertices.
OwnedProblem make_slipping_problem(int vertices, std::mt19937& random)
{
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> chance;
    const int size = 3 * vertices;
    const Eigen::MatrixXd g = Eigen::MatrixXd::NullaryExpr(size, size, [&] { return normal(random); });
    OwnedProblem owned(
        testing::lower_blocks(g * g.transpose() / size + 0.1 * Eigen::MatrixXd::Identity(size, size)),
        Eigen::VectorXd::NullaryExpr(size, [&] { return normal(random); }));
    VelocityProblem& problem = owned.problem;
    const auto random_row = [&] {
        ConstraintRow row;
        for (int k = 0; k < 9 && k < size; ++k) {
            row.coordinate[row.count] = (7 * k + static_cast<int>(20 * chance(random))) % size;
            row.coefficient[row.count++] = normal(random);
        }
        row.lower = 0.1 * normal(random);
        return row;
    };
    for (int v = 0; v < vertices; ++v) {
        if (chance(random) < 0.7) problem.lower[3 * v] = 0.3 * normal(random);
        if (chance(random) < 0.1) problem.is_fixed[3 * v + 1] = 1;
        if (chance(random) < 0.2) continue;
        FrictionPair pair;
        pair.slip = {unit_row(3 * v + 1), unit_row(3 * v + 2)};
        if (chance(random) < 0.2) pair.slip = {random_row(), random_row()};
        pair.budget = chance(random) < 0.1 ? 0.0 : std::abs(normal(random));
        pair.mass = 0.3;
        for (int d = 0; d < 2; ++d) {
            pair.slip[d].expected = 0.3 * normal(random);
            pair.slip[d].lower += 0.1 * normal(random);
            pair.last[d] = chance(random) < 0.5 ? 0.0 : normal(random);
        }
        problem.friction.push_back(pair);
    }
    const int rows = static_cast<int>(3 * chance(random));
    for (int k = 0; k < rows; ++k) {
        problem.rows.push_back(random_row());
        problem.rows.back().group = k;
    }
    return owned;
}

/// The answer by projected descent on the dual, one bound, row or pair at a time, each pair by small steps.
struct Reference {
    Eigen::VectorXd velocity;
    std::vector<Eigen::Vector2d> friction;
};

Reference solve_by_descent(const VelocityProblem& problem)
{
    const ConstraintRows rows = scale_rows(problem, estimate_free_speed(problem));
    const int n = static_cast<int>(problem.rhs->size()), pairs = rows.slip_count(),
              count = static_cast<int>(rows.rows.size());
    std::vector<int> bounds;
    for (int i = 0; i < n; ++i)
        if (!problem.is_fixed[i] && std::isfinite(problem.lower[i])) bounds.push_back(i);
    const int m = count + static_cast<int>(bounds.size());
    Eigen::MatrixXd C = Eigen::MatrixXd::Zero(n, m);
    Eigen::VectorXd lower(m), compliance = Eigen::VectorXd::Zero(m);
    for (int k = 0; k < count; ++k) {
        for (const auto& [i, a] : rows.rows[k].entries) C(i, k) = a;
        lower[k] = rows.rows[k].lower;
        compliance[k] = rows.rows[k].compliance;
    }
    for (int k = count; k < m; ++k) {
        C(bounds[k - count], k) = 1.0;
        lower[k] = problem.lower[bounds[k - count]];
    }
    Eigen::MatrixXd A = testing::dense_symmetric(*problem.matrix);
    Eigen::VectorXd b = *problem.rhs;
    for (int i = 0; i < n; ++i) {
        if (!problem.is_fixed[i]) continue;
        A.row(i).setZero();
        A.col(i).setZero();
        A(i, i) = 1.0;
        b[i] = 0.0;
        C.row(i).setZero();
    }
    const Eigen::LLT<Eigen::MatrixXd> factor(A);
    const Eigen::MatrixXd Y = factor.solve(C);
    Eigen::MatrixXd S = C.transpose() * Y;
    S.diagonal() += compliance;
    const Eigen::VectorXd free = factor.solve(b), q = C.transpose() * free - lower;
    Eigen::VectorXd z = Eigen::VectorXd::Zero(m);
    for (int sweep = 0; sweep < 20000; ++sweep) {
        double change = 0.0;
        for (int k = 0; k < m; ++k) {
            if (k < pairs) {
                if (k % 2 == 1) continue;
                if (rows.rows[k].entries.empty() && rows.rows[k + 1].entries.empty()) continue;
                const double step = 1.0 / S.block<2, 2>(k, k).trace();
                Eigen::Vector2d next = z.segment<2>(k) - step * (S.middleRows<2>(k) * z + q.segment<2>(k));
                const double length = next.norm(), budget = rows.budgets[k / 2];
                if (length > budget) next *= budget / length;
                change = std::max(change, (next - z.segment<2>(k)).norm());
                z.segment<2>(k) = next;
                continue;
            }
            if (k < count && rows.rows[k].entries.empty()) continue;
            const double next = std::max(0.0, z[k] - (S.row(k).dot(z) + q[k]) / S(k, k));
            change = std::max(change, std::abs(next - z[k]));
            z[k] = next;
        }
        if (change < 1e-16) break;
    }
    Reference reference;
    reference.velocity = free + Y * z;
    for (int p = 0; p < pairs / 2; ++p)
        reference.friction.push_back(z.segment<2>(2 * p) / rows.rows[2 * p].scale);
    return reference;
}

TEST(Friction, EqualsDescentOnTheDual)
{
    std::mt19937 random(3);
    int sticking = 0, sliding = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const OwnedProblem owned = make_slipping_problem(2 + trial % 10, random);
        const VelocitySolution solution = VelocitySolver().solve(owned.problem, Settings());
        ASSERT_EQ(solution.status, SolveStatus::Certified) << trial;
        const Reference reference = solve_by_descent(owned.problem);
        for (std::size_t p = 0; p < owned.problem.friction.size(); ++p) {
            const double budget = owned.problem.friction[p].budget;
            (solution.unlimited[p].norm() < budget ? sticking : sliding) += budget > 0.0;
        }
        const double scale = reference.velocity.lpNorm<Eigen::Infinity>();
        EXPECT_LE((solution.velocity - reference.velocity).lpNorm<Eigen::Infinity>(), kCloseness * scale)
            << trial;
        for (std::size_t p = 0; p < reference.friction.size(); ++p)
            EXPECT_LE((solution.friction[p] - reference.friction[p]).norm(), 1e-5) << trial << " " << p;
    }
    EXPECT_GT(sticking, 100);
    EXPECT_GT(sliding, 100);
}

TEST(Friction, BudgetsFollowTheLaw)
{
    // Budgets that fall with the pair's own friction, and depend on its neighbour's: a fixed point.
    std::mt19937 random(11);
    OwnedProblem owned = make_slipping_problem(100, random);
    const std::vector<FrictionPair> pairs = owned.problem.friction;
    owned.problem.law = [&](const VelocitySolution& solution) {
        std::vector<double> budgets;
        for (std::size_t p = 0; p < pairs.size(); ++p) {
            const double other = solution.friction[(p + 1) % pairs.size()].norm();
            budgets.push_back(pairs[p].budget / (1.0 + other));
        }
        return budgets;
    };
    const VelocitySolution solution = VelocitySolver().solve(owned.problem, Settings());
    ASSERT_EQ(solution.status, SolveStatus::Certified);
    EXPECT_GT(solution.budget_moves, 1);
    EXPECT_LE(solution.law_residual, 2e-4);
    const std::vector<double> budgets = owned.problem.law(solution);
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        const double length = solution.unlimited[p].norm();
        const Eigen::Vector2d law = std::min(1.0, budgets[p] / length) * solution.unlimited[p];
        EXPECT_LE((solution.friction[p] - law).norm(), 1e-3) << p;
    }
}

TEST(Friction, NamesThePairThatIsFarthestOffItsLaw)
{
    // The budgets asked for alternate for ever at one pair.
    std::mt19937 random(11);
    OwnedProblem owned = make_slipping_problem(40, random);
    const std::vector<FrictionPair> pairs = owned.problem.friction;
    const VelocitySolution tresca = VelocitySolver().solve(owned.problem, Settings());
    int sliding = 0;
    while (tresca.friction[sliding].norm() < 0.999 * pairs[sliding].budget) ++sliding;
    int calls = 0;
    owned.problem.law = [&](const VelocitySolution&) {
        std::vector<double> budgets;
        for (const FrictionPair& pair : pairs) budgets.push_back(pair.budget);
        budgets[sliding] *= ++calls % 2 == 0 ? 1.0 : 0.5;
        return budgets;
    };
    const VelocitySolution solution = VelocitySolver().solve(owned.problem, Settings());
    EXPECT_GT(solution.law_residual, 1e-3);
    EXPECT_EQ(solution.law_worst, sliding);
}

TEST(Friction, RestsWhereNothingPushes)
{
    std::mt19937 random(11);
    OwnedProblem owned = make_slipping_problem(40, random);
    owned.rhs.setZero();
    owned.problem.lower.setConstant(-std::numeric_limits<double>::infinity());
    for (FrictionPair& pair : owned.problem.friction) {
        pair.last = {};
        for (ConstraintRow& slip : pair.slip) slip.lower = slip.expected = 0.0;
    }
    owned.problem.rows.clear();
    owned.problem.row_guess.clear();
    const std::vector<FrictionPair> pairs = owned.problem.friction;
    owned.problem.law = [&](const VelocitySolution&) { return std::vector<double>(pairs.size(), 0.0); };
    const VelocitySolution solution = VelocitySolver().solve(owned.problem, Settings());
    EXPECT_EQ(solution.status, SolveStatus::Certified);
    EXPECT_EQ(solution.velocity.lpNorm<Eigen::Infinity>(), 0.0);
}

TEST(Friction, TakesNoMoreWorkThanAllowed)
{
    std::mt19937 random(11);
    OwnedProblem owned = make_slipping_problem(400, random);
    const double all = VelocitySolver().solve(owned.problem, Settings()).work;
    ASSERT_GT(all, 2.0);
    for (const double share : {0.3, 0.6, 0.9}) {
        owned.problem.most_work = share * all;
        const VelocitySolution solution = VelocitySolver().solve(owned.problem, Settings());
        EXPECT_EQ(solution.status, SolveStatus::NotConverged);
        EXPECT_LE(solution.work, share * all + 1.0);
    }
}

// Two layers that stick to each other at a speed far above their slip: the springs' impulses would have the
// round-off of that speed.
TEST(Friction, IsAccurateWhereAllMovesFast)
{
    constexpr int kPairs = 20;
    constexpr double kSpeed = 1e3;
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    const int size = 6 * kPairs;
    const Eigen::VectorXd mass = Eigen::VectorXd::Constant(size, 0.1);
    Eigen::VectorXd free = Eigen::VectorXd::NullaryExpr(size, [&] { return 1e-3 * normal(random); });
    for (int v = 0; v < 2 * kPairs; ++v) free[3 * v] += kSpeed;
    OwnedProblem owned(testing::lower_blocks(mass.asDiagonal().toDenseMatrix()), mass.cwiseProduct(free));
    for (int p = 0; p < kPairs; ++p) {
        FrictionPair pair;
        for (int d = 0; d < 2; ++d) {  // along (1, 1, 0) and (0, 0, 1)
            for (const int side : {-1, 1})
                for (int c = d == 0 ? 0 : 2; c < (d == 0 ? 2 : 3); ++c) {
                    const int k = pair.slip[d].count++;
                    pair.slip[d].coordinate[k] = 6 * p + (side < 0 ? 0 : 3) + c;
                    pair.slip[d].coefficient[k] = side * (d == 0 ? std::sqrt(0.5) : 1.0);
                }
            pair.last[d] = 0.0;
        }
        pair.budget = 1.0;
        pair.mass = 0.1;
        owned.problem.friction.push_back(pair);
    }
    const VelocitySolution solution = VelocitySolver().solve(owned.problem, Settings());
    EXPECT_EQ(solution.status, SolveStatus::Certified);
    EXPECT_LE(solution.kkt_residual, 1e-12);
}

TEST(Friction, WithoutBudgetChangesNothing)
{
    std::mt19937 random(5);
    OwnedProblem owned = make_slipping_problem(8, random);
    for (FrictionPair& pair : owned.problem.friction) pair.budget = 0.0;
    const VelocitySolution with = VelocitySolver().solve(owned.problem, Settings());
    owned.problem.friction.clear();
    const VelocitySolution without = VelocitySolver().solve(owned.problem, Settings());
    EXPECT_LE((with.velocity - without.velocity).lpNorm<Eigen::Infinity>(), 1e-12);
}

}  // namespace
}  // namespace arris
