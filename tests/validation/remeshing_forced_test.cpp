// SPDX-License-Identifier: GPL-3.0-or-later
// Cloth whose mesh is made fine and coarse in turn, 50 times, while it moves: neither its motion nor its
// shape at rest may depend on that.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth_run.h"
#include "elastica.h"
#include "geometry/cloth/mesh_quality.h"
#include "solver/remesh/sizing_field.h"

namespace arris {
namespace {

constexpr int kChanges = 50;
// Lengths halve in 10 ms at the least and double in 70 ms at the least, so each phase can change the whole
// mesh.
constexpr double kFineTime = 0.04, kCoarseTime = 0.16;  // s
constexpr double kStep = 0.0025;                        // s
constexpr double kAreaTolerance = 1e-12;                // round-off, relative

/// Longest edges, m, that remeshing aims at in turn.
struct Wishes {
    double fine, coarse;
};

/// Remeshing by the longest edge alone: curvature, velocity and compression ask for nothing.
Remeshing remesh_between(const ClothMesh& mesh, const Wishes& wishes)
{
    Remeshing remesh;
    remesh.shortest = 0.5 * wishes.fine;
    remesh.longest = wishes.coarse;
    remesh.angle = M_PI;
    remesh.velocity = 1e6;
    remesh.compression = 1.0;
    remesh.most_vertices = 10000;
    remesh.step = kStep;
    measure_first_mesh(mesh, remesh);
    return remesh;
}

/// Numbers of operations, and of vertices at the ends of the fine and the coarse phases.
struct Changes {
    int operations = 0;
    int finest = 0, coarsest = std::numeric_limits<int>::max();
};

/// Runs through all phases. `advance` makes a step of kStep and returns the number of its operations.
template <typename Advance>
Changes alternate(ClothRun& run, const Wishes& wishes, const Advance& advance)
{
    Changes changes;
    for (int k = 0; k < kChanges && !testing::Test::HasFailure(); ++k) {
        const bool is_fine = k % 2 == 0;
        run.scene.remesh->longest = is_fine ? wishes.fine : wishes.coarse;
        const int steps = static_cast<int>(std::lround((is_fine ? kFineTime : kCoarseTime) / kStep));
        for (int i = 0; i < steps; ++i) changes.operations += advance();
        const int vertices = run.state.mesh.vertex_count();
        if (is_fine)
            changes.finest = std::max(changes.finest, vertices);
        else
            changes.coarsest = std::min(changes.coarsest, vertices);
    }
    return changes;
}

/// A step of kStep; returns the number of operations.
int advance_once(ClothRun& run)
{
    int operations = 0;
    run.advance(kStep, [&](const StepReport& report) { operations += report.remeshed; });
    return operations;
}

void expect_changed(const Changes& changes)
{
    EXPECT_GT(changes.finest, 2 * changes.coarsest) << "the meshes really differ";
    EXPECT_GT(changes.operations, kChanges / 2 * changes.coarsest);
}

constexpr double kLength = 0.24, kWidth = 0.12, kDensity = 0.15;  // m, m, kg/m^2
constexpr Wishes kStripWishes = {0.016, 0.06};                    // m

Material strip_material(BendingModel bending)
{
    return {kDensity, 500.0, 0.3, 1e-3, 0.0, 1e-3, bending};
}

/// A strip bent to a part of a cylinder, horizontal at u = 0.
ClothMesh make_bent_strip()
{
    ClothMesh mesh = make_sheet({kLength, kWidth}, {6, 3}, GridPattern::Cross);
    constexpr double kRadius = 0.15;
    lay(mesh, Vec3::Zero());
    for (std::size_t v = 0; v < mesh.world.size(); ++v) {
        const double s = mesh.material[v].x() / kRadius;
        mesh.world[v] = Vec3(kRadius * std::sin(s), mesh.material[v].y(), kRadius * (std::cos(s) - 1.0));
    }
    return mesh;
}

// Each step that changes the mesh is also made without a change. The difference of the two energies is due to
// remeshing alone: the integrator's own loss is in both. (Hinges lose 1.8 %: docs/research-notes.md.)
TEST(ForcedRemeshing, LeavesAPendulumOfAPlateItsEnergy)
{
    ClothMesh mesh = make_bent_strip();
    Scene scene;
    scene.materials[0] = strip_material(BendingModel::Plate);
    scene.gravity = Gravity{};
    scene.pins.push_back({{Vec2(0.0, 0.0), Vec2(0.0, kWidth)}, {}, {true, true, true}});
    ClothRun twin(scene, mesh);
    scene.remesh = remesh_between(mesh, kStripWishes);
    ClothRun run(std::move(scene), std::move(mesh));

    double added = 0.0, exchanged = 0.0, kinetic = 0.0;  // J
    const Changes changes = alternate(run, kStripWishes, [&] {
        twin.state = run.state;
        twin.state.sizing_field.clear();
        const int operations = advance_once(run);
        const ClothEnergy energy = measure_energy(run);
        exchanged += std::abs(energy.kinetic - kinetic);
        kinetic = energy.kinetic;
        if (operations == 0) return 0;
        twin.advance(kStep);
        added += energy.sum() - measure_energy(twin).sum();
        return operations;
    });
    expect_changed(changes);
    constexpr double kAllowed = 0.01;  // of the energy exchanged with gravity and bending
    EXPECT_LT(std::abs(added), kAllowed * exchanged);
    EXPECT_NEAR(material_area(run.state.mesh) / (kLength * kWidth), 1.0, kAreaTolerance);
}

Vec3 find_momentum(const State& state)
{
    Vec3 sum = Vec3::Zero();
    const std::vector<Vec2>& X = state.mesh.material;
    for (const Face& face : state.mesh.faces) {
        const double third = kDensity * twice_area(X[face[0]], X[face[1]], X[face[2]]) / 6.0;
        for (const int v : face) sum += third * state.velocity[v];
    }
    return sum;
}

TEST(ForcedRemeshing, KeepsMomentumInFreeFlight)
{
    ClothMesh mesh = make_bent_strip();
    Scene scene;
    scene.materials[0] = strip_material(BendingModel::Hinge);
    scene.remesh = remesh_between(mesh, kStripWishes);
    const Vec3 velocity(0.3, -0.2, 0.5);  // m/s
    ClothRun run(std::move(scene), std::move(mesh), velocity);
    const Vec3 exact = kDensity * kLength * kWidth * velocity;
    const Changes changes = alternate(run, kStripWishes, [&] { return advance_once(run); });
    expect_changed(changes);
    constexpr double kTolerance = 1e-10;  // relative: round-off in 2000 solves at a tolerance of 1e-9
    EXPECT_LT((find_momentum(run.state) - exact).norm(), kTolerance * exact.norm());
    EXPECT_NEAR(material_area(run.state.mesh) / (kLength * kWidth), 1.0, kAreaTolerance);
}

// Two cantilevers of 1 m, clamped by symmetry. Plates have the rigidity K on each mesh. The rigidity of
// hinges is a matter of the mesh, so they have no closed form here.
TEST(ForcedRemeshing, LeavesAHeavyStripWhereTheElasticaHangs)
{
    constexpr double kWide = 0.2, kWeight = 20.0;  // m, G
    constexpr double kThick = 0.04;                // sqrt(12 K / E), m
    constexpr double kModulus = 12.0 / (kThick * kThick);
    constexpr double kAllowed = 0.01;          // distance of the tip, over the length
    constexpr Wishes kLengths = {0.04, 0.14};  // m
    ClothMesh mesh = make_sheet({2.0, kWide}, {32, 3}, GridPattern::Cross);
    lay(mesh, Vec3::Zero());
    Scene scene;
    scene.materials[0] = {1.0, kModulus, 0.0, 1.0, 0.02, 1e-3, BendingModel::Plate};
    scene.gravity = Gravity{Vec3(0.0, 0.0, -kWeight)};
    scene.pins.push_back({{Vec2(1.0, 0.0), Vec2(1.0, kWide)}, {}, {true, true, true}});
    scene.remesh = remesh_between(mesh, kLengths);
    ClothRun run(std::move(scene), std::move(mesh));
    expect_changed(alternate(run, kLengths, [&] { return advance_once(run); }));
    run.scene.remesh->longest = kLengths.fine;
    settle(run);
    Vec2 tip = Vec2::Zero();
    const std::vector<int> line = vertices_inside(run.state.mesh, {Vec2(2.0, 0.0), Vec2(2.0, kWide)});
    for (const int v : line) {
        const Vec3& x = run.state.mesh.world[v];
        tip += Vec2(x.x() - 1.0, -x.z()) / static_cast<double>(line.size());
    }
    const ElasticaTip exact = solve_elastica({kWeight, 0.0, 1.0 / kModulus});
    EXPECT_LT((tip - Vec2(exact.x, exact.y)).norm(), kAllowed);
    EXPECT_NEAR(material_area(run.state.mesh) / (2.0 * kWide), 1.0, kAreaTolerance);
}

}  // namespace
}  // namespace arris
