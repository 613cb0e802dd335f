// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/constraint_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/solver/cloth_system.h"
#include "tests/solver/row_problems.h"

namespace arris {
namespace {

using testing::OwnedProblem;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kCertified = 1e-9;  // Settings::tolerance
constexpr double kAccurate = 1e-12;  // residual down to which the solver refines

VelocitySolution solve(const VelocityProblem& problem)
{
    return VelocitySolver().solve(problem, Settings());
}

ConstraintRow make_row(std::initializer_list<std::pair<int, double>> entries, double lower, int group = 0)
{
    ConstraintRow row;
    for (const auto& [coordinate, coefficient] : entries) {
        row.coordinate[row.count] = coordinate;
        row.coefficient[row.count++] = coefficient;
    }
    row.lower = lower;
    row.group = group;
    return row;
}

/// Matrix G G^T / size + 0.1, well conditioned; some coordinates have bounds, some are fixed.
OwnedProblem make_random_problem(int vertices, std::mt19937& random)
{
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> chance;
    const int size = 3 * vertices;
    const Eigen::MatrixXd g = Eigen::MatrixXd::NullaryExpr(size, size, [&] { return normal(random); });
    const Eigen::MatrixXd a = g * g.transpose() / size + 0.1 * Eigen::MatrixXd::Identity(size, size);
    OwnedProblem owned(testing::lower_blocks(a),
                       Eigen::VectorXd::NullaryExpr(size, [&] { return normal(random); }));
    const double bounded = chance(random), fixed = 0.3 * chance(random);
    for (int i = 0; i < size; ++i) {
        if (chance(random) < bounded) owned.problem.lower[i] = 0.5 * normal(random);
        owned.problem.is_fixed[i] = chance(random) < fixed;
    }
    return owned;
}

/// A row with up to six random entries, sometimes with a repeated coordinate. `feasible` satisfies the row.
ConstraintRow make_random_row(const VelocityProblem& problem, const Eigen::VectorXd& feasible,
                              std::mt19937& random)
{
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> chance;
    ConstraintRow row;
    row.count = 1 + static_cast<int>(random() % 6);
    const double scale = std::pow(10.0, 6.0 * chance(random) - 3.0);
    for (int k = 0; k < row.count; ++k) {
        row.coordinate[k] = static_cast<int>(random() % feasible.size());
        row.coefficient[k] = scale * normal(random);
        if (!problem.is_fixed[row.coordinate[k]])
            row.lower += row.coefficient[k] * feasible[row.coordinate[k]];
    }
    row.lower -= scale * std::max(0.0, 0.3 * normal(random));
    row.group = static_cast<int>(random() % 4);
    return row;
}

/// A point that satisfies all bounds, and rows that this point satisfies too.
OwnedProblem make_feasible_problem(int vertices, int rows, std::mt19937& random)
{
    OwnedProblem owned = make_random_problem(vertices, random);
    std::normal_distribution<double> normal;
    Eigen::VectorXd feasible = Eigen::VectorXd::NullaryExpr(3 * vertices, [&] { return normal(random); });
    for (int i = 0; i < feasible.size(); ++i)
        feasible[i] = owned.problem.is_fixed[i] ? 0.0 : std::max(feasible[i], owned.problem.lower[i]);
    for (int k = 0; k < rows; ++k)
        owned.problem.rows.push_back(make_random_row(owned.problem, feasible, random));
    return owned;
}

std::vector<int> random_subset(int size, double share, std::mt19937& random)
{
    std::uniform_real_distribution<double> chance;
    std::vector<int> subset;
    for (int i = 0; i < size; ++i)
        if (chance(random) < share) subset.push_back(i);
    return subset;
}

TEST(ConstraintRows, EqualADenseReferenceFromAnyGuess)
{
    std::mt19937 random(7);
    int pressing = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const int rows = 1 + trial % 9;
        OwnedProblem owned = make_feasible_problem(1 + trial % 7, rows, random);
        const auto reference = testing::solve_by_hildreth(owned.problem);
        pressing += static_cast<int>((reference.row_multipliers.array() > 0.0).count());
        const double scale = std::max(reference.velocity.lpNorm<Eigen::Infinity>(), 1e-3);
        for (int guess = 0; guess < 4; ++guess) {
            owned.problem.guess = random_subset(static_cast<int>(owned.rhs.size()), 0.3 * guess, random);
            owned.problem.row_guess = random_subset(rows, 0.3 * guess, random);
            const VelocitySolution solution = solve(owned.problem);
            ASSERT_EQ(solution.status, SolveStatus::Certified)
                << trial << " " << guess << " " << solution.kkt_residual;
            ASSERT_LE(testing::dense_kkt_residual_of_rows(owned.problem, solution), kAccurate) << trial;
            ASSERT_LE((solution.velocity - reference.velocity).lpNorm<Eigen::Infinity>(), 1e-9 * scale)
                << trial << " " << guess;
        }
    }
    EXPECT_GT(pressing, 300);
}

TEST(ConstraintRows, ThatCannotBeMetEqualTheElasticReference)
{
    std::mt19937 random(8);
    int infeasible = 0;
    for (int trial = 0; trial < 200; ++trial) {
        OwnedProblem owned = make_random_problem(1 + trial % 5, random);
        const Eigen::VectorXd nothing = Eigen::VectorXd::Zero(owned.rhs.size());
        for (int k = 0; k < 2 + trial % 6; ++k) {
            owned.problem.rows.push_back(make_random_row(owned.problem, nothing, random));
            owned.problem.rows.back().lower = std::abs(owned.problem.rows.back().coefficient[0]);
        }
        const auto reference = testing::solve_by_hildreth(owned.problem);
        const VelocitySolution solution = solve(owned.problem);
        ASSERT_TRUE(solution.status == SolveStatus::Certified || solution.status == SolveStatus::Infeasible)
            << trial << " " << solution.kkt_residual;
        EXPECT_EQ(solution.status == SolveStatus::Infeasible, !solution.infeasible_rows.empty());
        infeasible += solution.status == SolveStatus::Infeasible;
        const double scale = std::max(reference.velocity.lpNorm<Eigen::Infinity>(), 1e-3);
        EXPECT_LE((solution.velocity - reference.velocity).lpNorm<Eigen::Infinity>(), 1e-8 * scale) << trial;
        EXPECT_LE(testing::dense_kkt_residual_of_rows(owned.problem, solution), kCertified) << trial;
    }
    EXPECT_GT(infeasible, 40);
    EXPECT_LT(infeasible, 160);
}

/// Cloth on its floor, its velocity without rows, and rows near that velocity.
struct ClothWithRows {
    testing::ClothShape shape;
    OwnedProblem owned;
    VelocitySolution resting;

    explicit ClothWithRows(int side, unsigned seed = 1)
        : shape{.side = side, .seed = seed},
          owned(testing::make_resting_cloth(shape, 0.4)),
          resting(solve(owned.problem))
    {
        owned.problem.guess = testing::active_coordinates(resting);
    }

    void add(testing::RowPattern pattern, int count, unsigned seed)
    {
        for (const ConstraintRow& row :
             testing::make_rows(shape, resting.velocity, pattern, count, 0.01, seed))
            owned.problem.rows.push_back(row);
    }

    /// A row at the middle of a face that requires `speed` more than the resting cloth's velocity.
    ConstraintRow row_at(int face, double speed, double sign = 1.0) const
    {
        ConstraintRow row = testing::make_point_row(testing::grid_faces(shape.side)[face], {0.3, 0.3, 0.4},
                                                    sign * Eigen::Vector3d::UnitZ(), speed, 100000 + face);
        for (int e = 0; e < row.count; ++e)
            row.lower += row.coefficient[e] * resting.velocity[row.coordinate[e]];
        return row;
    }
};

std::vector<int> pressing(const VelocitySolution& solution)
{
    std::vector<int> rows;
    for (int k = 0; k < solution.row_multipliers.size(); ++k)
        if (solution.row_multipliers[k] > 0.0) rows.push_back(k);
    return rows;
}

void expect_same_velocity(const VelocitySolution& a, const VelocitySolution& b)
{
    // Soft modes carry round-off of about 1e3 times the precision reached.
    EXPECT_LE((a.velocity - b.velocity).lpNorm<Eigen::Infinity>(),
              1e-9 * b.velocity.lpNorm<Eigen::Infinity>());
}

TEST(ConstraintRows, TakeFewFactorisationsFromAnyGuess)
{
    std::mt19937 random(3);
    for (const testing::RowPattern pattern :
         {testing::RowPattern::Spread, testing::RowPattern::Patch, testing::RowPattern::Clusters,
          testing::RowPattern::NearlyEqual}) {
        ClothWithRows cloth(20);
        cloth.add(pattern, 140, 1);
        const VelocitySolution cold = solve(cloth.owned.problem);
        ASSERT_EQ(cold.status, SolveStatus::Certified) << cold.kkt_residual;
        ASSERT_GT(pressing(cold).size(), 5u);
        EXPECT_EQ(cold.factorisations, 1);
        EXPECT_LE(cold.kkt_residual, kAccurate);
        for (const double share : {0.0, 0.5, 1.0}) {
            cloth.owned.problem.row_guess = random_subset(140, share, random);
            cloth.owned.problem.guess = testing::spoil_guess(
                cloth.owned.problem, testing::active_coordinates(cold), 0.1 * share, random);
            const VelocitySolution warm = solve(cloth.owned.problem);
            ASSERT_EQ(warm.status, SolveStatus::Certified) << warm.kkt_residual;
            EXPECT_LE(warm.factorisations, 3);
            expect_same_velocity(warm, cold);
        }
    }
}

TEST(ConstraintRows, OfWhichManyPressTakeFewFactorisationsFromAnyGuess)
{
    // Each guess is more than there may be members, so the rows are springs in the matrix.
    std::mt19937 random(4);
    for (const testing::RowPattern pattern :
         {testing::RowPattern::Spread, testing::RowPattern::Clusters, testing::RowPattern::NearlyEqual}) {
        ClothWithRows cloth(20);
        cloth.add(pattern, 700, 1);
        cloth.owned.problem.most_work =
            kInfinity;  // a guess that is wrong for hundreds of rows takes more than a step may
        const VelocitySolution cold = solve(cloth.owned.problem);
        ASSERT_EQ(cold.status, SolveStatus::Certified) << cold.kkt_residual;
        for (const double share : {0.3, 1.0}) {
            cloth.owned.problem.row_guess = random_subset(700, share, random);
            const VelocitySolution warm = solve(cloth.owned.problem);
            ASSERT_EQ(warm.status, SolveStatus::Certified) << warm.kkt_residual;
            EXPECT_LE(warm.factorisations, 12);
            EXPECT_LE(warm.kkt_residual, kAccurate);
            expect_same_velocity(warm, cold);
            EXPECT_EQ(pressing(warm), pressing(cold));
        }
        cloth.owned.problem.guess = testing::active_coordinates(cold);
        cloth.owned.problem.row_guess = pressing(cold);
        EXPECT_LE(solve(cloth.owned.problem).factorisations, 2);
    }
}

TEST(ConstraintRows, GuessedRightAddNothing)
{
    ClothWithRows cloth(20);
    cloth.add(testing::RowPattern::Spread, 100, 2);
    const VelocitySolution cold = solve(cloth.owned.problem);
    cloth.owned.problem.guess = testing::active_coordinates(cold);
    cloth.owned.problem.row_guess = pressing(cold);
    const VelocitySolution warm = solve(cloth.owned.problem);
    EXPECT_EQ(warm.status, SolveStatus::Certified);
    EXPECT_EQ(warm.factorisations, 1);
    EXPECT_EQ(pressing(warm), pressing(cold));
    expect_same_velocity(warm, cold);
}

TEST(ConstraintRows, OfWhichTheCoefficientsAreScaledSayTheSame)
{
    std::mt19937 random(5);
    for (const bool is_feasible : {true, false}) {
        ClothWithRows cloth(10);
        cloth.add(testing::RowPattern::Spread, 40, 3);
        if (!is_feasible) {
            cloth.owned.problem.rows.push_back(cloth.row_at(40, 0.02));
            cloth.owned.problem.rows.push_back(cloth.row_at(40, 0.02, -1.0));
        }
        const VelocitySolution plain = solve(cloth.owned.problem);
        Eigen::VectorXd scales(plain.row_multipliers.size());
        for (Eigen::Index k = 0; k < scales.size(); ++k) {
            scales[k] = std::array{1e-3, 1.0, 1e3, 1e-100, 1e100}[random() % 5];
            ConstraintRow& row = cloth.owned.problem.rows[k];
            for (int e = 0; e < row.count; ++e) row.coefficient[e] *= scales[k];
            row.lower *= scales[k];
        }
        const VelocitySolution scaled = solve(cloth.owned.problem);
        EXPECT_EQ(plain.status, is_feasible ? SolveStatus::Certified : SolveStatus::Infeasible);
        EXPECT_EQ(scaled.status, plain.status);
        EXPECT_EQ(scaled.infeasible_rows, plain.infeasible_rows);
        expect_same_velocity(scaled, plain);
        EXPECT_LE((scaled.row_multipliers.cwiseProduct(scales) - plain.row_multipliers).norm(),
                  1e-8 * plain.row_multipliers.norm());
    }
}

/// Repeated rows are stiffer: they give way less than one, which gives way by less than this share.
constexpr double kCompliance = 1e-4;

TEST(ConstraintRows, RepeatedAreWorthOne)
{
    for (const bool share_a_group : {true, false})
        for (const double guessed : {0.0, 0.5, 1.0}) {
            std::mt19937 random(9);
            ClothWithRows cloth(10);
            cloth.add(testing::RowPattern::Spread, 20, 4);
            const VelocitySolution once = solve(cloth.owned.problem);
            ASSERT_GT(pressing(once).size(), 3u);
            const std::vector<ConstraintRow> rows = cloth.owned.problem.rows;
            for (int copy = 1; copy < 25; ++copy)
                for (const ConstraintRow& row : rows) {
                    cloth.owned.problem.rows.push_back(row);
                    if (!share_a_group) cloth.owned.problem.rows.back().group += 1000 * copy;
                }
            cloth.owned.problem.row_guess = random_subset(500, guessed, random);
            const VelocitySolution often = solve(cloth.owned.problem);
            ASSERT_EQ(often.status, SolveStatus::Certified) << often.kkt_residual;
            EXPECT_LE(often.factorisations, 12);
            EXPECT_LE((often.velocity - once.velocity).lpNorm<Eigen::Infinity>(),
                      kCompliance * once.velocity.lpNorm<Eigen::Infinity>());
        }
}

// Rows that press are springs of the base where they are expected, and members where they are not: two ways
// to one answer, though most rows are copies of others.
TEST(ConstraintRows, InTheBaseAndAsMembersGiveOneAnswer)
{
    int most_pressing = 0;
    for (unsigned trial = 0; trial < 200; ++trial) {
        std::mt19937 random(trial);
        ClothWithRows cloth(6 + static_cast<int>(trial % 4));
        const testing::RowPattern patterns[] = {testing::RowPattern::Spread, testing::RowPattern::Patch,
                                                testing::RowPattern::Clusters};
        cloth.add(patterns[trial % 3], 100, trial);
        std::vector<ConstraintRow>& rows = cloth.owned.problem.rows;
        for (int copy = 0; copy < 380; ++copy) rows.push_back(rows[random() % 100]);
        cloth.owned.problem.most_work = kInfinity;
        const VelocitySolution as_members = solve(cloth.owned.problem);
        cloth.owned.problem.row_guess = pressing(as_members);
        const VelocitySolution in_base = solve(cloth.owned.problem);
        ASSERT_EQ(as_members.status, SolveStatus::Certified) << trial;
        ASSERT_EQ(in_base.status, SolveStatus::Certified) << trial;
        most_pressing = std::max(most_pressing, static_cast<int>(pressing(in_base).size()));
        const double speed = as_members.velocity.lpNorm<Eigen::Infinity>();
        EXPECT_LE((in_base.velocity - as_members.velocity).lpNorm<Eigen::Infinity>(), 1e-10 * speed) << trial;
        EXPECT_LE((in_base.row_multipliers - as_members.row_multipliers).lpNorm<Eigen::Infinity>(),
                  1e-7 * as_members.row_multipliers.lpNorm<Eigen::Infinity>())
            << trial;
    }
    EXPECT_GT(most_pressing, 150);
}

TEST(ConstraintRows, ThatAreNearlyTheSameAreCertifiedInBoundedWork)
{
    for (const double difference : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
        std::mt19937 random(10);
        std::normal_distribution<double> normal;
        ClothWithRows cloth(8);
        for (int face = 0; face < 90; face += 9) {
            const ConstraintRow row = cloth.row_at(face, 0.01);
            for (int copy = 0; copy < 25; ++copy) {
                ConstraintRow other = row;
                for (int e = 0; e < row.count; ++e) other.coefficient[e] *= 1.0 + difference * normal(random);
                other.group = 25 * face + copy;
                cloth.owned.problem.row_guess.push_back(static_cast<int>(cloth.owned.problem.rows.size()));
                cloth.owned.problem.rows.push_back(other);
            }
        }
        const VelocitySolution solution = solve(cloth.owned.problem);
        EXPECT_EQ(solution.status, SolveStatus::Certified) << difference << " " << solution.kkt_residual;
        EXPECT_LE(testing::dense_kkt_residual_of_rows(cloth.owned.problem, solution), kCertified);
        EXPECT_LE(solution.factorisations, 8);
    }
}

TEST(ConstraintRows, ThatOpposeEachOtherAreNamedAndNoOthers)
{
    for (const double guessed : {0.0, 1.0}) {
        std::mt19937 random(11);
        ClothWithRows cloth(14);
        std::vector<ConstraintRow>& rows = cloth.owned.problem.rows;
        cloth.add(testing::RowPattern::Spread, 50, 5);
        for (int copy = 0; copy < 10; ++copy) rows.push_back(rows[copy]);
        const VelocitySolution feasible = solve(cloth.owned.problem);
        ASSERT_EQ(feasible.status, SolveStatus::Certified);
        for (const int face : {30, 120, 230}) {
            rows.push_back(cloth.row_at(face, 0.05));
            rows.push_back(cloth.row_at(face, 0.05, -1.0));
        }
        cloth.owned.problem.row_guess = random_subset(66, guessed, random);
        const VelocitySolution solution = solve(cloth.owned.problem);
        EXPECT_EQ(solution.status, SolveStatus::Infeasible) << solution.kkt_residual;
        EXPECT_EQ(solution.infeasible_rows, (std::vector<int>{60, 61, 62, 63, 64, 65}));
        EXPECT_LE(testing::dense_kkt_residual_of_rows(cloth.owned.problem, solution), kCertified);
    }
}

TEST(ConstraintRows, AgainstAnActiveBoundOfTheSameVertexGiveWay)
{
    ClothWithRows cloth(8);
    cloth.add(testing::RowPattern::Spread, 30, 6);
    ASSERT_FALSE(cloth.owned.problem.guess.empty());
    const int bounded = cloth.owned.problem.guess[cloth.owned.problem.guess.size() / 2];
    const double lower = cloth.owned.problem.lower[bounded];
    const ConstraintRow down = make_row({{bounded, -1.0}}, -lower + 0.01, -1),
                        exactly = make_row({{bounded, -2.0}}, -2.0 * lower, -2),
                        same = make_row({{bounded, 3.0}}, 3.0 * lower, -3);
    for (const bool is_pinned : {true, false})
        for (const bool is_guessed : {true, false}) {
            OwnedProblem owned = cloth.owned;
            if (!is_pinned) owned.problem.guess.clear();
            owned.problem.rows.push_back(exactly);
            owned.problem.rows.push_back(same);
            if (is_guessed) owned.problem.row_guess = {30, 31};
            const VelocitySolution equal = solve(owned.problem);
            EXPECT_EQ(equal.status, SolveStatus::Certified) << equal.kkt_residual;
            EXPECT_NEAR(equal.velocity[bounded], lower, kCompliance * std::abs(lower));
            owned.problem.rows.push_back(down);
            if (is_guessed) owned.problem.row_guess = {30, 31, 32};
            const VelocitySolution solution = solve(owned.problem);
            EXPECT_EQ(solution.status, SolveStatus::Infeasible) << solution.kkt_residual;
            EXPECT_EQ(solution.infeasible_rows, (std::vector<int>{32}));
            EXPECT_GE(solution.velocity[bounded], lower);
        }
}

TEST(ConstraintRows, OnPinnedCoordinatesAloneReleaseThem)
{
    // The guess pins every vertex at rest; rows lift some faces.
    ClothWithRows cloth(8);
    VelocityProblem& problem = cloth.owned.problem;
    for (int i = 0; i < problem.lower.size(); ++i) problem.lower[i] = 0.0;
    problem.guess.clear();
    for (int i = 0; i < problem.lower.size(); ++i) problem.guess.push_back(i);
    for (int k = 0; k < 20; ++k) {
        problem.rows.push_back(testing::make_point_row(testing::grid_faces(8)[4 * k], {0.2, 0.3, 0.5},
                                                       Eigen::Vector3d(0.1, 0.2, 1.0).normalized(), 0.1, k));
        if (k % 2) problem.row_guess.push_back(k);
    }
    const VelocitySolution warm = solve(problem);
    ASSERT_EQ(warm.status, SolveStatus::Certified) << warm.kkt_residual;
    EXPECT_LE(testing::dense_kkt_residual_of_rows(problem, warm), kAccurate);
    EXPECT_GE(pressing(warm).size(), 10u);
    problem.guess.clear();
    problem.row_guess.clear();
    expect_same_velocity(warm, solve(problem));
}

TEST(ConstraintRows, HoldWhatIsAtRestThoughNothingMoves)
{
    // Gravity acts on cloth at rest. Pins carry all but one vertex, and a row carries that one. All
    // velocities are zero, but the impulses are not.
    testing::ClothShape shape{.side = 9};
    const testing::ClothSystem cloth = testing::make_cloth_system(shape);
    Eigen::VectorXd fall = Eigen::VectorXd::Zero(cloth.mass.size());
    for (int i = 2; i < fall.size(); i += 3) fall[i] = -9.81 * shape.step * cloth.mass[i];
    OwnedProblem owned(cloth.matrix, fall);
    for (int i = 2; i < fall.size(); i += 3) {
        if (i == 3 * 40 + 2) continue;
        owned.problem.lower[i] = 0.0;
        owned.problem.guess.push_back(i);
    }
    owned.problem.rows = {make_row({{3 * 40 + 2, 1.0}}, 0.0)};
    for (int guess = 0; guess < 2; ++guess) {
        const VelocitySolution solution = solve(owned.problem);
        EXPECT_EQ(solution.status, SolveStatus::Certified);
        EXPECT_LE(solution.velocity.lpNorm<Eigen::Infinity>(), kCompliance * 9.81 * shape.step);
        EXPECT_NEAR(solution.row_multipliers[0], -fall[2], kCompliance * -fall[2]);
        owned.problem.row_guess = {0};
    }
}

TEST(ConstraintRows, CarryAWholeClothOnOnePoint)
{
    // The greatest multiplier that occurs, far below that of a row that cannot be met.
    testing::ClothShape shape{.side = 20};
    const testing::ClothSystem cloth = testing::make_cloth_system(shape);
    Eigen::VectorXd fall = Eigen::VectorXd::Zero(cloth.mass.size());
    for (int i = 2; i < fall.size(); i += 3) fall[i] = -9.81 * shape.step * cloth.mass[i];
    OwnedProblem owned(cloth.matrix, fall);
    owned.problem.rows = {make_row({{3 * 210 + 2, 1.0}}, 0.0)};
    const VelocitySolution solution = solve(owned.problem);
    EXPECT_EQ(solution.status, SolveStatus::Certified);
    const ConstraintRows constraints = scale_rows(owned.problem, estimate_free_speed(owned.problem));
    const double compliance = constraints.rows[0].compliance * solution.row_multipliers[0];
    EXPECT_NEAR(solution.velocity[3 * 210 + 2], -compliance, 1e-9 * compliance);
    EXPECT_LT(compliance, 0.01 * constraints.unmet_speed);
    // Told of its multiplier, the row holds exactly.
    owned.problem.rows[0].expected = solution.row_multipliers[0];
    const VelocitySolution held = solve(owned.problem);
    EXPECT_NEAR(held.velocity[3 * 210 + 2], 0.0, 1e-4 * compliance);
}

TEST(ConstraintRows, ThatCarryAStackAreMet)
{
    // Six masses upon each other fall onto a floor: the k-th row from above carries k of them.
    constexpr int kMasses = 6;
    OwnedProblem owned(testing::lower_blocks(Eigen::MatrixXd::Identity(kMasses, kMasses)),
                       Eigen::VectorXd::Constant(kMasses, -1.0));
    owned.problem.rows.push_back(make_row({{0, 1.0}}, 0.0));
    for (int k = 1; k < kMasses; ++k) owned.problem.rows.push_back(make_row({{k, 1.0}, {k - 1, -1.0}}, 0.0));
    Eigen::VectorXd carried(kMasses);
    for (int k = 0; k < kMasses; ++k) carried[k] = kMasses - k;
    EXPECT_TRUE(find_infeasible_rows(scale_rows(owned.problem, 1.0), carried).empty());
}

TEST(ConstraintRows, OfFixedCoordinatesAreMetOrImpossible)
{
    ClothWithRows cloth(6);
    VelocityProblem& problem = cloth.owned.problem;
    for (const int i : {0, 1, 2}) problem.is_fixed[i] = 1;
    const VelocitySolution none = solve(problem);
    problem.rows = {make_row({{0, 1.0}, {2, 5.0}}, -1.0),
                    make_row({{1, 1.0}}, 0.0),
                    make_row({{7, 0.0}}, 0.0),
                    make_row({}, -3.0),
                    make_row({{9, 1.0}, {9, -1.0}}, 0.0),
                    make_row({{12, 1.0}}, -kInfinity)};
    problem.row_guess = {0, 1, 2, 3, 4, 5};
    const VelocitySolution met = solve(problem);
    EXPECT_EQ(met.status, SolveStatus::Certified);
    EXPECT_EQ(met.velocity, none.velocity);
    problem.rows.push_back(make_row({{2, 1.0}}, 0.1));
    problem.rows.push_back(make_row({}, 0.1));
    problem.rows.push_back(make_row({{9, 0.1}, {9, 0.2}, {9, -0.3}}, 0.1));  // coefficients cancel
    const VelocitySolution impossible = solve(problem);
    EXPECT_EQ(impossible.status, SolveStatus::Infeasible);
    EXPECT_EQ(impossible.infeasible_rows, (std::vector<int>{6, 7, 8}));
    EXPECT_EQ(impossible.velocity, none.velocity);
    problem.is_fixed.assign(problem.is_fixed.size(), 1);
    EXPECT_EQ(solve(problem).infeasible_rows, (std::vector<int>{6, 7, 8}));
    EXPECT_EQ(solve(problem).status, SolveStatus::Infeasible);
}

/// A pushing spring of compliance G: lambda = max(0, l - g^T u) / G, whatever else is solved.
TEST(ConstraintRows, WithAGiveOfTheirOwnPressAsSprings)
{
    for (const double give : {10.0, 1e3}) {
        ClothWithRows cloth(6);
        VelocityProblem& problem = cloth.owned.problem;
        const VelocitySolution none = solve(problem);
        problem.rows = {make_row({{5, 1.0}, {8, -2.0}}, none.velocity[5] - 2.0 * none.velocity[8] + 0.5),
                        make_row({{11, 1.0}}, none.velocity[11] - 0.5)};
        for (ConstraintRow& row : problem.rows) row.compliance = give;
        const VelocitySolution solution = solve(problem);
        EXPECT_EQ(solution.status, SolveStatus::Certified);
        const double slip = problem.rows[0].lower - (solution.velocity[5] - 2.0 * solution.velocity[8]);
        EXPECT_GT(slip, 0.0);
        EXPECT_NEAR(solution.row_multipliers[0], slip / give, 1e-9 * slip / give) << give;
        EXPECT_EQ(solution.row_multipliers[1], 0.0);
        // An expected force, which only speeds the search up, changes nothing.
        problem.rows[0].expected = 3.0 * solution.row_multipliers[0];
        expect_same_velocity(solve(problem), solution);
    }
}

TEST(ConstraintRows, WithAGiveOfTheirOwnPressWhatIsHeldWithAKnownForce)
{
    ClothWithRows cloth(6);
    VelocityProblem& problem = cloth.owned.problem;
    for (const int i : {0, 1, 2}) problem.is_fixed[i] = 1;
    problem.rows = {make_row({{2, 1.0}}, 0.1), make_row({{2, -1.0}}, -0.1)};
    for (ConstraintRow& row : problem.rows) row.compliance = 4.0;
    const VelocitySolution solution = solve(problem);
    EXPECT_EQ(solution.status, SolveStatus::Certified);
    EXPECT_NEAR(solution.row_multipliers[0], 0.025, 1e-15);
    EXPECT_EQ(solution.row_multipliers[1], 0.0);
}

TEST(ConstraintRows, CountNothingWhereTheyTouchTheFixed)
{
    ClothWithRows cloth(6);
    VelocityProblem& problem = cloth.owned.problem;
    for (const int i : {0, 1, 2}) problem.is_fixed[i] = 1;
    OwnedProblem without = cloth.owned;
    problem.rows = {make_row({{0, 7.0}, {5, 0.5}, {2, -9.0}, {8, 0.5}}, 0.3)};
    without.problem.rows = {make_row({{5, 0.5}, {8, 0.5}}, 0.3)};
    const VelocitySolution solution = solve(problem);
    EXPECT_EQ(solution.status, SolveStatus::Certified);
    expect_same_velocity(solution, solve(without.problem));
    EXPECT_NEAR(0.5 * solution.velocity[5] + 0.5 * solution.velocity[8], 0.3, kCompliance * 0.3);
}

TEST(ConstraintRows, AppendedAreResumedWithoutAFactorisation)
{
    ClothWithRows cloth(24);
    VelocityProblem& problem = cloth.owned.problem;
    VelocitySolver solver;
    VelocitySolution first = solver.solve(problem, Settings());
    ASSERT_EQ(first.factorisations, 1);
    for (unsigned round = 1; round <= 4; ++round) {
        if (round != 3) cloth.add(testing::RowPattern::Spread, 40, round);  // the third round adds no row
        VelocityProblem appended = problem;  // a copy, as the last problem may be destroyed
        if (round == 4) appended.row_guess = {0, 5, 100};
        const VelocitySolution resumed = solver.resume(appended, Settings());
        const VelocitySolution scratch = solve(appended);
        ASSERT_EQ(resumed.status, SolveStatus::Certified) << resumed.kkt_residual;
        EXPECT_EQ(resumed.factorisations, 0);
        EXPECT_LE(resumed.kkt_residual, kAccurate);
        expect_same_velocity(resumed, scratch);
        EXPECT_EQ(pressing(resumed), pressing(scratch));
    }
    problem.rows.push_back(cloth.row_at(300, 0.05));
    problem.rows.push_back(cloth.row_at(300, 0.05, -1.0));
    const VelocitySolution infeasible = solver.resume(problem, Settings());
    EXPECT_EQ(infeasible.status, SolveStatus::Infeasible);
    EXPECT_EQ(infeasible.infeasible_rows, solve(problem).infeasible_rows);
    expect_same_velocity(infeasible, solve(problem));
}

TEST(ConstraintRows, AppendedInGreatNumberAreResumed)
{
    // More rows than there may be members, most of them guessed, and as many again are appended.
    std::mt19937 random(12);
    for (const int count : {300, 700, 1500}) {
        ClothWithRows cloth(20);
        VelocityProblem& problem = cloth.owned.problem;
        cloth.add(testing::RowPattern::Spread, count, 1);
        problem.row_guess = random_subset(count, 0.8, random);
        problem.most_work = kInfinity;  // so many new rows take more than a step may
        VelocitySolver solver;
        ASSERT_EQ(solver.solve(problem, Settings()).status, SolveStatus::Certified);
        cloth.add(testing::RowPattern::Clusters, count, 2);
        const VelocitySolution resumed = solver.resume(problem, Settings());
        ASSERT_EQ(resumed.status, SolveStatus::Certified) << resumed.kkt_residual;
        expect_same_velocity(resumed, solve(problem));
    }
}

TEST(ConstraintRows, AreResumedFromNothingAsSolved)
{
    ClothWithRows cloth(6);
    cloth.add(testing::RowPattern::Spread, 10, 1);
    VelocitySolver solver;
    const VelocitySolution solution = solver.resume(cloth.owned.problem, Settings());
    EXPECT_EQ(solution.status, SolveStatus::Certified);
    EXPECT_EQ(solution.velocity, solve(cloth.owned.problem).velocity);
    OwnedProblem broken = cloth.owned;
    broken.rhs[0] = kNaN;
    EXPECT_EQ(solver.solve(broken.problem, Settings()).status, SolveStatus::NotFinite);
    EXPECT_EQ(solver.resume(cloth.owned.problem, Settings()).velocity, solution.velocity);
}

TEST(ConstraintRows, GiveTheSameBitsEachTime)
{
    ClothWithRows cloth(16), other(11);
    cloth.add(testing::RowPattern::Clusters, 300, 1);
    cloth.owned.problem.rows.push_back(cloth.row_at(300, 0.05));
    cloth.owned.problem.rows.push_back(cloth.row_at(300, 0.05, -1.0));
    VelocitySolver used;
    used.solve(other.owned.problem, Settings());
    const VelocitySolution a = used.solve(cloth.owned.problem, Settings()), b = solve(cloth.owned.problem);
    EXPECT_EQ(a.velocity, b.velocity);
    EXPECT_EQ(a.multipliers, b.multipliers);
    EXPECT_EQ(a.row_multipliers, b.row_multipliers);
    EXPECT_EQ(a.infeasible_rows, b.infeasible_rows);
    EXPECT_EQ(a.nlopt_evaluations, b.nlopt_evaluations);
}

TEST(ConstraintRows, ThatAreNotFiniteAreSaidToBe)
{
    ClothWithRows cloth(5);
    for (const double bad : {kNaN, kInfinity, -kInfinity}) {
        OwnedProblem coefficient = cloth.owned, lower = cloth.owned;
        coefficient.problem.rows = {make_row({{4, 1.0}, {7, bad}}, 0.0)};
        EXPECT_EQ(solve(coefficient.problem).status, SolveStatus::NotFinite);
        lower.problem.rows = {make_row({{4, 1.0}}, bad)};
        const SolveStatus expected = bad == -kInfinity ? SolveStatus::Certified : SolveStatus::NotFinite;
        EXPECT_EQ(solve(lower.problem).status, expected);
        VelocitySolver solver;
        solver.solve(cloth.owned.problem, Settings());
        EXPECT_EQ(solver.resume(lower.problem, Settings()).status, expected);
    }
}

TEST(ConstraintRows, ThatAskForTooMuchDoNotSpoilTheRest)
{
    // Nearly all of the row's weight is on a fixed vertex; its other vertices would have to move at 1e9 m/s.
    ClothWithRows cloth(6);
    VelocityProblem& problem = cloth.owned.problem;
    problem.is_fixed[0] = problem.is_fixed[1] = problem.is_fixed[2] = 1;
    cloth.add(testing::RowPattern::Spread, 20, 2);
    problem.rows.push_back(make_row({{2, 1.0}, {40, 1e-10}}, 0.1, -1));
    const VelocitySolution solution = solve(problem);
    EXPECT_EQ(solution.status, SolveStatus::Infeasible) << solution.kkt_residual;
    EXPECT_EQ(solution.infeasible_rows, (std::vector<int>{20}));
    EXPECT_LE(solution.kkt_residual, kCertified);
    EXPECT_LE(solution.velocity.lpNorm<Eigen::Infinity>(),
              1e2 * cloth.resting.velocity.lpNorm<Eigen::Infinity>());
}

TEST(ConstraintRows, FindTheFreeSpeedWithinAnOrderOfMagnitude)
{
    for (const double stretch : {1e2, 1e4, 1e6})
        for (const double unit : {1e-100, 1.0, 1e100}) {
            testing::ClothShape shape{.side = 12, .stretch = stretch};
            const testing::ClothSystem cloth = testing::make_cloth_system(shape);
            OwnedProblem owned(cloth.matrix * unit, 0.3 * unit * cloth.mass);
            const double speed =
                solve(owned.problem).velocity.lpNorm<Eigen::Infinity>();  // unconstrained solution
            EXPECT_GE(estimate_free_speed(owned.problem), 0.1 * speed);
            EXPECT_LE(estimate_free_speed(owned.problem), 10.0 * speed);
        }
    OwnedProblem still(testing::make_cloth_system({.side = 4}).matrix, Eigen::VectorXd::Zero(48));
    EXPECT_EQ(estimate_free_speed(still.problem), 0.0);
}

}  // namespace
}  // namespace arris
