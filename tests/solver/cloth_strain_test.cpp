// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/cloth_strain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/rigid_motion.h"
#include "physics/forces/membrane.h"

namespace arris {
namespace {

constexpr double kRounding = 1e-12;

struct StrainCase {
    const char* name;
    double stretch, compression, in_plane;  // strains, expected
    std::function<Vec3(const Vec2&)> place;
};

const Mat3 kTurn = rotation_about(Vec3(1, 2, -0.5), 37.0);

const StrainCase kCases[] = {
    {"at rest", 0, 0, 0, [](const Vec2& X) { return Vec3(X.x(), X.y(), 0); }},
    {"compressed", 0, -0.1, -0.1, [](const Vec2& X) { return Vec3(0.9 * X.x(), X.y(), 0); }},
    {"compressed, turned", 0, -0.1, -0.1,
     [](const Vec2& X) { return Vec3(kTurn * Vec3(X.x(), 0.9 * X.y(), 0)); }},
    {"stretched", 0.25, 0, 0, [](const Vec2& X) { return Vec3(X.x(), 1.25 * X.y(), 0); }},
    // Poisson's ratio is 0.3: the tension across is E / (1 - 0.3^2) (-0.02 + 0.3 * 0.1) > 0.
    {"contracts across a pull", 0.1, -0.02, 0,
     [](const Vec2& X) { return Vec3(1.1 * X.x(), 0.98 * X.y(), 0); }},
    {"compressed across a pull", 0.1, -0.05, -0.05,
     [](const Vec2& X) { return Vec3(1.1 * X.x(), 0.95 * X.y(), 0); }},
    {"compressed and curved", 0, -0.1, 0,
     [](const Vec2& X) { return Vec3(0.9 * std::sin(X.x()), X.y(), 0.9 * std::cos(X.x())); }},
};

TEST(ClothStrain, IsThatOfEachDeformation)
{
    const Material material = {0.15, 500.0, 0.3, 1e-5, 0.0, 1e-3};
    for (const StrainCase& one : kCases) {
        SCOPED_TRACE(one.name);
        ClothGrid grid;
        grid.size = {1.0, 0.8};
        grid.resolution = {40, 4};
        ClothMesh mesh = make_cloth_grid(grid);
        for (int v = 0; v < mesh.vertex_count(); ++v) mesh.world[v] = one.place(mesh.material[v]);
        const MeshTopology topology = make_topology(mesh.vertex_count(), mesh.faces);
        const std::vector<Vec2> stretches =
            compute_stretches(list_elements(mesh, topology, HingeUse::None), mesh.world);
        const ClothStrain found =
            measure_cloth_strain(material, stretches, mesh, VertexFaces(mesh.vertex_count(), mesh.faces));
        // Faces across a curve are chords: 1/24 of their angle squared shorter.
        const double tolerance = one.in_plane < 0.0 || one.compression > -0.05 ? kRounding : 1e-4;
        EXPECT_NEAR(found.stretch.strain, one.stretch, tolerance);
        EXPECT_NEAR(found.compression.strain, one.compression, tolerance);
        EXPECT_NEAR(found.in_plane.strain, one.in_plane, kRounding);
        EXPECT_NEAR(found.greatest(), std::max(one.stretch, -one.compression), tolerance);
    }
}

/// A square with a vertex just inside its border: the face between them is 1e-6 as high as long. The vertex
/// is off its place by as much, so that this face is stretched to twice its height.
TEST(ClothStrain, OfAVeryThinFaceCountsByItsArea)
{
    constexpr double kHeight = 1e-6;
    ClothMesh mesh;
    mesh.material = {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1), Vec2(0.5, kHeight)};
    mesh.faces = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
    for (const Vec2& X : mesh.material) mesh.world.push_back(Vec3(X.x(), X.y(), 0));
    mesh.world[4].y() += kHeight;
    const MeshTopology topology = make_topology(mesh.vertex_count(), mesh.faces);
    const std::vector<Vec2> stretches =
        compute_stretches(list_elements(mesh, topology, HingeUse::None), mesh.world);
    EXPECT_NEAR(stretches[0].maxCoeff(), 2.0, 1e-9);
    const Material material = {0.15, 500.0, 0.3, 1e-5, 0.0, 1e-3};
    EXPECT_LT(measure_cloth_strain(material, stretches, mesh, VertexFaces(mesh.vertex_count(), mesh.faces))
                  .greatest(),
              5.0 * kHeight);
}

}  // namespace
}  // namespace arris
