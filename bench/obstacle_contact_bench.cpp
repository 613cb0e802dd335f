// SPDX-License-Identifier: GPL-3.0-or-later
//
// Cost of finding a step's contacts, CPU time of one thread; each of the four parts, and all of them.
// Cloth: 10 000 vertices (1 x 1 m, cells of 1 cm) at rest, sliding at 1 m/s, falling at 20 m/s, and moving
// away at 20 m/s ("far"), for 5 ms. Obstacles: a box whose top is smaller than the cloth, and a smooth bumpy
// sheet of 100 000 faces.
#include <benchmark/benchmark.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>

#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/contact/obstacle_contact.h"
#include "tests/geometry/sample_obstacles.h"

namespace arris {
namespace {

constexpr double kThickness = 1e-3;

double bump(double x, double y)
{
    return 0.01 * std::sin(12.0 * x) * std::cos(11.0 * y);
}

enum class Shape { Box, Bumps };

Obstacle make_obstacle(Shape shape)
{
    ObstacleMesh mesh = samples::box(Vec3(0.1, 0.1, -1), Vec3(0.9, 0.9, 0));
    if (shape == Shape::Bumps) {
        constexpr int kCells = 224;
        mesh =
            samples::moved(samples::sheet(kCells, kCells, [](int, int) { return 0.0; }), [](const Vec3& p) {
                const double x = 1.2 * p.x() / kCells - 0.1, y = 1.2 * p.y() / kCells - 0.1;
                return Vec3(x, y, bump(x, y));
            });
    }
    return Obstacle(std::move(mesh), 30.0);
}

struct Cloth {
    ClothMesh mesh;
    MeshTopology topology;
    ClothMotion motion;

    Cloth(Shape shape, const Vec3& way)
    {
        ClothGrid grid;
        grid.resolution = {100, 100};
        grid.pattern = GridPattern::Alternating;
        mesh = make_cloth_grid(grid);
        topology = make_topology(mesh.vertex_count(), mesh.faces);
        motion.faces = &mesh.faces;
        motion.edges = &topology.edges;
        for (const Vec3& p : mesh.world) {
            const double floor = shape == Shape::Bumps ? bump(p.x(), p.y()) : 0.0;
            motion.begin.push_back({p.x(), p.y(), floor + kThickness});
            motion.end.push_back(motion.begin.back() + way);
        }
    }
    Cloth(const Cloth&) = delete;
};

enum class Part { Slide, Vertices, Edges, Faces, All };

void find(benchmark::State& state, Shape shape, const Vec3& way, Part part)
{
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const Obstacle obstacle = make_obstacle(shape);
    const Cloth cloth(shape, way);
    const std::vector<Vec3> slid = slide(obstacle, cloth.motion, kThickness);
    std::size_t count = 0;
    const auto has = [&](Part p) { return part == p || part == Part::All; };
    for (auto _ : state) {
        count = 0;
        if (has(Part::Slide)) benchmark::DoNotOptimize(slide(obstacle, cloth.motion, kThickness));
        if (has(Part::Vertices))
            count += find_vertex_contacts(obstacle, cloth.motion, slid, kThickness).size();
        if (has(Part::Edges)) count += find_edge_contacts(obstacle, cloth.motion, slid, kThickness).size();
        if (has(Part::Faces)) count += find_face_contacts(obstacle, cloth.motion, slid, kThickness).size();
    }
    state.counters["contacts"] = static_cast<double>(count);
}

void register_all()
{
    const std::pair<const char*, Shape> shapes[] = {{"box", Shape::Box}, {"bumps", Shape::Bumps}};
    const std::pair<const char*, Vec3> ways[] = {{"rest", {0, 0, -2.5e-4}},
                                                 {"slide", {5e-3, 0, -2.5e-4}},
                                                 {"fall", {0, 0, -0.1}},
                                                 {"far", {0, 0, 0.1}}};
    const std::pair<const char*, Part> parts[] = {{"slide", Part::Slide},
                                                  {"vertices", Part::Vertices},
                                                  {"edges", Part::Edges},
                                                  {"faces", Part::Faces},
                                                  {"all", Part::All}};
    for (const auto& shape : shapes)
        for (const auto& way : ways)
            for (const auto& part : parts)
                benchmark::RegisterBenchmark(
                    (std::string(shape.first) + "/" + way.first + "/" + part.first).c_str(),
                    [=](benchmark::State& state) { find(state, shape.second, way.second, part.second); })
                    ->Unit(benchmark::kMillisecond);
}

}  // namespace
}  // namespace arris

int main(int argc, char** argv)
{
    arris::register_all();
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
}
