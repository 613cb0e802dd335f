// SPDX-License-Identifier: GPL-3.0-or-later
//
// Cost of the check after a step, and of a single sweep, CPU time of one thread. 20 000 cloth faces (1 x 1 m,
// cells of 1 cm) are 0.15 mm above a box's top or a smooth bumpy sheet of 100 000 faces. The cloth is at
// rest, slides at 1 m/s, sinks by 1e-6 m, or falls through at 1 m/s, for 5 ms.
#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <random>

#include "geometry/check/sweep_check.h"
#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/contact/continuous_collision.h"
#include "tests/geometry/sample_obstacles.h"

namespace arris {
namespace {

constexpr double kThickness = 1e-4;
constexpr double kGap = 1.5e-4;  // m; the bumps' chords reduce this gap by 0.04 mm

double bump(double x, double y)
{
    return 0.01 * std::sin(12.0 * x) * std::cos(11.0 * y);
}

Obstacle make_obstacle(ObstacleMesh mesh)
{
    return Obstacle(std::move(mesh), 30.0);
}

Obstacle make_bumpy()
{
    constexpr int kCells = 224;
    ObstacleMesh mesh = samples::sheet(kCells, kCells, [](int, int) { return 0.0; });
    return make_obstacle(samples::moved(mesh, [](const Vec3& p) {
        const double x = 1.2 * p.x() / kCells - 0.1, y = 1.2 * p.y() / kCells - 0.1;
        return Vec3(x, y, bump(x, y));
    }));
}

struct Cloth {
    ClothMesh mesh;
    MeshTopology topology;
    ClothMotion motion;

    Cloth(bool is_bumpy, double slide)
    {
        ClothGrid grid;
        grid.resolution = {100, 100};
        grid.pattern = GridPattern::Alternating;
        mesh = make_cloth_grid(grid);
        topology = make_topology(mesh.vertex_count(), mesh.faces);
        motion.faces = &mesh.faces;
        motion.edges = &topology.edges;
        for (const Vec3& p : mesh.world) {
            const auto place = [&](double x) {
                return Vec3(x, p.y(), kGap + (is_bumpy ? bump(x, p.y()) : 0.0));
            };
            motion.begin.push_back(place(p.x()));
            motion.end.push_back(place(p.x() + slide));
        }
    }
    Cloth(const Cloth&) = delete;
};

void check(benchmark::State& state, bool is_bumpy, double slide, double drop)
{
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    // The pole beside the box enlarges the obstacle's bounding box, which then does not exclude the cloth.
    const Obstacle obstacle =
        is_bumpy ? make_bumpy()
                 : make_obstacle(samples::together(samples::box(Vec3(-0.1, -0.1, -1), Vec3(1.1, 1.1, 0)),
                                                   samples::box(Vec3(2, 2, -1), Vec3(2.1, 2.1, 1))));
    Cloth cloth(is_bumpy, slide);
    for (Vec3& p : cloth.motion.end) p.z() -= drop;
    SweepReport report;
    for (auto _ : state) report = check_sweep(obstacle, cloth.motion, kThickness);
    state.counters["crossings"] = report.crossings;
    state.counters["violations"] = static_cast<double>(report.violations.size());
    state.counters["intersections"] = report.intersections;
}

BENCHMARK_CAPTURE(check, box_rest, false, 0.0, 0.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(check, box_slide, false, 0.005, 0.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(check, box_fall_through, false, 0.0, 0.005)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(check, bumpy_rest, true, 0.0, 0.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(check, bumpy_settle, true, 0.0, 1e-6)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(check, bumpy_slide, true, 0.005, 0.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(check, bumpy_fall_through, true, 0.0, 0.005)->Unit(benchmark::kMillisecond);

enum class Distance { Far, Near, Hit };

/// Sweeps pairs of edges of about unit length that move by about 1.
void sweep(benchmark::State& state, Distance distance)
{
    constexpr int kPairs = 1024;
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const auto vector = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
    std::vector<std::array<std::array<Vec3, 2>, 3>> pairs(kPairs);
    for (auto& [begin, end, segment] : pairs) {
        do {
            begin = {vector(), vector()};
            segment = {vector(), vector()};
            const Vec3 way = vector();
            end = {Vec3(begin[0] + way + 0.2 * vector()), Vec3(begin[1] + way + 0.2 * vector())};
            if (distance == Distance::Far)
                for (Vec3& p : segment) p.x() += 3.5;
        } while (distance != Distance::Far &&
                 sweep_edge_edge(begin, end, segment, 1e-9).has_value() != (distance == Distance::Hit));
    }
    int i = 0;
    for (auto _ : state) {
        const auto& [begin, end, segment] = pairs[i++ % kPairs];
        benchmark::DoNotOptimize(sweep_edge_edge(begin, end, segment, 1e-9));
    }
}

BENCHMARK_CAPTURE(sweep, far, Distance::Far);
BENCHMARK_CAPTURE(sweep, near, Distance::Near);
BENCHMARK_CAPTURE(sweep, hit, Distance::Hit);

}  // namespace
}  // namespace arris

BENCHMARK_MAIN();
