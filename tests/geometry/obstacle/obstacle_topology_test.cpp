// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle/obstacle_topology.h"

#include <gtest/gtest.h>

#include <limits>

namespace arris {
namespace {

ObstacleMesh make_tetrahedron()
{
    return {
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}, {}, {}};
}

TEST(ObstacleTopology, KnowsWhatIsNextToWhat)
{
    const ObstacleMesh mesh = make_tetrahedron();
    const ObstacleTopology topology = make_topology(mesh);
    ASSERT_EQ(topology.edges.size(), 6u);
    EXPECT_EQ(topology.surface_edge_count, 6);
    for (int f = 0; f < 4; ++f)
        for (int i = 0; i < 3; ++i) {
            const ObstacleEdge& edge = topology.edges[topology.face_edges[f][i]];
            const int a = mesh.faces[f][i], b = mesh.faces[f][(i + 1) % 3];
            EXPECT_EQ(edge.points, (std::array<int, 2>{std::min(a, b), std::max(a, b)}));
            const int g = topology.neighbour(f, i);
            ASSERT_GE(g, 0);
            EXPECT_NE(g, f);
            for (const int p : {a, b})
                EXPECT_EQ(std::count(mesh.faces[g].begin(), mesh.faces[g].end(), p), 1);
        }
    for (int p = 0; p < 4; ++p) {
        ASSERT_EQ(topology.edge_count_at(p), 3);
        for (int k = 0; k < 3; ++k) {
            const std::array<int, 2>& ends = topology.edges[topology.edge_at(p, k)].points;
            EXPECT_TRUE(ends[0] == p || ends[1] == p);
        }
    }
    EXPECT_EQ(topology.face_normals[0], Vec3(0, 0, -1));
    EXPECT_NEAR((topology.face_normals[2] - Vec3(1, 1, 1).normalized()).norm(), 0.0, 1e-15);
}

TEST(ObstacleTopology, TellsSolidsFromSheetsAndKeepsWiresApart)
{
    ObstacleMesh mesh = make_tetrahedron();
    mesh.points.insert(mesh.points.end(), {{5, 0, 0}, {6, 0, 0}, {5, 1, 0}});
    mesh.faces.push_back({4, 5, 6});
    mesh.segments = {{3, 4}, {6, 5}};
    const ObstacleTopology topology = make_topology(mesh);
    ASSERT_EQ(topology.is_solid.size(), 2u);
    EXPECT_TRUE(topology.is_solid[topology.component[0]]);
    EXPECT_FALSE(topology.is_solid[topology.component[4]]);
    EXPECT_EQ(topology.surface_edge_count, 9);
    ASSERT_EQ(topology.edges.size(), 11u);
    EXPECT_EQ(topology.edges[10].points, (std::array<int, 2>{5, 6}));
    EXPECT_EQ(topology.edges[10].faces, (std::array<int, 2>{-1, -1}));
    EXPECT_EQ(topology.edge_count_at(3), 4) << "the wire's end counts the wire";
}

TEST(ObstacleTopology, ASliverFarAwayKeepsItsNormal)
{
    const double far = 1e6;
    ObstacleMesh mesh{
        {{far, far, far}, {far + 1, far, far}, {far + 0.5, far + 1e-6, far}}, {{0, 1, 2}}, {}, {}};
    EXPECT_NEAR((make_topology(mesh).face_normals[0] - Vec3::UnitZ()).norm(), 0.0, 1e-9);
}

TEST(ObstacleTopology, AnEmptyMeshHasNothing)
{
    const ObstacleTopology topology = make_topology({});
    EXPECT_TRUE(topology.edges.empty());
    EXPECT_TRUE(validate(ObstacleMesh()).empty());
}

TEST(ValidateObstacle, NamesWhatIsWrong)
{
    const auto sentence = [](auto spoil) {
        ObstacleMesh mesh = make_tetrahedron();
        spoil(mesh);
        return validate(mesh);
    };
    EXPECT_EQ(sentence([](ObstacleMesh&) {}), "");
    EXPECT_EQ(sentence([](ObstacleMesh& m) { m.points[2].y() = std::numeric_limits<double>::quiet_NaN(); }),
              "point 2 is not finite");
    EXPECT_EQ(sentence([](ObstacleMesh& m) { m.faces[1][0] = 4; }), "face 1 names a point that is not there");
    EXPECT_EQ(sentence([](ObstacleMesh& m) {
                  m.segments = {{0, -1}};
              }),
              "segment 0 names a point that is not there");
    EXPECT_EQ(sentence([](ObstacleMesh& m) { m.lone_points = {7}; }),
              "lone point 0 names a point that is not there");
    EXPECT_EQ(sentence([](ObstacleMesh& m) { m.points[3] = Vec3(0.5, 0, 0); }), "face 1 has no area");
    EXPECT_EQ(sentence([](ObstacleMesh& m) { m.segments = {{2, 2}}; }), "segment 0 has no length");
    EXPECT_EQ(sentence([](ObstacleMesh& m) {
                  m.faces[0] = {0, 1, 2};
              }),
              "faces 0 and 1 run the same way along edge (0, 1)");
    EXPECT_EQ(sentence([](ObstacleMesh& m) {
                  m.points.push_back({1, 1, 1});
                  m.faces.push_back({1, 0, 4});
              }),
              "more than two faces at edge (0, 1)");
}

}  // namespace
}  // namespace arris
