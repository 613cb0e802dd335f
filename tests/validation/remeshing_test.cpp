// SPDX-License-Identifier: GPL-3.0-or-later
// Cloth on a mesh that follows its shape: what remeshing must not change, and where it must end.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cloth_run.h"
#include "geometry/cloth/mesh_quality.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "geometry/surgery/initial_target.h"
#include "grid_patterns.h"
#include "sliding_strip.h"
#include "solver/remesh/sizing_field.h"

namespace arris {
namespace {

constexpr double kThickness = 1e-3;  // m

Scene make_scene(const ClothMesh& mesh, double shortest, double longest)
{
    Scene scene;
    scene.materials[0] = {0.15, 500.0, 0.3, 1e-4, 0.002, kThickness};
    Remeshing remesh;
    remesh.shortest = shortest;
    remesh.longest = longest;
    measure_first_mesh(mesh, remesh);
    scene.remesh = remesh;
    return scene;
}

MovingObstacle make_block(const Vec3& size, const Vec3& middle)
{
    Placement place;
    place.translation = middle;
    return MovingObstacle("block", make_box(size), place, {}, 30.0);
}

/// Operations of the next `duration` (s).
int count_operations(ClothRun& run, double duration)
{
    int operations = 0;
    run.advance(duration, 0.005, [&](const StepReport& report) { operations += report.remeshed; });
    return operations;
}

TEST(Remeshing, CoarsensAFlatSheetAndThenLeavesIt)
{
    ClothMesh mesh = make_sheet({0.6, 0.6}, {20, 20}, GridPattern::Cross);
    lay(mesh, Vec3(-0.3, -0.3, 1.5 * kThickness));
    Scene scene = make_scene(mesh, 0.01, 0.1);
    scene.gravity = Gravity{};
    scene.obstacles.push_back(make_block({2.0, 2.0, 0.2}, {0.0, 0.0, -0.1}));
    ClothRun run(std::move(scene), std::move(mesh));
    const int before = run.state.mesh.vertex_count();
    EXPECT_GT(count_operations(run, 0.5), 0);
    EXPECT_LT(run.state.mesh.vertex_count(), before / 3);
    EXPECT_EQ(count_operations(run, 0.5), 0) << "100 steps";
    EXPECT_NEAR(material_area(run.state.mesh), 0.36, 1e-12);
}

TEST(Remeshing, RefinesClothThatHangsOverABoxAndThenLeavesIt)
{
    ClothMesh mesh = make_sheet({0.6, 0.6}, {8, 8}, GridPattern::Cross);
    lay(mesh, Vec3(-0.3, -0.3, 1.5 * kThickness));
    Scene scene = make_scene(mesh, 0.03, 0.1);
    scene.gravity = Gravity{};
    scene.materials[0].damping = 0.01;
    scene.obstacles.push_back(make_block({0.3, 0.3, 0.6}, {0.0, 0.0, -0.3}));
    scene.eol = make_initial_target(mesh);
    Pin pin;
    pin.material = {Vec2(0.29, 0.29), Vec2(0.31, 0.31)};
    scene.pins = {pin};
    ClothRun run(std::move(scene), std::move(mesh));
    const int before = run.state.mesh.vertex_count();
    EXPECT_GT(count_operations(run, 2.0), 0);
    EXPECT_GT(run.state.mesh.vertex_count(), before);
    EXPECT_LE(run.state.mesh.vertex_count(), run.scene.remesh->most_vertices);
    EXPECT_EQ(count_operations(run, 0.5), 0) << "100 steps";
    EXPECT_NEAR(material_area(run.state.mesh), 0.36, 1e-12);
    EXPECT_EQ(run.state.crossings, 0);
}

/// A sheet bent to a part of a cylinder, free in space.
ClothRun make_free_bent_sheet()
{
    ClothMesh mesh = make_sheet({0.24, 0.12}, {8, 4}, GridPattern::Cross);
    lay(mesh, Vec3::Zero());
    constexpr double kRadius = 0.04;
    for (std::size_t v = 0; v < mesh.world.size(); ++v) {
        const double s = mesh.material[v].x() / kRadius;
        mesh.world[v] = Vec3(kRadius * std::sin(s), mesh.material[v].y(), kRadius * std::cos(s));
    }
    Scene scene = make_scene(mesh, 0.005, 0.05);
    return ClothRun(std::move(scene), std::move(mesh), Vec3(0.3, -0.2, 0.5));
}

TEST(Remeshing, KeepsMomentum)
{
    ClothRun run = make_free_bent_sheet();
    const double mass = 0.15 * 0.24 * 0.12;
    const auto momentum = [&] {
        Vec3 sum = Vec3::Zero();
        for (const Face& face : run.state.mesh.faces) {
            const auto& [a, b, c] = face;
            const std::vector<Vec2>& X = run.state.mesh.material;
            const double third = 0.15 * twice_area(X[a], X[b], X[c]) / 6.0;
            for (const int v : face) sum += third * run.state.velocity[v];
        }
        return sum;
    };
    const Vec3 first = momentum();
    EXPECT_NEAR(first.norm(), mass * Vec3(0.3, -0.2, 0.5).norm(), 1e-12);
    EXPECT_GT(count_operations(run, 0.2), 50);
    EXPECT_LT((momentum() - first).norm(), 1e-9 * first.norm());
}

TEST(Remeshing, AddsLittleEnergyWhereASheetBends)
{
    ClothRun run = make_free_bent_sheet();
    const double bent =
        measure_energy(run).sum() - 0.5 * 0.15 * 0.24 * 0.12 * Vec3(0.3, -0.2, 0.5).squaredNorm();
    double added = 0.0;
    int operations = 0;
    run.advance(0.2, 0.002, [&](const StepReport& report) {
        added += std::max(report.remesh_energy, 0.0);
        operations += report.remeshed;
    });
    EXPECT_GT(operations, 50);
    EXPECT_LT(added, 0.05 * bent);
}

struct Slide {
    double length = 0.0;    ///< m, over the edge shortly before the strip lifts off, over that of a chain
    int most_vertices = 0;  ///< of all steps
};

Slide slide(const StripCase& strip, bool is_remeshed)
{
    ClothRun run = make_strip_run(strip);
    if (is_remeshed) {
        const double cell = strip.length / strip.cells[0];
        Remeshing remesh;
        remesh.shortest = 0.25 * cell;
        remesh.longest = 1.5 * cell;
        measure_first_mesh(run.state.mesh, remesh);
        Scene scene = run.scene;
        scene.remesh = remesh;
        run = ClothRun(std::move(scene), run.state.mesh);
    }
    const SlidingChain chain(strip.slopes, strip.length, strip.start);
    const double duration = 0.9 * chain.lift_off();
    Slide found;
    run.advance(duration, 0.005, [&](const StepReport&) {
        found.most_vertices = std::max(found.most_vertices, run.state.mesh.vertex_count());
    });
    found.length = measure_length_after(strip, run) / chain.length_after(duration);
    return found;
}

// The fold on the edge turns by 90 degrees and asks for no finer cells, as its EOL vertices resolve it. The
// rest of the strip is flat. Only short edges that the fold leaves behind are merged.
TEST(Remeshing, MakesNoFinerCellsWhereAStripSlidesOverAnEdge)
{
    constexpr double kTimeError = 5e-4;  // of BDF2 at 5 ms, as without remeshing
    constexpr double kMeshError = 1e-5;  // allowed effect of the mesh
    for (const double bending : {1e-5, 1e-4})
        for (const std::array<int, 2> cells : {std::array{8, 2}, {16, 4}}) {
            SCOPED_TRACE(fmt::format("K {:g} J, {} cells", bending, cells[0]));
            StripCase strip;
            strip.bending_stiffness = bending;
            strip.cells = cells;
            const Slide plain = slide(strip, false), remeshed = slide(strip, true);
            EXPECT_LE(remeshed.most_vertices, plain.most_vertices);
            EXPECT_NEAR(remeshed.length, 1.0, kTimeError);
            EXPECT_NEAR(remeshed.length / plain.length, 1.0, kMeshError);
        }
}

}  // namespace
}  // namespace arris
