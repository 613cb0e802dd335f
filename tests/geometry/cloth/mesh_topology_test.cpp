// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth/mesh_topology.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "geometry/cloth_input/cloth_grid.h"

namespace arris {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

ClothMesh flat(std::vector<Vec2> material, std::vector<Face> faces)
{
    ClothMesh mesh{std::move(material), {}, std::move(faces)};
    for (const Vec2& X : mesh.material) mesh.world.emplace_back(X.x(), X.y(), 0.0);
    return mesh;
}

ClothMesh square()
{
    return flat({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0, 1, 2}, {0, 2, 3}});
}

ClothMesh grid(int nu, int nv, GridPattern pattern, double angle)
{
    ClothGrid grid;
    grid.size = Vec2(0.1 * nu, 0.1 * nv);
    grid.resolution = {nu, nv};
    grid.pattern = pattern;
    grid.pattern_angle = angle;
    return make_cloth_grid(grid);
}

bool has_side(const Face& face, int a, int b)
{
    return (face[0] == a && face[1] == b) || (face[1] == a && face[2] == b) || (face[2] == a && face[0] == b);
}

// The face with the half-edge a -> b, by brute force.
int face_left_of(const ClothMesh& mesh, int a, int b)
{
    for (int f = 0; f < mesh.face_count(); ++f)
        if (has_side(mesh.faces[f], a, b)) return f;
    return -1;
}

int third(const Face& face, int a, int b)
{
    return face[0] + face[1] + face[2] - a - b;
}

void expect_topology_by_brute_force(const ClothMesh& mesh)
{
    const MeshTopology topology = make_topology(mesh.vertex_count(), mesh.faces);
    std::set<std::pair<int, int>> edges;
    for (const Face& face : mesh.faces)
        for (int k = 0; k < 3; ++k) edges.insert(std::minmax(int(face[k]), int(face[(k + 1) % 3])));
    std::set<int> border;
    std::size_t hinge = 0;
    ASSERT_EQ(topology.edges.size(), edges.size());
    auto expected = edges.begin();
    for (const MeshEdge& edge : topology.edges) {
        ASSERT_EQ(std::pair(edge.a, edge.b), *expected++);
        const int left = face_left_of(mesh, edge.a, edge.b);
        const int right = face_left_of(mesh, edge.b, edge.a);
        if (left < 0 || right < 0) {
            border.insert({edge.a, edge.b});
            EXPECT_EQ(edge.face_left, std::max(left, right));
            EXPECT_EQ(edge.face_right, -1);
            continue;
        }
        EXPECT_EQ(edge.face_left, left);
        EXPECT_EQ(edge.face_right, right);
        ASSERT_LT(hinge, topology.hinges.size());
        const Hinge& h = topology.hinges[hinge++];
        EXPECT_EQ(std::tuple(h.a, h.b, h.face_c, h.face_d), std::tuple(edge.a, edge.b, left, right));
        EXPECT_EQ(h.c, third(mesh.faces[left], h.a, h.b));
        EXPECT_EQ(h.d, third(mesh.faces[right], h.a, h.b));
    }
    EXPECT_EQ(hinge, topology.hinges.size());
    for (int v = 0; v < mesh.vertex_count(); ++v)
        EXPECT_EQ(topology.is_border[v] != 0, border.contains(v)) << v;
}

TEST(MeshTopology, AgreesWithBruteForceOnEveryPattern)
{
    for (const GridPattern pattern :
         {GridPattern::Diagonal, GridPattern::Alternating, GridPattern::Cross, GridPattern::Unstructured})
        for (const double angle : {0.0, 20.0}) {
            expect_topology_by_brute_force(grid(1, 1, pattern, angle));
            expect_topology_by_brute_force(grid(5, 4, pattern, angle));
        }
}

TEST(MeshTopology, OfOneFaceIsThreeBorderEdges)
{
    const MeshTopology topology = make_topology(3, {{2, 0, 1}});
    ASSERT_EQ(topology.edges.size(), 3u);
    EXPECT_THAT(topology.hinges, IsEmpty());
    for (const MeshEdge& edge : topology.edges)
        EXPECT_EQ(std::pair(edge.face_left, edge.face_right), std::pair(0, -1));
}

TEST(MeshTopology, HingeNamesItsFacesCorners)
{
    const MeshTopology topology = make_topology(4, square().faces);
    ASSERT_EQ(topology.hinges.size(), 1u);
    const Hinge& h = topology.hinges[0];
    // Half-edge 0 -> 2 is in face 1 = (0, 2, 3), half-edge 2 -> 0 in face 0 = (0, 1, 2).
    EXPECT_EQ(std::tuple(h.a, h.b, h.c, h.d, h.face_c, h.face_d), std::tuple(0, 2, 3, 1, 1, 0));
}

TEST(Validate, AcceptsAGoodMesh)
{
    EXPECT_EQ(validate(square()), "");
}

TEST(Validate, AcceptsSeveralComponents)
{
    EXPECT_EQ(validate(flat({{0, 0}, {1, 0}, {0, 1}, {5, 0}, {6, 0}, {5, 1}}, {{0, 1, 2}, {3, 4, 5}})), "");
}

TEST(Validate, NamesIndicesOutOfRange)
{
    ClothMesh mesh = square();
    mesh.faces[1][2] = 4;
    EXPECT_THAT(validate(mesh), HasSubstr("face 1 names vertex 4 of 4"));
    mesh.faces[1][2] = -1;
    EXPECT_THAT(validate(mesh), HasSubstr("face 1 names vertex -1"));
}

TEST(Validate, NamesARepeatedVertex)
{
    ClothMesh mesh = square();
    mesh.faces.push_back({3, 3, 0});
    EXPECT_THAT(validate(mesh), HasSubstr("face 2 names a vertex twice"));
}

TEST(Validate, NamesAnUnusedVertex)
{
    ClothMesh mesh = square();
    mesh.material.emplace_back(2, 2);
    mesh.world.emplace_back(2, 2, 0);
    EXPECT_THAT(validate(mesh), HasSubstr("vertex 4 belongs to no face"));
    mesh.world.pop_back();
    EXPECT_THAT(validate(mesh), HasSubstr("5 material but 4 world"));
}

TEST(Validate, NamesCoordinatesThatAreNotFinite)
{
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        ClothMesh mesh = square();
        mesh.world[2].z() = bad;
        EXPECT_THAT(validate(mesh), HasSubstr("vertex 2 is at"));
        mesh = square();
        mesh.material[3].y() = bad;
        EXPECT_THAT(validate(mesh), HasSubstr("vertex 3 has material coordinates"));
    }
}

TEST(Validate, NamesAnEdgeOfThreeFaces)
{
    const ClothMesh mesh =
        flat({{0, 0}, {1, 0}, {0.5, 1}, {0.5, -1}, {0.5, 2}}, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
    EXPECT_THAT(validate(mesh), HasSubstr("edge (0, 1) has more than two faces (0, 2, 1)"));
}

TEST(Validate, NamesFacesThatRunTheSameWayAlongAnEdge)
{
    EXPECT_THAT(validate(flat({{0, 0}, {1, 0}, {0.5, 1}, {0.5, 2}}, {{0, 1, 2}, {0, 1, 3}})),
                HasSubstr("faces 0 and 1 run along edge (0, 1) the same way"));
}

TEST(Validate, NamesADuplicateFace)
{
    ClothMesh mesh = square();
    mesh.faces.push_back({1, 2, 0});
    EXPECT_FALSE(validate(mesh).empty());
}

TEST(Validate, NamesABowTie)
{
    const ClothMesh mesh = flat({{0, 0}, {1, 0}, {0, 1}, {-1, 0}, {0, -1}}, {{0, 1, 2}, {0, 3, 4}});
    EXPECT_THAT(validate(mesh), HasSubstr("vertex 0 joins parts"));
}

TEST(Validate, NamesABowTieOfAClosedAndAnOpenFan)
{
    // Vertex 0 is the middle of a fan and, from outside, the corner of another face.
    std::vector<Vec2> material = {{0, 0}};
    std::vector<Face> faces;
    for (int k = 0; k < 5; ++k) {
        material.emplace_back(std::cos(k * 1.2566), std::sin(k * 1.2566));
        faces.push_back({0, 1 + k, 1 + (k + 1) % 5});
    }
    ClothMesh mesh = flat(material, faces);
    ASSERT_EQ(validate(mesh), "");
    mesh.material.insert(mesh.material.end(), {{5, 0}, {5, 1}});
    mesh.world.insert(mesh.world.end(), {{5, 0, 0}, {5, 1, 0}});
    mesh.faces.push_back({0, 6, 7});
    EXPECT_THAT(validate(mesh), HasSubstr("vertex 0 joins parts"));
}

TEST(Validate, OrientationIsExact)
{
    // c is one unit in the last place off the line through a and b, which plain double arithmetic does not
    // resolve.
    const Vec2 a(12.0, 12.0);
    const Vec2 b(24.0, 24.0);
    const double next = std::nextafter(0.5, 1.0);
    EXPECT_EQ(validate(flat({a, b, {0.5, next}}, {{0, 1, 2}})), "");
    EXPECT_THAT(validate(flat({a, b, {next, 0.5}}, {{0, 1, 2}})), HasSubstr("face 0 is clockwise"));
    EXPECT_THAT(validate(flat({a, b, {0.5, 0.5}}, {{0, 1, 2}})), HasSubstr("face 0 has no material area"));
}

}  // namespace
}  // namespace arris
