// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/stitches.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/cloth/mesh_quality.h"
#include "geometry/cloth/mesh_topology.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

/// A unit square of two faces, whose diagonal is the edge (0, 2).
ClothMesh square()
{
    ClothMesh mesh;
    mesh.material = {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)};
    for (const Vec2& X : mesh.material) mesh.world.push_back(Vec3(X.x(), X.y(), 1.0));
    mesh.faces = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

TEST(Stitches, DivideTheEdgesThatTheyEndInside)
{
    ClothMesh mesh = square();
    // In both directions, on a border and on an inner edge; two at one place; one near a vertex.
    const auto pairs = divide_at_stitches({{3, 0, 1, 0.3, 1},
                                           {2, 1, 0, 0.3, 2},
                                           {1, 0, 2, 0.5, 3},
                                           {3, 1, 0, 0.31, 4},
                                           {3, 1, 2, 0.9, 5},
                                           {0, 0, 2, 0.1, 6}},
                                          mesh);
    EXPECT_EQ(validate(mesh), "");
    EXPECT_NEAR(material_area(mesh), 1.0, 1e-15);
    EXPECT_EQ(mesh.vertex_count(), 7);
    ASSERT_EQ(pairs.size(), 5U) << "the last one joins a vertex to itself";
    EXPECT_LT((mesh.world[pairs[0][1]] - Vec3(0.3, 0, 1)).norm(), 1e-15);
    EXPECT_LT((mesh.world[pairs[1][1]] - Vec3(0.69, 0, 1)).norm(), 0.02);
    EXPECT_EQ(pairs[1][1], pairs[3][1]);
    EXPECT_LT((mesh.world[pairs[2][1]] - Vec3(0.5, 0.5, 1)).norm(), 1e-15);
    EXPECT_LT((mesh.material[pairs[2][1]] - Vec2(0.5, 0.5)).norm(), 1e-15);
    EXPECT_EQ(pairs[4], (std::array{3, 2}));
}

TEST(Stitches, RefuseWhatIsNotThere)
{
    ClothMesh mesh = square();
    const auto error = [&](const std::function<void()>& action) -> std::string {
        try {
            action();
        } catch (const InputError& refused) {
            return refused.what();
        }
        return "";
    };
    EXPECT_THAT(error([&] {
                    divide_at_stitches({{0, 1, 3, 0.5, 7}}, mesh);
                }),
                ::testing::StartsWith("line 7: its stitch ends between two vertices that are no edge"));
    EXPECT_THAT(error([&] {
                    number_stitches({{{0, 1, 9}, 0.5, 8}}, {0, 1, 2});
                }),
                ::testing::StartsWith("line 8: its stitch names vertex 9"));
    EXPECT_THAT(error([&] {
                    number_stitches({{{0, 1, 2}, 0.5, 8}}, {0, 1, -1});
                }),
                ::testing::StartsWith("line 8: its stitch names vertex 2"));
    for (const char* wrong : {"stitch 0 1\n", "stitch 0 1 2 2\n", "stitch 0 -1 2 .5\n", "stitch 0 1 2 .5 3\n",
                              "stitch 0 1.5 2 0\n", "stitch a b c d\n"})
        EXPECT_THAT(error([&] { read_obj(wrong); }), ::testing::HasSubstr("stitch a b c r")) << wrong;
    EXPECT_EQ(read_obj("stitch 0 1 2 .25\n").stitches[0].share, 0.25);
    EXPECT_TRUE(read_obj("seam 12\n").warnings.empty());
}

}  // namespace
}  // namespace arris
