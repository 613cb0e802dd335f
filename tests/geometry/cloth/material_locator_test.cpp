// SPDX-License-Identifier: GPL-3.0-or-later
//
// material_box_test.cpp tests the free function.
#include "geometry/cloth/material_locator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace arris {
namespace {

/// Two squares that touch at u = 1 and share no vertex there, each a fan about its centre.
ClothMesh make_two_charts()
{
    ClothMesh mesh;
    for (const double left : {0.0, 1.0}) {
        const int first = mesh.vertex_count();
        for (const Vec2& corner : {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1), Vec2(0.5, 0.5)}) {
            mesh.material.emplace_back(left + corner.x(), corner.y());
            mesh.world.push_back(Vec3::Zero());
        }
        for (int k = 0; k < 4; ++k) mesh.faces.push_back({first + k, first + (k + 1) % 4, first + 4});
    }
    return mesh;
}

TEST(MaterialLocator, FindsWhatTheFreeFunctionFinds)
{
    const ClothMesh mesh = make_two_charts();
    const MaterialLocator locator(mesh.material, mesh.faces);
    const double tolerance = kMaterialTolerance * material_size(mesh.material);
    std::mt19937 random(5);
    std::uniform_int_distribution<int> step(-2, 18);  // eighths: many points on edges, vertices and outside
    for (int trial = 0; trial < 1000; ++trial) {
        const Vec2 point(0.125 * step(random), 0.125 * step(random));
        const MaterialLocation wanted = locate(mesh, point), found = locator.locate(point, tolerance);
        EXPECT_EQ(found.face, wanted.face) << point.transpose();
        EXPECT_EQ(found.weights, wanted.weights) << point.transpose();
    }
    EXPECT_EQ(locator.locate({std::nan(""), 0.5}, tolerance).face, -1);
}

TEST(MaterialLocator, BorderBelongsToTheSideThatIsAskedFor)
{
    const ClothMesh mesh = make_two_charts();
    const MaterialLocator locator(mesh.material, mesh.faces);
    for (const double v : {0.0, 0.25, 1.0}) {
        const Vec2 point(1.0, v);
        EXPECT_LT(locator.locate_on_border(point, {0.5, 0.5}, 1e-9).face, 4) << v;
        EXPECT_GE(locator.locate_on_border(point, {1.5, 0.5}, 1e-9).face, 4) << v;
    }
    // The weights are those of the point itself.
    const MaterialLocation at = locator.locate_on_border({1.0, 0.25}, {1.5, 0.5}, 1e-9);
    Vec2 place = Vec2::Zero();
    for (int k = 0; k < 3; ++k) place += at.weights[k] * mesh.material[mesh.faces[at.face][k]];
    EXPECT_LT((place - Vec2(1.0, 0.25)).norm(), 1e-15);
}

TEST(MaterialLocator, FacesWithoutAreaAreNotTaken)
{
    ClothMesh mesh = make_two_charts();
    mesh.faces.insert(mesh.faces.begin(), Face{0, 4, 2});  // three points on a diagonal
    const MaterialLocation at = MaterialLocator(mesh.material, mesh.faces).locate({0.25, 0.25}, 1e-9);
    EXPECT_GT(at.face, 0);
    EXPECT_NEAR(at.weights.sum(), 1.0, 1e-15);
}

}  // namespace
}  // namespace arris
