// SPDX-License-Identifier: GPL-3.0-or-later
//
// Cost of the constrained velocity solve, on a cloth resting on a wavy floor with 20-30 % of its vertices in
// contact. `ratio` is the least time of a solve over the least time of one numeric factorisation of its
// matrix. All times are CPU seconds of this thread. The first argument is the number of vertices along one
// side.
//   warm         guess from a slightly different step (second argument: difference of speeds, mm/s); `wrong`
//                counts the guess's errors
//   spoilt       guess of which so many per mille (second argument) are replaced at random by false pins
//   cold         no guess
//   rows         so many rows (second argument) on top of guessed bounds: spread over the cloth, in a patch,
//                in clusters (40 faces of many points), or nearly equal
//     *_cold     without a guess of the rows
//     *_warm     the pressing rows are guessed from a solve with a slightly different b
//     *_resume   the rows are appended to a problem that has just been solved
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <random>

#include "bench/thread_clock.h"
#include "solver/velocity_solve/factorization.h"
#include "tests/solver/cloth_system.h"
#include "tests/solver/row_problems.h"

namespace arris {
namespace {

/// Runs `work` for each iteration of `state`; returns the least time.
template <class Work>
double measure(benchmark::State& state, Work work)
{
    double least = std::numeric_limits<double>::infinity();
    for (auto _ : state) {
        const double start = thread_seconds();
        work();
        const double seconds = thread_seconds() - start;
        least = std::min(least, seconds);
        state.SetIterationTime(seconds);
    }
    return least;
}

struct RestingCloth {
    testing::OwnedProblem owned;
    std::vector<int> active;
    double factorisation;  ///< s
};

double time_factorisation(const testing::OwnedProblem& owned)
{
    Factorization factorization;
    factorization.analyse(owned.matrix);
    double least = std::numeric_limits<double>::infinity();
    for (int run = 0; run < 5; ++run) {
        const double start = thread_seconds();
        benchmark::DoNotOptimize(factorization.factorise(owned.matrix, owned.problem.is_fixed));
        least = std::min(least, thread_seconds() - start);
    }
    return least;
}

const RestingCloth& resting_cloth(int side)
{
    static std::map<int, RestingCloth> made;
    const auto found = made.find(side);
    if (found != made.end()) return found->second;
    testing::ClothShape shape;
    shape.side = side;
    RestingCloth cloth = {testing::make_resting_cloth(shape, 0.3), {}, 0.0};
    cloth.active = testing::active_coordinates(VelocitySolver().solve(cloth.owned.problem, Settings()));
    cloth.factorisation = time_factorisation(cloth.owned);
    return made.emplace(side, std::move(cloth)).first->second;
}

void solve(benchmark::State& state, const RestingCloth& cloth, const std::vector<int>& guess)
{
    testing::OwnedProblem owned = cloth.owned;
    owned.problem.guess = guess;
    VelocitySolver solver;
    VelocitySolution solution = solver.solve(owned.problem, Settings());  // analyses the pattern
    const double least = measure(state, [&] { solution = solver.solve(owned.problem, Settings()); });
    if (solution.status != SolveStatus::Certified) state.SkipWithError("not certified");

    std::vector<int> wrong;
    std::set_symmetric_difference(guess.begin(), guess.end(), cloth.active.begin(), cloth.active.end(),
                                  std::back_inserter(wrong));
    state.counters["ratio"] = least / cloth.factorisation;
    state.counters["active"] = static_cast<double>(cloth.active.size());
    state.counters["wrong"] = static_cast<double>(wrong.size());
    state.counters["factorisations"] = solution.factorisations;
    state.counters["nlopt_evaluations"] = solution.nlopt_evaluations;
    state.counters["kkt_residual"] = solution.kkt_residual;
}

/// Active set of the cloth with smooth ripples of `speed` (m/s) added to its motion.
std::vector<int> guess_of_another_step(const RestingCloth& cloth, int side, double speed)
{
    testing::OwnedProblem other = cloth.owned;
    const double mass = testing::ClothShape().density / ((side - 1.0) * (side - 1.0));
    for (int vertex = 0; vertex < side * side; ++vertex) {
        const double x = vertex % side / (side - 1.0), y = vertex / side / (side - 1.0);
        other.rhs[3 * vertex + 2] += speed * mass * std::sin(25 * x + 3 * y) * std::sin(20 * y);
    }
    other.problem.guess = cloth.active;
    return testing::active_coordinates(VelocitySolver().solve(other.problem, Settings()));
}

void warm(benchmark::State& state)
{
    const int side = static_cast<int>(state.range(0));
    const RestingCloth& cloth = resting_cloth(side);
    solve(state, cloth, guess_of_another_step(cloth, side, 1e-3 * static_cast<double>(state.range(1))));
}

void spoilt(benchmark::State& state)
{
    const RestingCloth& cloth = resting_cloth(static_cast<int>(state.range(0)));
    std::mt19937 random(1);
    const double share = 1e-3 * static_cast<double>(state.range(1));
    solve(state, cloth, testing::spoil_guess(cloth.owned.problem, cloth.active, share, random));
}

void cold(benchmark::State& state)
{
    solve(state, resting_cloth(static_cast<int>(state.range(0))), {});
}

enum class Rows { Cold, Warm, Resume };

std::vector<int> positions_of_positive(const Eigen::VectorXd& multipliers)
{
    std::vector<int> positions;
    for (int k = 0; k < multipliers.size(); ++k)
        if (multipliers[k] > 0.0) positions.push_back(k);
    return positions;
}

/// Guesses bounds and rows from a step that differs by smooth ripples of 1 mm/s.
void guess_rows(testing::OwnedProblem& owned, int side)
{
    const Eigen::VectorXd rhs = owned.rhs;
    const double mass = testing::ClothShape().density / ((side - 1.0) * (side - 1.0));
    for (int i = 2; i < rhs.size(); i += 3) owned.rhs[i] += 1e-3 * mass * std::sin(0.9 * (i % (3 * side)));
    const VelocitySolution other = VelocitySolver().solve(owned.problem, Settings());
    owned.problem.guess = testing::active_coordinates(other);
    owned.problem.row_guess = positions_of_positive(other.row_multipliers);
    owned.rhs = rhs;
}

void rows(benchmark::State& state, testing::RowPattern pattern, Rows kind)
{
    const int side = static_cast<int>(state.range(0));
    const RestingCloth& cloth = resting_cloth(side);
    testing::OwnedProblem owned = cloth.owned;
    owned.problem.guess = cloth.active;
    VelocitySolver solver;
    VelocitySolution solution = solver.solve(owned.problem, Settings());
    const std::vector<ConstraintRow> made =
        testing::make_rows(testing::ClothShape{.side = side}, solution.velocity, pattern,
                           static_cast<int>(state.range(1)), 0.01, 1);
    VelocityProblem bounds_only = owned.problem;
    owned.problem.rows = made;
    if (kind == Rows::Warm) guess_rows(owned, side);
    double least = std::numeric_limits<double>::infinity();
    for (auto _ : state) {
        if (kind == Rows::Resume) solver.solve(bounds_only, Settings());
        const double start = thread_seconds();
        solution = kind == Rows::Resume ? solver.resume(owned.problem, Settings())
                                        : solver.solve(owned.problem, Settings());
        least = std::min(least, thread_seconds() - start);
        state.SetIterationTime(thread_seconds() - start);
    }
    if (solution.status != SolveStatus::Certified) state.SkipWithError("not certified");
    state.counters["ratio"] = least / cloth.factorisation;
    state.counters["pressing"] = static_cast<double>(positions_of_positive(solution.row_multipliers).size());
    state.counters["factorisations"] = solution.factorisations;
    state.counters["nlopt_evaluations"] = solution.nlopt_evaluations;
    state.counters["kkt_residual"] = solution.kkt_residual;
}

const std::vector<std::int64_t> kSides = {32, 100, 224};  // about 1, 10 and 50 thousand vertices

void of_every_size(benchmark::internal::Benchmark* benchmark)
{
    benchmark->ArgsProduct({kSides})->UseManualTime()->Unit(benchmark::kMillisecond);
}

BENCHMARK(warm)->ArgsProduct({kSides, {0, 1, 3, 10}})->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(spoilt)->ArgsProduct({kSides, {5, 20, 50}})->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(cold)->Apply(of_every_size);

void of_every_count(benchmark::internal::Benchmark* benchmark)
{
    benchmark->ArgsProduct({{32, 100}, {10, 100, 300, 1000}})->UseManualTime()->Unit(benchmark::kMillisecond);
}

void of_a_thousand(benchmark::internal::Benchmark* benchmark)
{
    benchmark->ArgsProduct({{32, 100}, {1000}})->UseManualTime()->Unit(benchmark::kMillisecond);
}

BENCHMARK_CAPTURE(rows, spread_cold, testing::RowPattern::Spread, Rows::Cold)->Apply(of_every_count);
BENCHMARK_CAPTURE(rows, spread_warm, testing::RowPattern::Spread, Rows::Warm)->Apply(of_every_count);
BENCHMARK_CAPTURE(rows, spread_resume, testing::RowPattern::Spread, Rows::Resume)->Apply(of_every_count);
BENCHMARK_CAPTURE(rows, patch_cold, testing::RowPattern::Patch, Rows::Cold)->Apply(of_every_count);
BENCHMARK_CAPTURE(rows, patch_warm, testing::RowPattern::Patch, Rows::Warm)->Apply(of_every_count);
BENCHMARK_CAPTURE(rows, clusters_cold, testing::RowPattern::Clusters, Rows::Cold)->Apply(of_a_thousand);
BENCHMARK_CAPTURE(rows, clusters_warm, testing::RowPattern::Clusters, Rows::Warm)->Apply(of_a_thousand);
BENCHMARK_CAPTURE(rows, equal_cold, testing::RowPattern::NearlyEqual, Rows::Cold)->Apply(of_a_thousand);
BENCHMARK_CAPTURE(rows, equal_warm, testing::RowPattern::NearlyEqual, Rows::Warm)->Apply(of_a_thousand);

}  // namespace
}  // namespace arris

BENCHMARK_MAIN();
