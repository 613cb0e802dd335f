// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth/material_region.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/cloth_input/cloth_grid.h"

namespace arris {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kTolerance = 1e-12;

ClothMesh make_cloth(std::array<int, 2> resolution)
{
    ClothGrid grid;
    grid.size = Vec2(1.0, 1.0);
    grid.resolution = resolution;
    grid.pattern = GridPattern::Diagonal;
    return make_cloth_grid(grid);
}

TEST(VerticesInside, OfABoxAreThoseWithinItsTolerance)
{
    const ClothMesh mesh = make_cloth({2, 2});
    EXPECT_THAT(vertices_inside(mesh, {{0, 0}, {0, 1}}), ElementsAre(0, 3, 6));
    EXPECT_THAT(vertices_inside(mesh, {{0.5 + 9e-10, 0.5}, {0.9, 0.9}}), ElementsAre(4));
    EXPECT_THAT(vertices_inside(mesh, {{0.5 + 2e-9, 0.5}, {0.9, 0.9}}), IsEmpty());
}

TEST(VerticesInside, OfPickedVerticesAreThese)
{
    const ClothMesh mesh = make_cloth({9, 7});
    std::vector<int> picked;
    for (int v = 0; v < mesh.vertex_count(); v += 1 + v % 5) picked.push_back(v);
    EXPECT_EQ(vertices_inside(mesh, MaterialRegion::between(mesh, picked)), picked);
    EXPECT_THAT(vertices_inside(mesh, MaterialRegion::between(mesh, {})), IsEmpty());
}

TEST(MaterialRegion, BetweenVerticesHasTheirEdgesAndFaces)
{
    const ClothMesh mesh = make_cloth({4, 4});  // vertices 0 to 4 have v = 0, 5 to 9 have v = 0.25
    const MaterialRegion edge = MaterialRegion::between(mesh, {1, 2, 3});
    EXPECT_TRUE(edge.contains(Vec2(0.3, 0.0), kTolerance));
    EXPECT_FALSE(edge.contains(Vec2(0.2, 0.0), kTolerance));
    EXPECT_FALSE(edge.contains(Vec2(0.3, 1e-3), kTolerance));
    EXPECT_NEAR(edge.distance(Vec2(1.0, 0.0)), 0.25, 1e-15);
    EXPECT_NEAR(edge.distance(Vec2(0.5, 0.2)), 0.2, 1e-15);

    const MaterialRegion cells = MaterialRegion::between(mesh, {0, 1, 5, 6});
    EXPECT_TRUE(cells.contains(Vec2(0.2, 0.1), kTolerance));
    EXPECT_TRUE(cells.contains(Vec2(0.1, 0.2), kTolerance));
    EXPECT_FALSE(cells.contains(Vec2(0.26, 0.1), kTolerance));
    EXPECT_EQ(cells.distance(Vec2(0.2, 0.1)), 0.0);
}

TEST(MaterialRegion, BetweenVerticesIsOfSeveralParts)
{
    const ClothMesh mesh = make_cloth({4, 4});
    const MaterialRegion corners = MaterialRegion::between(mesh, {0, 4, 20, 24});
    EXPECT_EQ(corners.parts().size(), 4U);
    EXPECT_TRUE(corners.contains(Vec2(1.0, 1.0), kTolerance));
    EXPECT_FALSE(corners.contains(Vec2(0.5, 0.0), kTolerance));
    EXPECT_NEAR(corners.distance(Vec2(0.5, 0.5)), std::sqrt(0.5), 1e-15);
}

TEST(MaterialRegion, ContainsWhatASearchThroughAllFacesFinds)
{
    const ClothMesh mesh = make_cloth({12, 9});
    std::vector<int> picked;
    for (int v = 0; v < mesh.vertex_count(); ++v)
        if ((7 * v) % 11 < 6) picked.push_back(v);
    const MaterialRegion region = MaterialRegion::between(mesh, picked);
    int inside = 0;
    for (int k = 0; k < 3000; ++k) {
        const Vec2 X(std::fmod(0.618034 * k, 1.0), std::fmod(0.414214 * k, 1.0));
        const bool is_inside = region.distance(X) <= 1e-4;
        inside += is_inside;
        EXPECT_EQ(region.contains(X, 1e-4), is_inside) << X.transpose();
    }
    EXPECT_GT(inside, 100);
}

}  // namespace
}  // namespace arris
