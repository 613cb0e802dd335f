// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/repair/vertex_origins.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/input_error.h"
#include "geometry/obstacle_input/obstacle_reply.h"
#include "tests/app/error_of.h"
#include "tests/geometry/imported_file.h"
#include "tests/geometry/mesh_files.h"
#include "tests/geometry/sample_obstacles.h"

namespace arris {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;

// A cube with unused vertices, a doubled corner, quads, and a lid of its own vertices, one of them 1e-7 m
// off.
constexpr const char* kCube = R"(v 9 9 9
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v nan 0 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
v 1 0 0
v 0 0 1.0000001
v 1 0 1
v 1 1 1
v 0 1 1
f 2 5 4 3
f 2 11 8 7
f 3 4 9 8
f 4 5 10 9
f 5 2 7 10
f 12 13 14 15
)";

// Vertices of the OBJ file, from 1, as a reader of `v` lines counts.
Vec3 vertex_of(int number)
{
    const Vec3 places[] = {{9, 9, 9}, {0, 0, 0},         {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                           {0, 0, 0}, {0, 0, 1},         {1, 0, 1}, {1, 1, 1}, {0, 1, 1},
                           {1, 0, 0}, {0, 0, 1.0000001}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    return places[number];
}

TEST(VertexOrigins, FollowWeldsCutsAndUnusedVerticesOfAnObj)
{
    const ObstacleFile file = imported("cube.obj", kCube);
    ASSERT_EQ(file.mesh.points.size(), 8U);
    ASSERT_EQ(file.mesh.faces.size(), 12U);
    EXPECT_EQ(file.origins.vertex_count, 15);
    ASSERT_EQ(file.origins.of_points.size(), 8U);
    for (std::size_t p = 0; p < 8; ++p) {
        const int v = file.origins.of_points[p];
        EXPECT_EQ(file.mesh.points[p], vertex_of(v)) << v;
        EXPECT_LT(v, 10) << "a point follows the first of its vertices";
    }
    EXPECT_THAT(file.origins.joined, ElementsAre(ElementsAre(2, 10), ElementsAre(6, 11), ElementsAre(7, 12),
                                                 ElementsAre(8, 13), ElementsAre(9, 14)));
    EXPECT_GT(file.origins.tolerance, 1e-7);
    EXPECT_LT(file.origins.tolerance, 1e-5);
}

TEST(VertexOrigins, WiresAndLonePointsHaveThemToo)
{
    const ObstacleFile file =
        imported("wire.obj", "v 5 5 5\nv 0 0 0\nv 1 0 0\nv 2 0 0\nv 7 0 0\nv 1 0 0\nl 2 3\nl 6 4\np 5\n");
    ASSERT_EQ(file.mesh.points.size(), 4U);
    EXPECT_THAT(file.origins.of_points, ElementsAre(1, 2, 3, 4));
    EXPECT_THAT(file.origins.joined, ElementsAre(ElementsAre(2, 5)));
}

TEST(VertexOrigins, ACopyOfAPointFollowsTheSameVertex)
{
    // Two tetrahedra that touch in a corner only are cut apart there.
    const ObstacleFile file =
        imported("two.obj",
                 "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv -1 0 0\nv 0 -1 0\nv 0 0 -1\n"
                 "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\nf 1 5 6\nf 1 7 5\nf 1 6 7\nf 5 7 6\n");
    ASSERT_EQ(file.mesh.points.size(), 8U);
    EXPECT_EQ(std::count(file.origins.of_points.begin(), file.origins.of_points.end(), 0), 2);
    EXPECT_THAT(file.origins.joined, IsEmpty());
}

TEST(VertexOrigins, OfPlyFilesAreItsVertices)
{
    const ObstacleMesh box = samples::box(Vec3::Zero(), Vec3::Ones());
    const ObstacleFile file = imported("box.ply", mesh_files::binary_ply(box));
    EXPECT_EQ(file.origins.vertex_count, static_cast<int>(box.points.size()));
    for (std::size_t p = 0; p < file.mesh.points.size(); ++p)
        EXPECT_EQ(file.mesh.points[p], box.points[file.origins.of_points[p]]);
}

TEST(VertexOrigins, OfGltfFilesAreTheVerticesOfTheirPrimitives)
{
    const ObstacleMesh box = samples::box(Vec3::Zero(), Vec3::Ones());
    const ObstacleFile file = imported("box.glb", mesh_files::glb(box));
    EXPECT_EQ(file.origins.vertex_count, static_cast<int>(box.points.size()));
    for (std::size_t p = 0; p < file.mesh.points.size(); ++p) {
        const Vec3& vertex = box.points[file.origins.of_points[p]];
        EXPECT_EQ(file.mesh.points[p], Vec3(vertex.x(), -vertex.z(), vertex.y()));
    }
}

TEST(VertexOrigins, OtherFormatsHaveNone)
{
    const ObstacleMesh box = samples::box(Vec3::Zero(), Vec3::Ones());
    const ObstacleFile file = imported("box.stl", mesh_files::binary_stl(box));
    EXPECT_EQ(file.origins.vertex_count, 0);
    EXPECT_THAT(file.origins.of_points, IsEmpty());
}

TEST(VertexOrigins, PassThroughTheReplyAndAreCheckedThere)
{
    const ObstacleFile file = imported("cube.obj", kCube);
    const ObstacleFile read = decode_reply(encode_reply(file));
    EXPECT_EQ(read.origins.vertex_count, 15);
    EXPECT_EQ(read.origins.of_points, file.origins.of_points);
    EXPECT_EQ(read.origins.joined, file.origins.joined);
    EXPECT_EQ(read.origins.tolerance, file.origins.tolerance);

    const auto refused = [&](const auto& damage) {
        ObstacleFile wrong = file;
        damage(wrong.origins);
        return error_of([&] { decode_reply(encode_reply(wrong)); }) == "the reply of its import is damaged";
    };
    EXPECT_FALSE(refused([](VertexOrigins& o) { o.of_points[0] = -1; }));
    EXPECT_TRUE(refused([](VertexOrigins& o) { o.of_points[0] = 15; }));
    EXPECT_TRUE(refused([](VertexOrigins& o) { o.of_points[0] = -2; }));
    EXPECT_TRUE(refused([](VertexOrigins& o) { o.of_points.pop_back(); }));
    EXPECT_TRUE(refused([](VertexOrigins& o) { o.joined[0][1] = 15; }));
    EXPECT_TRUE(refused([](VertexOrigins& o) { o.joined[0][0] = -1; }));
    EXPECT_TRUE(refused([](VertexOrigins& o) { o.vertex_count = -1; }));
    EXPECT_TRUE(refused([](VertexOrigins& o) { o.vertex_count = 0; }));
    EXPECT_TRUE(refused([](VertexOrigins& o) { o.tolerance = -1.0; }));
}

}  // namespace
}  // namespace arris
