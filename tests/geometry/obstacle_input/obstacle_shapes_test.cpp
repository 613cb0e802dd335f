// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/obstacle_shapes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <limits>
#include <numbers>

#include "geometry/input_error.h"
#include "geometry/obstacle/obstacle_topology.h"
#include "tests/app/error_of.h"

namespace arris {
namespace {

using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kRounding = 1e-13;  // for volumes of about 1

double volume(const ObstacleMesh& mesh)
{
    double six = 0.0;
    for (const auto& [a, b, c] : mesh.faces) six += mesh.points[a].dot(mesh.points[b].cross(mesh.points[c]));
    return six / 6.0;
}

Eigen::AlignedBox3d bounds(const ObstacleMesh& mesh)
{
    Eigen::AlignedBox3d box;
    for (const Vec3& p : mesh.points) box.extend(p);
    return box;
}

// Checks that the mesh is valid, closed and connected.
void expect_one_solid(const ObstacleMesh& mesh)
{
    ASSERT_EQ(validate(mesh), "");
    EXPECT_EQ(make_topology(mesh).is_solid, std::vector<char>{1});
}

TEST(BoxShape, IsACentredSolidOfItsSizes)
{
    for (const Vec3& sizes :
         {Vec3(1, 2, 3), Vec3(1e-6, 1e-6, 1e-6), Vec3(1e6, 1e-3, 1), Vec3(0.1, 0.2, 0.7)}) {
        const ObstacleMesh box = make_box(sizes);
        expect_one_solid(box);
        EXPECT_EQ(box.points.size(), 8u);
        EXPECT_EQ(box.faces.size(), 12u);
        EXPECT_EQ(bounds(box).min(), Vec3(-0.5 * sizes));
        EXPECT_EQ(bounds(box).max(), Vec3(0.5 * sizes));
        EXPECT_NEAR(volume(box) / sizes.prod(), 1.0, kRounding);
    }
}

TEST(BoxShape, NamesTheSizeThatCannotBe)
{
    EXPECT_THAT(error_of([] { make_box({0, 1, 1}); }), HasSubstr("size along x 0"));
    EXPECT_THAT(error_of([] { make_box({1, -1, 1}); }), HasSubstr("size along y -1"));
    EXPECT_THAT(error_of([] { make_box({1, 1, kNan}); }), HasSubstr("size along z nan"));
    EXPECT_THAT(error_of([] { make_box({kInf, 1, 1}); }), HasSubstr("size along x inf"));
    EXPECT_THAT(error_of([] { make_box({1, 2e6, 1}); }), HasSubstr("at most 1e+06 m"));
}

TEST(PointsShape, KeepsItsPointsInOrder)
{
    const std::vector<Vec3> points = {{3, 0, 0}, {1, 2, 3}, {0, 0, 0}};
    const ObstacleMesh mesh = make_points(points);
    EXPECT_EQ(validate(mesh), "");
    EXPECT_EQ(mesh.points, points);
    EXPECT_EQ(mesh.lone_points, (std::vector<int>{0, 1, 2}));
}

TEST(PointsShape, NamesThePointThatCannotBe)
{
    EXPECT_THAT(error_of([] { make_points({}); }), HasSubstr("at least 1"));
    EXPECT_THAT(error_of([] { make_points({{0, 0, 0}, {0, kNan, 0}}); }), HasSubstr("point 2"));
    EXPECT_THAT(error_of([] { make_points({{0, 0, 2e6}}); }), HasSubstr("point 1"));
    EXPECT_THAT(error_of([] {
                    make_points({{1, 0, 0}, {5, 0, 0}, {1, 0, 0}});
                }),
                HasSubstr("points 1 and 3 coincide"));
    EXPECT_THAT(error_of([] {
                    make_points({{0.0, 0, 0}, {-0.0, 0, 0}});
                }),
                HasSubstr("points 1 and 2 coincide"));
}

TEST(WireShape, JoinsConsecutivePoints)
{
    const std::vector<Vec3> points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
    const ObstacleMesh open = make_wire(points, false);
    EXPECT_EQ(open.segments, (std::vector<std::array<int, 2>>{{0, 1}, {1, 2}}));
    const ObstacleMesh closed = make_wire(points, true);
    EXPECT_EQ(closed.segments, (std::vector<std::array<int, 2>>{{0, 1}, {1, 2}, {2, 0}}));
    EXPECT_EQ(validate(open), "");
    EXPECT_EQ(validate(closed), "");
    EXPECT_TRUE(closed.lone_points.empty());
}

TEST(WireShape, NamesThePointsThatCannotBe)
{
    const Vec3 a(0, 0, 0), b(1, 0, 0), c(1, 1, 0);
    EXPECT_THAT(error_of([&] { make_wire({}, false); }), HasSubstr("0 points"));
    EXPECT_THAT(error_of([&] { make_wire({a}, false); }), HasSubstr("at least 2"));
    EXPECT_THAT(error_of([&] { make_wire({a, b}, true); }), HasSubstr("at least 3"));
    EXPECT_THAT(error_of([&] { make_wire({a, b, b, c}, false); }), HasSubstr("points 2 and 3"));
    EXPECT_THAT(error_of([&] { make_wire({a, b, c, a}, true); }), HasSubstr("points 4 and 1"));
    EXPECT_THAT(error_of([&] { make_wire({a, {kInf, 0, 0}}, false); }), HasSubstr("point 2"));
    // A repeated place that is not adjacent in the chain is a crossing.
    EXPECT_EQ(error_of([&] { make_wire({a, b, c, a}, false); }), "");
}

// The volume is the area of the profile, slab and teeth, times the width.
double teeth_volume(const TeethShape& t)
{
    const double half_base = t.height * std::tan(0.5 * t.tip_degrees * std::numbers::pi / 180.0);
    return t.count * (t.pitch * t.height + half_base * t.height) * t.width;
}

TEST(TeethShape, AreASolidOfRidgesOnASlab)
{
    for (const TeethShape& t : {TeethShape{1, 1.0, 0.5, 2.0, 60.0}, TeethShape{5, 0.1, 0.1, 0.6, 50.0},
                                TeethShape{3, 2.0, 1.0, 1.0, 90.0}, TeethShape{200, 1e-3, 1e-2, 1.0, 1.0},
                                TeethShape{2, 1.0, 1e-3, 1.0, 170.0}}) {
        const ObstacleMesh mesh = make_teeth(t);
        expect_one_solid(mesh);
        EXPECT_NEAR(volume(mesh) / teeth_volume(t), 1.0, kRounding);
        const Vec3 half(0.5 * t.count * t.pitch, 0.5 * t.width, t.height);
        EXPECT_EQ(bounds(mesh).min(), Vec3(-half));
        EXPECT_EQ(bounds(mesh).max(), half);
    }
}

TEST(TeethShape, TipsArePitchApartAndAsSharpAsAsked)
{
    const TeethShape t{4, 0.3, 0.2, 1.0, 40.0};
    const ObstacleMesh mesh = make_teeth(t);
    std::vector<double> tips;
    for (const Vec3& p : mesh.points)
        if (p.z() == t.height && p.y() < 0.0) tips.push_back(p.x());
    ASSERT_EQ(tips.size(), 4u);
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(tips[k], (k - 1.5) * 0.3, kRounding);

    // The flanks' normals at a tip turn by 180 degrees less the angle between the flanks.
    const ObstacleTopology topology = make_topology(mesh);
    int ridges = 0;
    for (const ObstacleEdge& edge : topology.edges) {
        const Vec3& a = mesh.points[edge.points[0]];
        const Vec3& b = mesh.points[edge.points[1]];
        if (a.z() != t.height || b.z() != t.height) continue;
        ++ridges;
        const double cosine = topology.face_normals[edge.faces[0]].dot(topology.face_normals[edge.faces[1]]);
        EXPECT_NEAR(std::acos(cosine) * 180.0 / std::numbers::pi, 140.0, 1e-9);
        EXPECT_EQ(std::abs(a.y() - b.y()), t.width);
    }
    EXPECT_EQ(ridges, 4);
}

TEST(TeethShape, ValleysOfNoWidthAreOneEdge)
{
    // 90 degrees with a pitch of twice the height: tan(45 degrees) is not exactly 1 in double precision.
    const ObstacleMesh mesh = make_teeth({3, 2.0, 1.0, 1.0, 90.0});
    expect_one_solid(mesh);
    EXPECT_EQ(mesh.points.size(), 4u * 7u);  // the ends, three tips, two valleys
}

TEST(TeethShape, SaysWhichValuesAreAllowed)
{
    const TeethShape good{3, 1.0, 0.5, 1.0, 60.0};
    const auto refusal = [&](auto change) {
        TeethShape t = good;
        change(t);
        return error_of([&] { make_teeth(t); });
    };
    EXPECT_EQ(refusal([](TeethShape&) {}), "");
    EXPECT_THAT(refusal([](TeethShape& t) { t.count = 0; }), HasSubstr("count 0 must be from 1 to 10000"));
    EXPECT_THAT(refusal([](TeethShape& t) { t.count = 10001; }), HasSubstr("count 10001"));
    EXPECT_THAT(refusal([](TeethShape& t) { t.pitch = 0; }), HasSubstr("pitch 0"));
    EXPECT_THAT(refusal([](TeethShape& t) { t.pitch = 1e6; }), HasSubstr("length"));
    EXPECT_THAT(refusal([](TeethShape& t) { t.height = kNan; }), HasSubstr("height nan"));
    EXPECT_THAT(refusal([](TeethShape& t) { t.width = -1; }), HasSubstr("width -1"));
    EXPECT_THAT(refusal([](TeethShape& t) { t.tip_degrees = 0; }), HasSubstr("tip_degrees 0"));
    EXPECT_THAT(refusal([](TeethShape& t) { t.tip_degrees = 180; }), HasSubstr("tip_degrees 180"));
    EXPECT_THAT(refusal([](TeethShape& t) { t.tip_degrees = kNan; }), HasSubstr("tip_degrees nan"));
    // 2 * 0.5 * tan(50 degrees) = 1.1918 > 1; tan(a / 2) = 1 allows 90 degrees.
    EXPECT_THAT(
        refusal([](TeethShape& t) { t.tip_degrees = 100; }),
        ::testing::AllOf(HasSubstr("pitch of at least 1.19175 m"), HasSubstr("tip_degrees of at most 90")));
}

}  // namespace
}  // namespace arris
