// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "geometry/contact/obstacle_contact.h"
#include "geometry/obstacle/normal_cone.h"
#include "tests/geometry/contact_scene.h"
#include "tests/geometry/sample_obstacles.h"

namespace arris {
namespace {

constexpr double kThickness = 1e-3;
constexpr double kRounding = 1e-10;  // for unit directions from differences of 1e-3 of coordinates near 1
constexpr double kTouch = 1e-5;      // for directions at a touch, found to 1e-6 of the motion

std::vector<ObstacleContact> contacts_of(const Obstacle& obstacle, const std::vector<Vec3>& begin,
                                         const std::vector<Vec3>& end, const std::vector<Face>& faces)
{
    const samples::ClothWay cloth(begin, end, faces);
    return find_face_contacts(obstacle, cloth.motion, cloth.motion.end, kThickness);
}

// One triangle around the origin, at the given height.
std::vector<Vec3> flat(double height)
{
    return {{-0.05, -0.04, height}, {0.05, -0.04, height}, {0.0, 0.06, height}};
}

// Two triangles with the common edge (0, 1) along x over the origin. `rise` is the height of the outer
// vertices.
std::vector<Vec3> ridge(double height, double rise)
{
    return {{-0.05, 0, height}, {0.05, 0, height}, {0, 0.05, height + rise}, {0, -0.05, height + rise}};
}
const std::vector<Face> kRidge = {{0, 1, 2}, {1, 0, 3}};

Obstacle nail(const Vec3& at = Vec3::Zero())
{
    return samples::make_obstacle(samples::nails({at}));
}

TEST(FaceContact, NailUnderAFaceIsThePlaneOfTheCloth)
{
    for (const double side : {1.0, -1.0}) {
        const auto contacts =
            contacts_of(nail(), flat(side * kThickness), flat(side * kThickness), {{0, 1, 2}});
        ASSERT_EQ(contacts.size(), 1U);
        const ObstacleContact& c = contacts[0];
        EXPECT_EQ(c.kind, ContactKind::Triangle);
        EXPECT_EQ(c.vertices, (std::array<int, 3>{0, 1, 2}));
        EXPECT_EQ(c.element, 0);
        EXPECT_LT((c.normal - side * Vec3::UnitZ()).norm(), kRounding);
        EXPECT_NEAR(c.weights[0] + c.weights[1] + c.weights[2], 1.0, kRounding);
        EXPECT_NEAR(c.least_gap, kThickness, kRounding);
    }
    EXPECT_TRUE(contacts_of(nail(), flat(0.01), flat(0.01), {{0, 1, 2}}).empty());
    EXPECT_TRUE(contacts_of(nail({0.2, 0, 0}), flat(1e-3), flat(1e-3), {{0, 1, 2}}).empty());
}

TEST(FaceContact, VerticesAscendAndKeepTheirWeights)
{
    const std::vector<Vec3> p = flat(kThickness);
    const Obstacle point = nail({0.01, 0.02, 0});
    const auto contacts = contacts_of(point, {p[2], p[0], p[1]}, {p[2], p[0], p[1]}, {{1, 2, 0}});
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_EQ(contacts[0].vertices, (std::array<int, 3>{0, 1, 2}));
    const Vec3 place =
        contacts[0].weights[0] * p[2] + contacts[0].weights[1] * p[0] + contacts[0].weights[2] * p[1];
    EXPECT_LT((place - Vec3(0.01, 0.02, kThickness)).norm(), kRounding);
}

TEST(FaceContact, NailTunnelledIsHeldOnTheSideWhereItWas)
{
    for (const double side : {1.0, -1.0}) {
        for (const double speed : {0.1, 10.0}) {
            auto end = flat(-side * speed);
            end[0].z() -= 0.4 * side * speed;
            const auto contacts = contacts_of(nail(), flat(side * 0.05), end, {{0, 1, 2}});
            ASSERT_EQ(contacts.size(), 1U);
            EXPECT_GT(samples::gap_of(contacts[0], flat(side * 0.05)), 0.0);
            EXPECT_LT(samples::gap_of(contacts[0], end), 0.0);
            EXPECT_GT(side * contacts[0].normal.z(), 0.3);
            EXPECT_NEAR(contacts[0].least_gap, kThickness, kRounding);
        }
    }
}

TEST(FaceContact, UnderAnEdgeBetweenFacesIsOneContactOfTheEdge)
{
    for (const double rise : {0.0, 0.02}) {  // flat cloth, and a fold that points to the nail
        const auto contacts = contacts_of(nail(), ridge(kThickness, rise), ridge(kThickness, rise), kRidge);
        ASSERT_EQ(contacts.size(), 1U) << rise;
        EXPECT_EQ(contacts[0].vertices, (std::array<int, 3>{0, 1, -1}));
        EXPECT_LT((contacts[0].normal - Vec3::UnitZ()).norm(), kRounding);
    }
    for (const double rise : {0.0, 0.02, -0.02}) {  // also a tent that falls on the nail
        const auto touched = contacts_of(nail(), ridge(0.02, rise), ridge(-0.02, rise), kRidge);
        ASSERT_EQ(touched.size(), 1U) << rise;
        EXPECT_EQ(touched[0].vertices, (std::array<int, 3>{0, 1, -1}));
        EXPECT_LT((touched[0].normal - Vec3::UnitZ()).norm(), kTouch);
    }
    // Within a fold the nail is nearer to both faces than to the edge.
    const auto valley = contacts_of(nail(), ridge(-2e-3, 0.05), ridge(-2e-3, 0.05), kRidge);
    EXPECT_EQ(valley.size(), 2U);
}

TEST(FaceContact, AcrossAFoldNothingIsLost)
{
    // A nail under a ridge of cloth is moved sideways in small steps: there is always one plane, at most two.
    for (const double rise : {0.0, -0.001, -0.03}) {
        for (int k = -200; k <= 200; ++k) {
            const Obstacle point = nail({0.003, k * 1e-5, 0});
            const auto cloth = ridge(kThickness, rise);
            const auto contacts = contacts_of(point, cloth, cloth, kRidge);
            const Vec3 direction = (k == 0 ? 0.0 : k > 0 ? 1.0 : -1.0) * Vec3::UnitY();
            const double out = rise < 0.0 ? direction.dot(Vec3(0, k * 1e-5, 0)) * -rise / 0.05 : 0.0;
            if (out > 0.8 * kThickness) continue;  // the nail is through the cloth there
            ASSERT_GE(contacts.size(), 1U) << rise << " " << k;
            EXPECT_LE(contacts.size(), 2U);
            for (const auto& c : contacts) EXPECT_GT(c.normal.z(), 0.8);
        }
    }
}

TEST(FaceContact, BesideTheBorderPushesAlongTheCloth)
{
    // The border (0, 1) of the triangle faces -y.
    const Obstacle point = nail({0, -0.041, 0});
    const auto rest = contacts_of(point, flat(0), flat(0), {{0, 1, 2}});
    ASSERT_EQ(rest.size(), 1U);
    EXPECT_LT((rest[0].normal - Vec3::UnitY()).norm(), kRounding);
    EXPECT_EQ(rest[0].vertices, (std::array<int, 3>{0, 1, -1}));
    // The border is pushed onto the nail in the cloth's plane.
    const Obstacle before = nail({0, -0.05, 0});
    const auto pushed = contacts_of(before, flat(0), samples::shifted(flat(0), {0, -0.03, 0}), {{0, 1, 2}});
    ASSERT_EQ(pushed.size(), 1U);
    EXPECT_LT((pushed[0].normal - Vec3::UnitY()).norm(), kTouch);
    EXPECT_NEAR(pushed[0].least_gap, kThickness, kRounding);
}

TEST(FaceContact, AtAClothVertexIsTheVertexMatter)
{
    EXPECT_TRUE(contacts_of(nail({0.0, 0.0605, 0}), flat(5e-4), flat(5e-4), {{0, 1, 2}}).empty());
    EXPECT_TRUE(contacts_of(nail({0.0, 0.06, 0}), flat(0.02), flat(-0.02), {{0, 1, 2}}).empty());
}

TEST(FaceContact, CornerOfABoxUnderACloth)
{
    const Obstacle box = samples::make_obstacle(samples::box({-1, -1, -1}, {0, 0, 0}));
    // The cloth is draped over the corner.
    const std::vector<Vec3> cloth = {{-0.05, -0.05, 0.02}, {0.05, -0.03, -0.03}, {-0.02, 0.06, -0.03}};
    auto above = samples::shifted(cloth, {0.01, 0.01, 0.012});
    const auto contacts = contacts_of(box, above, above, {{0, 1, 2}});
    const Vec3 normal = (cloth[1] - cloth[0]).cross(cloth[2] - cloth[0]).normalized();
    ASSERT_LE(contacts.size(), 1U);
    const double height = normal.dot(above[0]);
    const auto near = samples::shifted(above, -(height - kThickness) * normal);
    const auto resting = contacts_of(box, near, near, {{0, 1, 2}});
    ASSERT_EQ(resting.size(), 1U);
    EXPECT_LT((resting[0].normal - normal).norm(), kRounding);
    // Cloth lies flat on the top beyond the corner: the plane is the top's.
    std::vector<Vec3> level = {{-0.05, -0.05, 1e-3}, {0.05, -0.03, 1e-3}, {-0.02, 0.06, 1e-3}};
    ASSERT_EQ(contacts_of(box, level, level, {{0, 1, 2}}).size(), 1U);
    // For upright cloth across the corner's inner side, the distance has no minimum at the corner.
    const std::vector<Vec3> upright = {{0.001, -0.05, -0.05}, {0.001, 0.05, -0.05}, {-0.001, 0.0, 0.05}};
    for (const auto& c : contacts_of(box, upright, upright, {{0, 1, 2}})) EXPECT_GT(c.normal.x(), 0.9);
}

TEST(FaceContact, NodeOfAnArchedWireCarriesAFace)
{
    // An arch with bends of 10 degrees has no corners except its ends. One node is on top.
    std::vector<Vec3> arch;
    for (int k = 0; k <= 18; ++k)
        arch.push_back({0.1 * std::cos(k * M_PI / 18), 0, 0.1 * std::sin(k * M_PI / 18)});
    const Obstacle wire = samples::make_obstacle(samples::wire(arch, false));
    const auto resting = flat(0.1 + kThickness), falling = flat(0.12), fallen = flat(0.08);
    for (const auto& contacts : {contacts_of(wire, resting, resting, {{0, 1, 2}}),
                                 contacts_of(wire, falling, fallen, {{0, 1, 2}})}) {
        ASSERT_EQ(contacts.size(), 1U);
        EXPECT_EQ(contacts[0].element, 9);
        EXPECT_LT((contacts[0].normal - Vec3::UnitZ()).norm(), kTouch);
    }
    // On a level round rim, cloth is carried by contacts of vertices and edges alone.
    const Obstacle table = samples::make_obstacle(samples::cylinder(64));
    const std::vector<Vec3> level = samples::shifted(flat(1.0 + kThickness), {1, 0, 0});
    EXPECT_TRUE(contacts_of(table, level, level, {{0, 1, 2}}).empty());
}

TEST(FaceContact, CornerBehindAThinWallIsNone)
{
    const Obstacle hollow = samples::make_obstacle(
        samples::together(samples::box({-1, -1, -1}, {0, 0, 0}),
                          samples::inside_out(samples::box(Vec3::Constant(-0.9999), Vec3::Constant(-1e-4)))));
    const Vec3 normal = Vec3(1, 1, 1).normalized(), u = Vec3(1, -1, 0).normalized(), v = normal.cross(u);
    const Vec3 foot = 5e-4 * normal;
    const std::vector<Vec3> cloth = {foot - 0.05 * u - 0.04 * v, foot + 0.05 * u - 0.04 * v, foot + 0.06 * v};
    const auto contacts = contacts_of(hollow, cloth, cloth, {{0, 1, 2}});
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_LT(contacts[0].point.norm(), kRounding);
    // The result holds for every point of the obstacle.
    const samples::ClothWay way(cloth, cloth, {{0, 1, 2}});
    int count = 0;
    for (int p = 0; p < static_cast<int>(hollow.mesh().points.size()); ++p)
        if (make_face_contact(hollow, way.motion, cloth, 0, p, kThickness)) ++count;
    EXPECT_EQ(count, 1);
}

TEST(FaceContact, FlatOnANailWithoutASideIsNone)
{
    EXPECT_TRUE(contacts_of(nail(), flat(0.0), flat(0.0), {{0, 1, 2}}).empty());
    const std::vector<Vec3> line = {{-1, 0, 1e-3}, {1, 0, 1e-3}, {0, 0, 1e-3}};  // a face without area
    for (const auto& c : contacts_of(nail(), line, line, {{0, 1, 2}})) EXPECT_TRUE(c.normal.allFinite());
}

TEST(FaceContact, PlaneBehindWhichItBeganIsNone)
{
    // The cloth moves from above to below, beside the nail.
    const auto below = flat(-1e-3);
    EXPECT_TRUE(contacts_of(nail(), samples::shifted(flat(1e-3), {0.5, 0, 0}), below, {{0, 1, 2}}).empty());
    EXPECT_EQ(contacts_of(nail(), samples::shifted(flat(-1e-3), {0.5, 0, 0}), below, {{0, 1, 2}}).size(), 1U);
}

TEST(FaceContact, SideIsKnownFromTheBeginWhereTheEndLiesOnThePoint)
{
    for (const double side : {1.0, -1.0}) {
        const auto contacts = contacts_of(nail(), flat(side * 0.01), flat(side * 1e-10), {{0, 1, 2}});
        ASSERT_EQ(contacts.size(), 1U);
        EXPECT_LT((contacts[0].normal - side * Vec3::UnitZ()).norm(), kTouch);
    }
}

// Comparison with brute force. An obstacle point has a plane if its nearest point on the whole cloth is
// within reach and is no vertex.
void expect_all_points(double size, const Vec3& far, double tolerance)
{
    const double thickness = 0.01 * size;
    std::mt19937 engine(23);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    std::vector<Vec3> cloth = samples::grid_points(6, 6, {-0.3, -0.3, 0}, {0.1, 0, 0}, {0, 0.1, 0});
    for (Vec3& p : cloth)
        p = far + size * (p + 0.03 * Vec3(uniform(engine), uniform(engine), uniform(engine)));
    const samples::ClothWay way(cloth, cloth, samples::grid_faces(6, 6));
    const ObstacleMesh surface{cloth, way.faces, {}, {}};
    int expected_count = 0;
    for (int k = 0; k < 2000; ++k) {
        const Vec3 place =
            far + size * Vec3(0.32 * uniform(engine), 0.32 * uniform(engine), 0.05 * uniform(engine));
        const Vec3 nearest = samples::nearest_point(surface, place);
        const double distance = (nearest - place).norm();
        if (distance > 2.99 * thickness || distance < 0.01 * thickness) continue;
        const bool is_vertex = std::any_of(cloth.begin(), cloth.end(),
                                           [&](const Vec3& p) { return (p - nearest).norm() < 1e-3 * size; });
        if (is_vertex) continue;
        ++expected_count;
        const Obstacle point = nail(place);
        const auto contacts = find_face_contacts(point, way.motion, cloth, thickness);
        EXPECT_TRUE(std::any_of(contacts.begin(), contacts.end(), [&](const ObstacleContact& c) {
            return std::abs(samples::gap_of(c, cloth) - distance) < tolerance * size &&
                   (c.normal - (nearest - place).normalized()).norm() < std::sqrt(tolerance);
        })) << k;
        for (const ObstacleContact& c : contacts) {
            Vec3 on_cloth = Vec3::Zero();
            for (int i = 0; i < 3; ++i)
                if (c.vertices[i] >= 0) on_cloth += c.weights[i] * (cloth[c.vertices[i]] - far);
            EXPECT_TRUE(samples::is_local_minimum(surface, on_cloth + far, place, 1e-3)) << k;
        }
    }
    EXPECT_GT(expected_count, 300);
}

TEST(FaceContact, AgreesWithBruteForce)
{
    expect_all_points(1.0, Vec3::Zero(), 1e-9);
    expect_all_points(1e-6, Vec3::Zero(), 1e-9);
    expect_all_points(1e6, Vec3::Zero(), 1e-9);
    expect_all_points(1.0, {1e6, -1e6, 1e6}, 1e-7);
}

TEST(FaceContact, SortedAndTheSameForAnyNumberOfThreads)
{
    std::vector<Vec3> places;
    for (int i = 0; i < 30; ++i)
        for (int j = 0; j < 30; ++j) places.push_back({0.033 * i, 0.033 * j, 0.0});
    const Obstacle nails = samples::make_obstacle(samples::nails(places));
    const std::vector<Vec3> begin = samples::grid_points(40, 40, {0, 0, 0.01}, {0.025, 0, 0}, {0, 0.025, 0});
    const samples::ClothWay cloth(begin, samples::shifted(begin, {0.001, 0, -0.02}),
                                  samples::grid_faces(40, 40));
    const auto key = [](const ObstacleContact& c) { return std::tuple(c.vertices, c.element); };
    const auto same = [&](const ObstacleContact& a, const ObstacleContact& b) {
        return key(a) == key(b) && a.normal == b.normal && a.weights == b.weights &&
               a.least_gap == b.least_gap;
    };
    const auto expected = find_face_contacts(nails, cloth.motion, cloth.motion.end, kThickness);
    EXPECT_GT(expected.size(), 800U);
    EXPECT_TRUE(std::is_sorted(expected.begin(), expected.end(),
                               [&](const auto& a, const auto& b) { return key(a) < key(b); }));
    for (const int threads : {1, 2, 4}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const auto contacts = find_face_contacts(nails, cloth.motion, cloth.motion.end, kThickness);
        EXPECT_TRUE(std::equal(contacts.begin(), contacts.end(), expected.begin(), expected.end(), same));
    }
}

// A face slides over a box's corner, and a part of the face sinks into the box meanwhile. The plane of the
// face then points into the box.
TEST(FaceContact, WhatRunsThroughAFaceOnItsWayStaysOutside)
{
    const Obstacle box = samples::make_obstacle(samples::box({0, 0, 0}, {1, 1, 1}));
    const auto contacts = contacts_of(
        box, {{-.00018, .98709, .00117}, {-.00763, .99944, .02346}, {-.00126, 1.06597, .03586}},
        {{.00162, 1.00432, -.01711}, {-.00059, 1.02205, -.00009}, {.00195, 1.08358, .01322}}, {{0, 1, 2}});
    ASSERT_FALSE(contacts.empty());
    for (const ObstacleContact& c : contacts) {
        EXPECT_TRUE(is_in_point_cone(box, c.element, c.normal)) << c.normal.transpose();
        EXPECT_GE(c.least_gap, 0.0);
    }
}

}  // namespace
}  // namespace arris
