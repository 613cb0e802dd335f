// SPDX-License-Identifier: GPL-3.0-or-later
//
// Cost of a step, of its assembly and of its velocity solve, for a cloth over a floor. `ratio` is the least
// time of the runs over the least time of one numeric factorisation of the step's matrix. All times are CPU
// seconds of one thread. Arguments: the number of vertices along one side, and whether the cloth is falling
// (hundreds of new contacts a step) or draped (few).
#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <map>

#include "bench/thread_clock.h"
#include "geometry/cloth_input/cloth_grid.h"
#include "solver/step.h"
#include "solver/velocity_solve/factorization.h"
#include "tests/solver/floor.h"

namespace arris {
namespace {

constexpr double kStep = 0.005;  // s

struct Drop {
    Scene scene;
    Settings settings;
    State state;
    Workspace work;
    double factorisation = 0.0;  ///< s, CPU

    void advance() { step(scene, settings, state.time + kStep, state, work); }
};

double time_factorisation(const VelocityProblem& problem)
{
    Factorization factorization;
    factorization.analyse(*problem.matrix, problem.places);
    double least = std::numeric_limits<double>::infinity();
    for (int run = 0; run < 4; ++run) {
        const double start = thread_seconds();
        benchmark::DoNotOptimize(factorization.factorise(*problem.matrix, problem.is_fixed));
        least = std::min(least, thread_seconds() - start);
    }
    return least;
}

enum Kind { Draped, Falling };

ClothMesh make_sheet(int side)
{
    ClothGrid grid;
    grid.resolution = {side - 1, side - 1};
    grid.pattern = GridPattern::Alternating;
    return make_cloth_grid(grid);
}

/// Draped: held along one edge 0.3 m above the floor, while most of the cloth lies on the floor. A few
/// contacts change each step.
void drape(int side, Drop& drop)
{
    drop.scene.pins = {Pin{{Vec2(0, 0), Vec2(0, 1)}, {}, {true, true, true}, 0.0, 1e9}};
    ClothMesh mesh = make_sheet(side);
    for (Vec3& x : mesh.world)
        x = x.x() < 0.4 ? Vec3(0.8 * x.x(), x.y(), 0.3 - 0.6 * x.x()) : Vec3(x.x() - 0.08, x.y(), 0.06);
    drop.state = make_state(drop.scene, mesh, Vec3::Zero());
    drop.settings.integrator = Integrator::ImplicitEuler;  // long steps that damp
    for (int k = 0; k < 40; ++k)
        step(drop.scene, drop.settings, drop.state.time + 4 * kStep, drop.state, drop.work);
    drop.settings.integrator = Integrator::Bdf2;
    for (int k = 0; k < 5; ++k) drop.advance();
}

/// Falling: a rippled sheet falls flat, and each step closes hundreds of contacts.
void let_fall(int side, Drop& drop)
{
    ClothMesh mesh = make_sheet(side);
    for (Vec3& x : mesh.world) x.z() = 0.06 + 0.05 * std::sin(9.0 * x.x()) * std::cos(7.0 * x.y() + 1.0);
    drop.state = make_state(drop.scene, mesh, Vec3::Zero());
    for (int k = 0; k < 40; ++k) drop.advance();
}

Drop& dropped(const benchmark::State& bench)
{
    static std::map<std::pair<long, long>, Drop> made;
    const std::pair<long, long> key(bench.range(0), bench.range(1));
    const auto found = made.find(key);
    if (found != made.end()) return found->second;
    Drop& drop = made[key];
    drop.scene.materials[0] = {0.15, 500.0, 0.3, 1e-5, 0.0, 1e-3};
    drop.scene.gravity = Gravity{};
    drop.scene.obstacles.push_back(make_floor());
    if (bench.range(1) == Draped)
        drape(static_cast<int>(bench.range(0)), drop);
    else
        let_fall(static_cast<int>(bench.range(0)), drop);
    drop.factorisation = time_factorisation(drop.work.problem);
    return drop;
}

/// Times `work` once an iteration, after an untimed `prepare`. Reports the least time as a ratio to one
/// factorisation.
template <typename Prepare, typename Work>
void measure(benchmark::State& bench, Drop& drop, const Prepare& prepare, const Work& work)
{
    double least = std::numeric_limits<double>::infinity(), sum = 0.0;
    for (auto _ : bench) {
        prepare();
        const double start = thread_seconds();
        work();
        const double seconds = thread_seconds() - start;
        bench.SetIterationTime(seconds);
        least = std::min(least, seconds);
        sum += seconds;
    }
    bench.counters["vertices"] = drop.state.mesh.vertex_count();
    bench.counters["ratio"] = least / drop.factorisation;
    bench.counters["mean_ratio"] = sum / static_cast<double>(bench.iterations()) / drop.factorisation;
    bench.counters["contacts"] = static_cast<double>(drop.state.active.size());
}

void assembly(benchmark::State& bench)
{
    Drop& drop = dropped(bench);
    measure(
        bench, drop, [] {},
        [&] {
            drop.work.mesh.system.assemble(drop.state.mesh, drop.work.mesh.elements, drop.work.mesh.terms,
                                           drop.work.linearization);
        });
}

void velocity_solve_warm(benchmark::State& bench)
{
    Drop& drop = dropped(bench);
    measure(
        bench, drop, [&] { drop.advance(); },
        [&] {
            benchmark::DoNotOptimize(drop.work.solver.solve(drop.work.problem, drop.settings).kkt_residual);
        });
}

void whole_step(benchmark::State& bench)
{
    Drop& drop = dropped(bench);
    measure(
        bench, drop, [] {}, [&] { drop.advance(); });
}

void of_every_size(benchmark::internal::Benchmark* bench)
{
    bench
        ->ArgsProduct({{32, 100, 224}, {Draped, Falling}})  // about 1, 10 and 50 thousand vertices
        ->ArgNames({"side", "falling"})
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond)
        ->Iterations(10);
}

BENCHMARK(assembly)->Apply(of_every_size);
BENCHMARK(velocity_solve_warm)->Apply(of_every_size);
BENCHMARK(whole_step)->Apply(of_every_size);

}  // namespace
}  // namespace arris

int main(int argc, char** argv)
{
    const oneapi::tbb::global_control control(oneapi::tbb::global_control::max_allowed_parallelism, 1);
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
