// SPDX-License-Identifier: GPL-3.0-or-later
//
// The numeric factorisation of a cloth's matrix against CHOLMOD's with the same METIS order, on one thread
// and on more. Wall times, so the machine must be idle. The first argument is the number of vertices along
// one side, the second the number of threads. `ratio` is the least time over CHOLMOD's least time.
//   cholmod      cholmod_super_numeric with METIS's order of the vertices, the reference
//   factorise    with METIS's order, or by dissection in the plane
//     critical   share of the flops that no number of threads makes at the same time
//   solve        forward and backward
//   analyse      order and symbolic factorisation
#include <benchmark/benchmark.h>
#include <cholmod.h>
#include <oneapi/tbb/global_control.h>

#include <chrono>
#include <limits>
#include <map>

#include "solver/velocity_solve/factorization.h"
#include "solver/velocity_solve/vertex_ordering.h"
#include "tests/solver/cloth_system.h"

extern "C" void openblas_set_num_threads(int);

namespace arris {
namespace {

struct Cloth {
    Eigen::SparseMatrix<double> matrix;
    std::vector<Vec2> place;
    std::vector<char> is_pinned;
    double reference = 0.0;  ///< s, CHOLMOD's least time
};

double seconds()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Runs `work` for each iteration; returns the least time.
template <class Work>
double measure(benchmark::State& state, const Work& work)
{
    double least = std::numeric_limits<double>::infinity();
    for (auto _ : state) {
        const double start = seconds();
        work();
        const double time = seconds() - start;
        state.SetIterationTime(time);
        least = std::min(least, time);
    }
    return least;
}

/// CHOLMOD's supernodal factorisation, of METIS's order of the vertices.
class Cholmod {
  public:
    explicit Cholmod(const Eigen::SparseMatrix<double>& matrix)
    {
        openblas_set_num_threads(1);  // its own threads make this five times as slow
        cholmod_start(&common_);
        common_.supernodal = CHOLMOD_SUPERNODAL;
        common_.nmethods = 1;
        common_.method[0].ordering = CHOLMOD_GIVEN;
        VertexGraph graph(matrix);
        std::vector<int> order;
        for (const int vertex : order_by_metis(graph, common_))
            for (int axis = 0; axis < 3; ++axis) order.push_back(3 * vertex + axis);
        Eigen::SparseMatrix<double> lower = matrix.triangularView<Eigen::Lower>();
        cholmod_sparse sparse = {};
        sparse.nrow = sparse.ncol = static_cast<std::size_t>(lower.cols());
        sparse.nzmax = static_cast<std::size_t>(lower.nonZeros());
        sparse.p = lower.outerIndexPtr();
        sparse.i = lower.innerIndexPtr();
        sparse.x = lower.valuePtr();
        sparse.stype = -1;
        sparse.itype = CHOLMOD_INT;
        sparse.xtype = CHOLMOD_REAL;
        sparse.dtype = CHOLMOD_DOUBLE;
        sparse.sorted = sparse.packed = 1;
        factor_ = cholmod_analyze_p(&sparse, order.data(), nullptr, 0, &common_);
        cholmod_sparse* upper =
            cholmod_ptranspose(&sparse, 1, static_cast<int*>(factor_->Perm), nullptr, 0, &common_);
        permuted_ = cholmod_transpose(upper, 1, &common_);
        cholmod_free_sparse(&upper, &common_);
    }
    ~Cholmod()
    {
        cholmod_free_sparse(&permuted_, &common_);
        cholmod_free_factor(&factor_, &common_);
        cholmod_finish(&common_);
    }
    Cholmod(const Cholmod&) = delete;
    Cholmod& operator=(const Cholmod&) = delete;

    void factorise()
    {
        double shift[2] = {0.0, 0.0};
        cholmod_super_numeric(permuted_, nullptr, shift, factor_, &common_);
    }

  private:
    cholmod_common common_ = {};
    cholmod_sparse* permuted_ = nullptr;  ///< lower triangle
    cholmod_factor* factor_ = nullptr;
};

Cloth& cloth_of(long side)
{
    static std::map<long, Cloth> made;
    const auto found = made.find(side);
    if (found != made.end()) return found->second;
    testing::ClothShape shape;
    shape.side = static_cast<int>(side);
    const testing::ClothSystem system = testing::make_cloth_system(shape);
    Cloth& cloth = made[side];
    cloth.matrix = system.matrix;
    cloth.matrix.makeCompressed();
    for (const Vec3& x : system.position) cloth.place.push_back(x.head<2>());
    cloth.is_pinned.assign(static_cast<std::size_t>(cloth.matrix.rows()), 0);
    return cloth;
}

void cholmod(benchmark::State& state)
{
    Cloth& cloth = cloth_of(state.range(0));
    Cholmod reference(cloth.matrix);
    cloth.reference = measure(state, [&] { reference.factorise(); });
}

enum class Order { Metis, Place };

void analyse(Factorization& factorization, const Cloth& cloth, Order order)
{
    factorization.analyse(cloth.matrix, order == Order::Place ? &cloth.place : nullptr);
}

class Threads {
  public:
    explicit Threads(const benchmark::State& state)
        : control_(oneapi::tbb::global_control::max_allowed_parallelism,
                   static_cast<std::size_t>(state.range(1)))
    {
    }

  private:
    oneapi::tbb::global_control control_;
};

void factorise(benchmark::State& state, Order order)
{
    const Threads threads(state);
    const Cloth& cloth = cloth_of(state.range(0));
    Factorization factorization;
    analyse(factorization, cloth, order);
    const double least = measure(
        state, [&] { benchmark::DoNotOptimize(factorization.factorise(cloth.matrix, cloth.is_pinned)); });
    state.counters["ratio"] = least / cloth.reference;
    state.counters["critical"] = factorization.critical_flops() / factorization.flops();
    state.counters["Gflops"] = 1e-9 * factorization.flops() / least;
}

void solve(benchmark::State& state)
{
    const Threads threads(state);
    const Cloth& cloth = cloth_of(state.range(0));
    Factorization factorization;
    analyse(factorization, cloth, Order::Place);
    factorization.factorise(cloth.matrix, cloth.is_pinned);
    const Eigen::VectorXd rhs = Eigen::VectorXd::LinSpaced(cloth.matrix.rows(), -1.0, 2.0);
    state.counters["ratio"] =
        measure(state,
                [&] {
                    benchmark::DoNotOptimize(
                        factorization.solve_backward(factorization.solve_forward(rhs)).size());
                }) /
        cloth.reference;
}

void analyse(benchmark::State& state, Order order)
{
    const Cloth& cloth = cloth_of(state.range(0));
    const double least = measure(state, [&] {
        Factorization factorization;
        analyse(factorization, cloth, order);
    });
    state.counters["ratio"] = least / cloth.reference;
}

const std::vector<std::int64_t> kSides = {14, 32, 45, 54, 100, 224, 316};  // from 200 to 100 000 vertices

void of_every_size(benchmark::internal::Benchmark* benchmark)
{
    benchmark->ArgsProduct({kSides})->UseManualTime()->Unit(benchmark::kMillisecond)->MinTime(0.3);
}

void with_threads(benchmark::internal::Benchmark* benchmark)
{
    benchmark->ArgsProduct({kSides, {1, 2, 4}})->UseManualTime()->Unit(benchmark::kMillisecond)->MinTime(0.3);
}

BENCHMARK(cholmod)->Apply(of_every_size);  // first: the others are compared with it
BENCHMARK_CAPTURE(factorise, metis, Order::Metis)->Apply(with_threads);
BENCHMARK_CAPTURE(factorise, place, Order::Place)->Apply(with_threads);
BENCHMARK(solve)->Apply(with_threads);
BENCHMARK_CAPTURE(analyse, metis, Order::Metis)->Apply(of_every_size);
BENCHMARK_CAPTURE(analyse, place, Order::Place)->Apply(of_every_size);

}  // namespace
}  // namespace arris

BENCHMARK_MAIN();
