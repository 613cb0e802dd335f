// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/velocity_solve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/solver/cloth_system.h"
#include "tests/solver/dense_reference.h"

namespace arris {
namespace {

using testing::OwnedProblem;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kCertified = 1e-9;  // Settings::tolerance
constexpr double kAccurate = 1e-12;  // residual down to which the solver refines

VelocitySolution solve(const VelocityProblem& problem)
{
    return VelocitySolver().solve(problem, Settings());
}

/// Matrix G G^T / size + 0.1: well conditioned, every entry stored.
OwnedProblem make_random_problem(int vertices, std::mt19937& random)
{
    std::normal_distribution<double> normal;
    const int size = 3 * vertices;
    const Eigen::MatrixXd g = Eigen::MatrixXd::NullaryExpr(size, size, [&] { return normal(random); });
    const Eigen::MatrixXd a = g * g.transpose() / size + 0.1 * Eigen::MatrixXd::Identity(size, size);
    OwnedProblem owned(testing::lower_blocks(a),
                       Eigen::VectorXd::NullaryExpr(size, [&] { return normal(random); }));
    std::uniform_real_distribution<double> chance;
    const double bounded = chance(random), fixed = 0.3 * chance(random);
    for (int i = 0; i < size; ++i) {
        if (chance(random) < bounded) owned.problem.lower[i] = 0.5 * normal(random);
        owned.problem.is_fixed[i] = chance(random) < fixed;
    }
    return owned;
}

enum class Guess { Cold, Warm, Nearly, Random, Opposite };

std::vector<int> make_guess(Guess kind, const Eigen::VectorXd& multipliers, std::mt19937& random)
{
    std::vector<int> guess;
    std::uniform_real_distribution<double> chance;
    for (int i = 0; i < multipliers.size(); ++i) {
        bool is_in = kind != Guess::Cold && multipliers[i] > 0.0;
        if (kind == Guess::Nearly && chance(random) < 0.1) is_in = !is_in;
        if (kind == Guess::Random) is_in = chance(random) < 0.5;
        if (kind == Guess::Opposite) is_in = !is_in;
        if (is_in) guess.push_back(i);  // also coordinates without a bound and fixed ones: to be ignored
    }
    return guess;
}

TEST(VelocitySolve, EqualsADenseReferenceFromAnyGuess)
{
    std::mt19937 random(7);
    for (int trial = 0; trial < 600; ++trial) {
        OwnedProblem owned = make_random_problem(1 + trial % 12, random);
        const testing::DenseAnswer reference = testing::solve_densely(owned.problem);
        const double scale = std::max(reference.velocity.lpNorm<Eigen::Infinity>(), 1e-3);
        for (const Guess kind : {Guess::Cold, Guess::Warm, Guess::Nearly, Guess::Random, Guess::Opposite}) {
            owned.problem.guess = make_guess(kind, reference.multipliers, random);
            const VelocitySolution solution = solve(owned.problem);
            ASSERT_EQ(solution.status, SolveStatus::Certified) << trial;
            ASSERT_LE(testing::dense_kkt_residual(owned.problem, solution), kAccurate) << trial;
            // The condition number is below 1e2, the precision 1e-12.
            ASSERT_LE((solution.velocity - reference.velocity).lpNorm<Eigen::Infinity>(), 1e-10 * scale)
                << trial;
            ASSERT_LE((solution.multipliers - reference.multipliers).lpNorm<Eigen::Infinity>(), 1e-9 * scale)
                << trial;
        }
    }
}

struct Family {
    const char* name;
    testing::ClothShape shape;
    double congruence;  ///< greatest factor by which coordinates are scaled
};

/// Families of problems on which plain primal-dual active sets cycle.
std::vector<Family> cycling_families(int side)
{
    testing::ClothShape soft, stiff, bending, slivers;
    soft.side = stiff.side = bending.side = slivers.side = side;
    stiff.stretch = 1e6;
    bending.bending = 1.0;
    slivers.aspect = 1e3;
    std::vector<Family> families;
    for (const double congruence : {1.0, 1e2, 1e4}) {
        families.push_back({"soft", soft, congruence});
        families.push_back({"stiff", stiff, congruence});
        families.push_back({"bending", bending, congruence});
        families.push_back({"slivers", slivers, congruence});
    }
    return families;
}

/// Matrix T A T with random diagonal T, random b, and one to three bounds on each of some vertices.
OwnedProblem make_hard_problem(const Family& family, unsigned seed)
{
    testing::ClothShape shape = family.shape;
    shape.seed = seed;
    Eigen::SparseMatrix<double> a = testing::make_cloth_system(shape).matrix;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> chance;
    std::normal_distribution<double> normal;
    const Eigen::VectorXd t = Eigen::VectorXd::NullaryExpr(
        a.rows(), [&] { return std::pow(family.congruence, chance(random) - 0.5); });
    a = t.asDiagonal() * a * t.asDiagonal();
    const Eigen::VectorXd root = Eigen::VectorXd(a.diagonal()).cwiseSqrt();
    OwnedProblem owned(
        a, root.cwiseProduct(Eigen::VectorXd::NullaryExpr(a.rows(), [&] { return normal(random); })));
    const double share = 0.05 + 0.6 * chance(random);
    for (int vertex = 0; vertex < a.rows() / 3; ++vertex) {
        if (chance(random) > share) continue;
        const int bounds = 1 + static_cast<int>(3 * chance(random));
        for (int k = 0; k < bounds; ++k)
            owned.problem.lower[3 * vertex + k] = -0.1 * std::abs(normal(random)) / root[3 * vertex + k];
    }
    return owned;
}

TEST(VelocitySolve, EqualsADenseReferenceOnMatricesThatMakeActiveSetsCycle)
{
    for (const Family& family : cycling_families(4))
        for (unsigned seed = 1; seed <= 20; ++seed) {
            OwnedProblem owned = make_hard_problem(family, seed);
            const testing::DenseAnswer reference = testing::solve_densely(owned.problem);
            const VelocitySolution solution = solve(owned.problem);
            ASSERT_EQ(solution.status, SolveStatus::Certified) << family.name << seed;
            // Soft modes are compared in the energy norm |u - v|_A.
            const Eigen::MatrixXd a = testing::dense_symmetric(owned.matrix);
            const Eigen::VectorXd error = solution.velocity - reference.velocity;
            const double energy = reference.velocity.dot(a * reference.velocity);
            EXPECT_LE(error.dot(a * error), 1e-16 * energy)
                << family.name << " " << family.congruence << " " << seed;
        }
}

TEST(VelocitySolve, NeverCyclesWhereActiveSetsDo)
{
    std::mt19937 random(3);
    int factorisations = 0, trials = 0;
    double worst = 0.0;
    for (const Family& family : cycling_families(14))
        for (unsigned seed = 1; seed <= 20; ++seed) {
            OwnedProblem owned = make_hard_problem(family, seed);
            const VelocitySolution cold = solve(owned.problem);
            ASSERT_EQ(cold.status, SolveStatus::Certified) << family.name << seed << " " << cold.kkt_residual;
            owned.problem.guess =
                testing::spoil_guess(owned.problem, testing::active_coordinates(cold), 0.2, random);
            const VelocitySolution warm = solve(owned.problem);
            ASSERT_EQ(warm.status, SolveStatus::Certified) << family.name << seed << " " << warm.kkt_residual;
            factorisations += cold.factorisations + warm.factorisations;
            worst = std::max({worst, cold.kkt_residual, warm.kkt_residual});
            trials += 2;
        }
    EXPECT_LE(worst, kAccurate);
    EXPECT_LE(factorisations, 2 * trials);
}

/// From a cold start more bounds change than there may be members, so there are further bases.
TEST(VelocitySolve, FindsTheSameAnswerColdWarmAndFromNonsense)
{
    testing::ClothShape shape;
    shape.side = 45;
    OwnedProblem owned = testing::make_resting_cloth(shape, 0.6);
    const VelocitySolution cold = solve(owned.problem);
    ASSERT_EQ(cold.status, SolveStatus::Certified);
    ASSERT_GT(cold.factorisations, 1);
    const std::vector<int> active = testing::active_coordinates(cold);
    ASSERT_GT(active.size(), 500u);
    std::mt19937 random(5);
    for (const double wrong : {0.0, 0.02, 0.3, 1.0}) {
        owned.problem.guess = testing::spoil_guess(owned.problem, active, wrong, random);
        const VelocitySolution warm = solve(owned.problem);
        ASSERT_EQ(warm.status, SolveStatus::Certified) << wrong;
        EXPECT_LE(warm.kkt_residual, kAccurate);
        EXPECT_EQ(testing::active_coordinates(warm), active);
        EXPECT_LE((warm.velocity - cold.velocity).lpNorm<Eigen::Infinity>(),
                  1e-9 * cold.velocity.lpNorm<Eigen::Infinity>());
    }
}

TEST(VelocitySolve, TakesOneFactorisationAndNoNLoptWhereNothingChanges)
{
    testing::ClothShape shape;
    shape.side = 20;
    OwnedProblem owned = testing::make_resting_cloth(shape, 0.3);
    owned.problem.guess = testing::active_coordinates(solve(owned.problem));
    ASSERT_GT(owned.problem.guess.size(), 50u);
    OwnedProblem unbounded = owned;
    unbounded.problem.guess.clear();
    unbounded.problem.lower.setConstant(-kInfinity);
    for (const VelocityProblem& problem : {owned.problem, unbounded.problem}) {
        const VelocitySolution solution = solve(problem);
        EXPECT_EQ(solution.status, SolveStatus::Certified);
        EXPECT_EQ(solution.factorisations, 1);
        EXPECT_EQ(solution.nlopt_evaluations, 0);
        EXPECT_LE(solution.kkt_residual, kAccurate);
    }
}

TEST(VelocitySolve, IsNothingForNoVertices)
{
    const OwnedProblem owned(Eigen::SparseMatrix<double>(0, 0), Eigen::VectorXd(0));
    const VelocitySolution solution = solve(owned.problem);
    EXPECT_EQ(solution.status, SolveStatus::Certified);
    EXPECT_EQ(solution.velocity.size(), 0);
    EXPECT_EQ(solution.factorisations, 0);
}

TEST(VelocitySolve, LeavesTheFixedAtRestWhateverTheirBound)
{
    std::mt19937 random(11);
    OwnedProblem owned = make_random_problem(5, random);
    owned.problem.lower.setConstant(2.0);
    owned.problem.lower[4] = kInfinity;
    owned.problem.lower[7] = std::numeric_limits<double>::quiet_NaN();
    owned.problem.guess = {0, 4, 7};
    owned.problem.is_fixed.assign(15, 1);
    const VelocitySolution all = solve(owned.problem);
    EXPECT_EQ(all.status, SolveStatus::Certified);
    EXPECT_EQ(all.velocity, Eigen::VectorXd(Eigen::VectorXd::Zero(15)));

    owned.problem.is_fixed.assign(15, 0);
    owned.problem.is_fixed[0] = owned.problem.is_fixed[4] = owned.problem.is_fixed[7] = 1;
    const VelocitySolution some = solve(owned.problem);
    EXPECT_EQ(some.status, SolveStatus::Certified);
    for (const int i : {0, 4, 7}) {
        EXPECT_EQ(some.velocity[i], 0.0);
        EXPECT_EQ(some.multipliers[i], 0.0);
    }
    EXPECT_GT(some.velocity.minCoeff(), -1e-12);
}

TEST(VelocitySolve, PushesWhereTheBoundIsAboveRest)
{
    // An obstacle rises through resting cloth: b = 0, and every bound is active.
    testing::ClothShape shape;
    shape.side = 8;
    OwnedProblem owned = testing::make_resting_cloth(shape, 0.5);
    owned.rhs.setZero();
    owned.problem.lower.setConstant(-kInfinity);
    for (int i = 2; i < owned.rhs.size(); i += 3) owned.problem.lower[i] = 0.7;
    const VelocitySolution cold = solve(owned.problem);
    for (int i = 2; i < owned.rhs.size(); i += 3) owned.problem.guess.push_back(i);
    const VelocitySolution warm = solve(owned.problem);
    for (const VelocitySolution& solution : {cold, warm}) {
        ASSERT_EQ(solution.status, SolveStatus::Certified);
        EXPECT_LE(testing::dense_kkt_residual(owned.problem, solution), kAccurate);
        for (int i = 2; i < owned.rhs.size(); i += 3) EXPECT_NEAR(solution.velocity[i], 0.7, 1e-12);
    }
}

TEST(VelocitySolve, LivesWithMultipliersThatAreExactlyZero)
{
    // b = A u with u on its bounds: whether a bound is active makes no difference.
    std::mt19937 random(13);
    for (int trial = 0; trial < 100; ++trial) {
        OwnedProblem owned = make_random_problem(4, random);
        owned.problem.is_fixed.assign(12, 0);
        const Eigen::VectorXd planted = Eigen::VectorXd::LinSpaced(12, -1.0, 2.0);
        owned.rhs = testing::dense_symmetric(owned.matrix) * planted;
        owned.problem.lower = planted;
        for (int i = 0; i < 12; ++i)
            if (random() % 3 == 0) owned.problem.guess.push_back(i);
        const VelocitySolution solution = solve(owned.problem);
        ASSERT_EQ(solution.status, SolveStatus::Certified);
        EXPECT_LE((solution.velocity - planted).lpNorm<Eigen::Infinity>(), 1e-11);
        EXPECT_LE(solution.multipliers.lpNorm<Eigen::Infinity>(), 1e-11);
    }
}

TEST(VelocitySolve, FindsMultipliersFarSmallerThanTheForcesTheyComeFrom)
{
    std::mt19937 random(17);
    for (int trial = 0; trial < 50; ++trial) {
        OwnedProblem owned = make_random_problem(6, random);
        owned.problem.is_fixed.assign(18, 0);
        owned.problem.lower.setConstant(-kInfinity);
        const Eigen::VectorXd planted = Eigen::VectorXd::LinSpaced(18, -1.0, 2.0);
        Eigen::VectorXd multipliers = Eigen::VectorXd::Zero(18);
        for (int k = 0; k < 6; ++k) {
            multipliers[3 * k] = std::pow(10.0, -7 - k);  // 1e-7 .. 1e-12
            owned.problem.lower[3 * k] = planted[3 * k];
        }
        owned.rhs = testing::dense_symmetric(owned.matrix) * planted - multipliers;
        const VelocitySolution solution = solve(owned.problem);
        ASSERT_EQ(solution.status, SolveStatus::Certified);
        // Accumulated round-off of |A||u| + |b|, about 20.
        EXPECT_LE((solution.multipliers - multipliers).lpNorm<Eigen::Infinity>(), 5e-14);
    }
}

TEST(VelocitySolve, UnitsChangeNothing)
{
    std::mt19937 random(19);
    for (const double stiffness : {1e-100, 1e-12, 1.0, 1e12, 1e100})
        for (const double force : {1e-100, 1e-12, 1.0, 1e12, 1e100}) {
            const OwnedProblem plain = make_random_problem(8, random);
            OwnedProblem scaled = plain;
            scaled.matrix *= stiffness;
            scaled.rhs *= force;
            scaled.problem.lower *= force / stiffness;
            const VelocitySolution expected = solve(plain.problem), solution = solve(scaled.problem);
            ASSERT_EQ(solution.status, SolveStatus::Certified) << stiffness << " " << force;
            EXPECT_EQ(testing::active_coordinates(solution), testing::active_coordinates(expected));
            EXPECT_LE((solution.velocity * (stiffness / force) - expected.velocity).lpNorm<Eigen::Infinity>(),
                      1e-11);
        }
}

TEST(VelocitySolve, IsCertifiedOnNearlyDependentBounds)
{
    // Neighbours are coupled so stiffly that their bounds agree to eight digits.
    std::mt19937 random(23);
    testing::ClothShape shape;
    shape.side = 6;
    shape.stretch = 1e8;
    for (unsigned seed = 1; seed <= 20; ++seed) {
        shape.seed = seed;
        OwnedProblem owned = testing::make_resting_cloth(shape, 0.5);
        std::normal_distribution<double> normal;
        for (int i = 0; i < owned.rhs.size(); ++i)
            if (random() % 2) owned.problem.lower[i] = 0.01 * normal(random);
        const VelocitySolution solution = solve(owned.problem);
        ASSERT_EQ(solution.status, SolveStatus::Certified) << seed;
        EXPECT_LE(testing::dense_kkt_residual(owned.problem, solution), kCertified);
    }
}

TEST(VelocitySolve, SaysNotFiniteForWhatIsNot)
{
    std::mt19937 random(29);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const OwnedProblem good = make_random_problem(4, random);
    for (const double bad : {nan, kInfinity, -kInfinity}) {
        OwnedProblem matrix = good, rhs = good, lower = good;
        matrix.matrix.coeffRef(7, 2) = bad;
        EXPECT_EQ(solve(matrix.problem).status, SolveStatus::NotFinite);
        rhs.rhs[5] = bad;
        EXPECT_EQ(solve(rhs.problem).status, SolveStatus::NotFinite);
        lower.problem.is_fixed.assign(12, 0);
        lower.problem.lower[5] = bad;
        const SolveStatus expected = bad == -kInfinity ? SolveStatus::Certified : SolveStatus::NotFinite;
        EXPECT_EQ(solve(lower.problem).status, expected);
    }
}

TEST(VelocitySolve, SaysNotFiniteWhereNumbersOverflow)
{
    std::mt19937 random(29);
    OwnedProblem owned = make_random_problem(4, random);
    owned.problem.is_fixed.assign(12, 0);
    owned.matrix *= 1e-200;
    owned.rhs *= 1e200;
    EXPECT_EQ(solve(owned.problem).status, SolveStatus::NotFinite);
}

TEST(VelocitySolve, SaysNotConvergedForAnIndefiniteMatrix)
{
    std::mt19937 random(31);
    OwnedProblem owned = make_random_problem(4, random);
    owned.problem.is_fixed.assign(12, 0);
    owned.problem.lower.setConstant(-kInfinity);
    owned.set_matrix(-owned.matrix);
    EXPECT_EQ(solve(owned.problem).status, SolveStatus::NotConverged);
}

TEST(VelocitySolve, ReturnsFromAnIndefiniteMatrixHiddenByPins)
{
    // With all coordinates pinned the factor is diagonal; only released coordinates show an error.
    std::mt19937 random(37);
    for (int trial = 0; trial < 100; ++trial) {
        OwnedProblem owned = make_random_problem(5, random);
        Eigen::MatrixXd a = testing::dense_symmetric(owned.matrix);
        a.diagonal().array() -= 0.4;
        owned.set_matrix(testing::lower_blocks(a));
        for (int i = 0; i < 15; ++i) owned.problem.guess.push_back(i);
        const VelocitySolution solution = solve(owned.problem);
        if (solution.status == SolveStatus::Certified)
            EXPECT_LE(testing::dense_kkt_residual(owned.problem, solution), kCertified);
        else
            EXPECT_EQ(solution.status, SolveStatus::NotConverged);
    }
}

TEST(VelocitySolve, SaysNotConvergedWhereTheToleranceIsOutOfReach)
{
    std::mt19937 random(41);
    const OwnedProblem owned = make_random_problem(10, random);
    Settings settings;
    settings.tolerance = 1e-30;
    const VelocitySolution solution = VelocitySolver().solve(owned.problem, settings);
    EXPECT_EQ(solution.status, SolveStatus::NotConverged);
    EXPECT_LE(solution.kkt_residual, kAccurate);
}

void expect_identical(const VelocitySolution& a, const VelocitySolution& b)
{
    EXPECT_EQ(a.status, b.status);
    EXPECT_EQ(a.velocity, b.velocity);
    EXPECT_EQ(a.multipliers, b.multipliers);
    EXPECT_EQ(a.factorisations, b.factorisations);
    EXPECT_EQ(a.nlopt_evaluations, b.nlopt_evaluations);
}

TEST(VelocitySolve, IsBitIdenticalWhateverWasSolvedBefore)
{
    std::mt19937 random(43);
    testing::ClothShape shape;
    VelocitySolver used;
    for (int trial = 0; trial < 40; ++trial) {
        shape.side = 3 + static_cast<int>(random() % 12);  // the pattern may change
        shape.seed = static_cast<unsigned>(trial);
        OwnedProblem owned = testing::make_resting_cloth(shape, 0.5);
        if (trial % 5 == 4) owned.rhs[0] = std::numeric_limits<double>::quiet_NaN();
        if (trial % 7 == 6) owned.matrix *= -1.0;
        if (trial % 2) owned.problem.guess = {2, 5, 8};
        const VelocitySolution solution = used.solve(owned.problem, Settings());
        expect_identical(solution, solve(owned.problem));
    }
}

TEST(VelocitySolve, SeesAPatternOfTheSameSizeThatChanged)
{
    Eigen::MatrixXd a = 2.0 * Eigen::MatrixXd::Identity(12, 12), b = a;
    a(3, 0) = 1.0;  // equally many blocks in each column: only their rows differ
    b(6, 0) = 1.0;
    VelocitySolver used;
    for (const Eigen::MatrixXd& dense : {a, b, a}) {
        const OwnedProblem owned(testing::lower_blocks(dense), Eigen::VectorXd::Ones(12));
        const VelocitySolution solution = used.solve(owned.problem, Settings());
        EXPECT_EQ(solution.status, SolveStatus::Certified);
        EXPECT_LE((testing::dense_symmetric(owned.matrix) * solution.velocity - owned.rhs)
                      .lpNorm<Eigen::Infinity>(),
                  1e-14);
        expect_identical(solution, solve(owned.problem));
    }
}

}  // namespace
}  // namespace arris
