// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "geometry/contact/obstacle_contact.h"
#include "tests/geometry/contact_scene.h"
#include "tests/geometry/sample_obstacles.h"

namespace arris {
namespace {

constexpr double kThickness = 1e-3;
constexpr double kRounding = 1e-10;  // for unit directions from differences of 1e-3 of coordinates near 1
constexpr double kTouch = 1e-5;      // for directions at a touch, found to 1e-6 of the motion

using Segment = std::array<Vec3, 2>;

// Contacts of the edge (0, 1) of a triangle whose third vertex is far above.
std::vector<ObstacleContact> contacts_of(const Obstacle& obstacle, const Segment& begin, const Segment& end,
                                         const Vec3& third = Vec3(0.5, 0.5, 50))
{
    const samples::ClothWay cloth({begin[0], begin[1], third}, {end[0], end[1], third}, {{0, 1, 2}});
    std::vector<ObstacleContact> contacts =
        find_edge_contacts(obstacle, cloth.motion, cloth.motion.end, kThickness);
    std::erase_if(contacts, [](const ObstacleContact& c) { return c.vertices[1] != 1; });
    return contacts;
}

std::vector<ObstacleContact> contacts_of(const Obstacle& obstacle, const Segment& edge)
{
    return contacts_of(obstacle, edge, edge);
}

const Obstacle& unit_box()
{
    static const Obstacle box = samples::make_obstacle(samples::box({0, 0, 0}, {1, 1, 1}));
    return box;
}

TEST(EdgeContact, ClothThatSlidesOverAWireUnderItsStandOffStaysAsFarAsItWas)
{
    // Sloping cloth slides down over the wire. The material point that ends above the wire began far beside
    // the wire.
    const Obstacle wire = samples::make_obstacle(samples::wire({{0, -1, 0}, {0, 1, 0}}, false));
    const Vec3 along = Vec3(1, 0, -0.5).normalized(), across = Vec3(0.5, 0, 1).normalized();
    for (const double share : {0.2, 0.9}) {
        const Vec3 above = share * kThickness * across;
        const Segment begin = {above - 0.1 * along, above + 0.1 * along};
        const Vec3 way = 0.03 * along + kThickness * across;
        const auto contacts = contacts_of(wire, begin, {begin[0] + way, begin[1] + way});
        ASSERT_EQ(contacts.size(), 1U);
        EXPECT_NEAR(contacts[0].least_gap, share * kThickness, kRounding);
    }
}

TEST(EdgeContact, AcrossARimIsAPlaneAlongBothEdges)
{
    for (const double tilt : {-0.3, -0.1, 0.0}) {  // slope beyond the rim x = 1
        const Segment edge = {Vec3(0.9, 0.5, 1.001 - 0.1 * tilt), Vec3(1.1, 0.53, 1.001 + 0.1 * tilt)};
        const auto contacts = contacts_of(unit_box(), edge);
        ASSERT_EQ(contacts.size(), 1U) << tilt;
        const ObstacleContact& c = contacts[0];
        EXPECT_EQ(c.kind, ContactKind::Edge);
        EXPECT_EQ(c.vertices, (std::array<int, 3>{0, 1, -1}));
        EXPECT_NEAR(c.weights[0] + c.weights[1], 1.0, kRounding);
        EXPECT_NEAR(c.normal.dot((edge[1] - edge[0]).normalized()), 0.0, kRounding);
        EXPECT_NEAR(c.normal.y(), 0.0, kRounding);
        EXPECT_GT(c.normal.z(), 0.9);
        EXPECT_NEAR(c.point.x(), 1.0, kRounding);
        EXPECT_NEAR(c.point.z(), 1.0, kRounding);
        EXPECT_NEAR(c.least_gap, samples::gap_of(c, {edge[0], edge[1]}), kRounding);
    }
}

TEST(EdgeContact, BentUpBeyondTheRimIsTheVerticesMatter)
{
    EXPECT_TRUE(contacts_of(unit_box(), {Vec3(0.9, 0.5, 1.001), Vec3(1.1, 0.5, 1.1)}).empty());
}

TEST(EdgeContact, FarEndsAndParallelEdgesAreNone)
{
    EXPECT_TRUE(contacts_of(unit_box(), {Vec3(0.9, 0.5, 1.01), Vec3(1.1, 0.5, 1.01)}).empty());
    EXPECT_TRUE(contacts_of(unit_box(), {Vec3(1.001, 0.5, 1.001), Vec3(1.1, 0.53, 1.3)}).empty());  // its end
    EXPECT_TRUE(contacts_of(unit_box(), {Vec3(1, 0.2, 1.001), Vec3(1.001, 0.8, 1.001)}).empty());
    EXPECT_TRUE(contacts_of(unit_box(), {Vec3(0.5, 0.5, 1.001), Vec3(0.6, 0.7, 1.001)}).empty());  // no rim
    // The top's rim at angles of 0.2 and 2 degrees to the cloth edge.
    EXPECT_TRUE(contacts_of(unit_box(), {Vec3(0.999, 0.2, 1.001), Vec3(1.001, 0.8, 1.001)}).empty());
    EXPECT_EQ(contacts_of(unit_box(), {Vec3(0.995, 0.2, 1.001), Vec3(1.005, 0.5, 1.001)}).size(), 1U);
}

TEST(EdgeContact, TouchOnTheWayPointsToWhereTheClothWas)
{
    // Two vertices on either side of the box's edge fall past that edge.
    const Segment begin = {Vec3(0.8, 0.5, 1.05), Vec3(1.2, 0.5, 1.05)};
    const Segment end = {Vec3(0.8, 0.5, 1.01), Vec3(1.2, 0.5, 0.6)};
    const auto contacts = contacts_of(unit_box(), begin, end);
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_GT(samples::gap_of(contacts[0], {begin[0], begin[1]}), 0.0);
    EXPECT_LT(samples::gap_of(contacts[0], {end[0], end[1]}), 0.0);
    EXPECT_NEAR(contacts[0].least_gap, kThickness, kRounding);
    EXPECT_GE(contacts[0].normal.x(), 0.0);
    EXPECT_GT(contacts[0].normal.z(), 0.7);
}

// A cloth edge that slides over the box's top and sinks into it meets the box's edge from inside. A normal
// from that meeting would hold the cloth under the edge, against the full weight of the sliding cloth.
TEST(EdgeContact, WhatRunsThroughAFaceOnItsWayStaysOutside)
{
    const Segment begin = {Vec3(0.935, 0.53, 1.012), Vec3(0.9945, 0.51, 1.0002)};
    const Segment end = {Vec3(0.954, 0.532, 1.011), Vec3(1.0135, 0.512, 0.999)};
    for (const bool is_swapped : {false, true}) {
        const auto contacts = is_swapped ? contacts_of(unit_box(), {begin[1], begin[0]}, {end[1], end[0]})
                                         : contacts_of(unit_box(), begin, end);
        ASSERT_EQ(contacts.size(), 1U);
        EXPECT_GT(contacts[0].normal.z(), 0.9);
        EXPECT_GE(samples::gap_of(contacts[0], is_swapped ? std::vector<Vec3>{begin[1], begin[0]}
                                                          : std::vector<Vec3>{begin[0], begin[1]}),
                  0.0);
    }
}

TEST(EdgeContact, WireTunnelledFromAnySideIsHeldOnThatSide)
{
    const Obstacle wire = samples::make_obstacle(samples::wire({{0, -1, 0}, {0, 1, 0}}, false));
    for (int k = 0; k < 24; ++k) {
        const double a = k * M_PI / 12.0;
        const Vec3 from(std::cos(a), 0, std::sin(a)), along(-std::sin(a), 0.3, std::cos(a));
        const Segment begin = {Vec3(0.05 * from - along), Vec3(0.05 * from + along)};
        const Segment end = {Vec3(-0.04 * from - along), Vec3(-0.05 * from + along)};
        for (const bool is_swapped : {false, true}) {
            const auto contacts = is_swapped ? contacts_of(wire, {begin[1], begin[0]}, {end[1], end[0]})
                                             : contacts_of(wire, begin, end);
            ASSERT_EQ(contacts.size(), 1U);
            EXPECT_LT((contacts[0].normal - from).norm(), 0.03);  // the cloth edge turns a little
            EXPECT_NEAR(contacts[0].least_gap, kThickness, kRounding);
        }
    }
}

TEST(EdgeContact, WireIsSeenFromAllAroundAtRest)
{
    const Obstacle wire = samples::make_obstacle(samples::wire({{0, -1, 0}, {0, 1, 0}}, false));
    for (int k = 0; k < 24; ++k) {
        const double a = k * M_PI / 12.0;
        const Vec3 from(std::cos(a), 0, std::sin(a)), along(-std::sin(a), 0.3, std::cos(a));
        for (const double distance : {1e-3, 1e-5}) {
            const Segment edge = {Vec3(distance * from - along), Vec3(distance * from + along)};
            const auto contacts = contacts_of(wire, edge);
            ASSERT_EQ(contacts.size(), 1U);
            EXPECT_LT((contacts[0].normal - from).norm(), kRounding);
            EXPECT_NEAR(contacts[0].least_gap, distance, kRounding);
        }
    }
}

TEST(EdgeContact, BorderOfASheetIsHeldOnTheSideOfTheCloth)
{
    const Obstacle sheet = samples::make_obstacle(samples::sheet(1, 1, [](int, int) { return 0.0; }));
    for (const double side : {1.0, -1.0}) {
        const Segment begin = {Vec3(-0.3, 0.5, 0.05 * side), Vec3(0.3, 0.55, 0.05 * side)};
        const Segment end = {Vec3(-0.3, 0.5, -0.15 * side), Vec3(0.3, 0.55, 0.02 * side)};
        const auto contacts = contacts_of(sheet, begin, end);
        ASSERT_EQ(contacts.size(), 1U);
        EXPECT_GT(side * contacts[0].normal.z(), 0.7);
        EXPECT_LE(contacts[0].normal.x(), 0.0);  // in the border's cone
        EXPECT_NEAR(contacts[0].least_gap, kThickness, kRounding);
    }
}

// A polyline's node between two segments, approached from outside, belongs to one of the two. From every
// direction there is at least one plane, and no plane twice.
TEST(EdgeContact, NodeOfAPolylineIsNeitherLostNorDoubled)
{
    for (const int sides : {16, 100}) {
        std::vector<Vec3> circle;
        for (int k = 0; k < sides; ++k) {
            const double a = 2.0 * M_PI * k / sides;
            circle.push_back({std::cos(a), std::sin(a), 0});
        }
        const Obstacle loop = samples::make_obstacle(samples::wire(circle, true));
        for (int k = 0; k < 400; ++k) {
            const double a = 2.0 * M_PI * k / 400;
            const Vec3 radial(std::cos(a), std::sin(a), 0);
            const Vec3 tangent = (Vec3(-std::sin(a), std::cos(a), 0.2)).normalized();
            const Vec3 foot = samples::nearest_point(loop.mesh(), 2.0 * radial);
            const Vec3 middle = foot + kThickness * radial;
            const auto contacts =
                contacts_of(loop, {Vec3(middle - 0.1 * tangent), Vec3(middle + 0.1 * tangent)});
            ASSERT_EQ(contacts.size(), 1U) << sides << " " << k;
            EXPECT_GT(contacts[0].normal.dot(radial), 0.5);
            const Vec3 at = middle + (2.0 * contacts[0].weights[1] - 1.0) * 0.1 * tangent;
            EXPECT_TRUE(samples::is_local_minimum(loop.mesh(), contacts[0].point, at, 1e-6));
        }
    }
}

TEST(EdgeContact, ClosedLoopIsMetInTwoPlacesAtOnce)
{
    const Obstacle rim = samples::make_obstacle(samples::cylinder(64), 30.0);
    // Cloth across the upper rim, resting on the rim and falling onto it.
    const auto resting = contacts_of(rim, {Vec3(-1.5, 0.31, 1.001), Vec3(1.5, 0.32, 1.001)});
    ASSERT_EQ(resting.size(), 2U);
    const auto falling = contacts_of(rim, {Vec3(-1.5, 0.31, 1.03), Vec3(1.5, 0.32, 1.03)},
                                     {Vec3(-1.5, 0.31, 0.97), Vec3(1.5, 0.32, 0.97)});
    ASSERT_EQ(falling.size(), 2U);
    for (const auto& c : {resting[0], resting[1], falling[0], falling[1]}) EXPECT_GT(c.normal.z(), 0.9);
}

TEST(EdgeContact, OfTouchesAlongAFinePolylineTheFirstCounts)
{
    std::vector<Vec3> arc;
    for (int k = 0; k <= 200; ++k) arc.push_back({std::cos(k * M_PI / 200), std::sin(k * M_PI / 200), 0});
    const Obstacle wire = samples::make_obstacle(samples::wire(arc, false));
    // An edge in the arc's plane is pushed into the arc from outside and meets some seventy segments.
    const Segment begin = {Vec3(-0.8, 1.05, 0), Vec3(0.8, 1.051, 0)},
                  end = {Vec3(-0.8, 0.85, 0), Vec3(0.8, 0.851, 0)};
    const auto contacts = contacts_of(wire, begin, end);
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_GT(contacts[0].normal.y(), 0.99);
    EXPECT_NEAR(contacts[0].least_gap, kThickness, kRounding);
}

TEST(EdgeContact, EdgesInOnePlaneAreHeldApartWithinIt)
{
    // An edge in an octagon's plane meets one of its nodes head-on.
    std::vector<Vec3> octagon;
    for (int k = 0; k < 8; ++k) octagon.push_back({std::cos(k * M_PI / 4), std::sin(k * M_PI / 4), 0});
    const Obstacle loop = samples::make_obstacle(samples::wire(octagon, true), 50.0);
    const auto contacts =
        contacts_of(loop, {Vec3(1.05, -0.3, 0), Vec3(1.05, 0.4, 0)}, {Vec3(0.9, -0.3, 0), Vec3(0.9, 0.4, 0)});
    ASSERT_GE(contacts.size(), 1U);
    for (const auto& c : contacts) EXPECT_LT((c.normal - Vec3::UnitX()).norm(), kTouch);
}

TEST(EdgeContact, StraightNodesAreNoPlaceForAParallelEdge)
{
    const Obstacle wire = samples::make_obstacle(samples::wire({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, false));
    for (const double tilt : {-1e-5, 0.0, 1e-5})
        EXPECT_TRUE(contacts_of(wire, {Vec3(-1, 0, 1e-3 - tilt), Vec3(3, 0, 1e-3 + 3 * tilt)}).empty())
            << tilt;
}

TEST(EdgeContact, TouchAtAnEndIsTheVertexMatter)
{
    const Obstacle wire = samples::make_obstacle(samples::wire({{0, -1, 0}, {0, 1, 0}}, false));
    EXPECT_TRUE(contacts_of(wire, {Vec3(0, 0.1, 0.05), Vec3(0.3, 0.2, 0.08)},
                            {Vec3(0, 0.1, -0.05), Vec3(0.3, 0.2, 0.02)})
                    .empty());
}

// For a random sweep, the edge begins on the free side of every plane. Nearly every normal is in the cone of
// the two faces' normals, even if the edge met other edges first.
TEST(EdgeContact, SweptPlanesHaveTheBeginInFrontAndNormalsInTheCone)
{
    std::mt19937 engine(29);
    std::uniform_real_distribution<double> uniform(-1.0, 2.0);
    const auto anywhere = [&] { return Vec3(uniform(engine), uniform(engine), uniform(engine)); };
    std::vector<int> found;
    int count = 0, outside = 0;
    for (int k = 0; k < 3000; ++k) {
        const Segment begin = {anywhere(), anywhere()}, end = {anywhere(), anywhere()};
        unit_box().find_faces_touching(begin[0], begin[1], found);
        if (!found.empty()) continue;
        for (const ObstacleContact& c : contacts_of(unit_box(), begin, end)) {
            ++count;
            EXPECT_GE(samples::gap_of(c, {begin[0], begin[1]}), -1e-5);
            const ObstacleEdge& edge = unit_box().topology().edges[c.element];
            for (const int f : edge.faces)
                if (c.normal.dot(unit_box().topology().face_normals[f]) < -1e-5) ++outside;
        }
    }
    EXPECT_GT(count, 500);
    EXPECT_LT(outside, count / 2);  // each normal is tested against two faces
}

TEST(EdgeContact, CornersOfPolylinesAreTheFacesMatter)
{
    // The edge is outside, beside the box's corner, which is the nearest point.
    const Vec3 corner = Vec3(1, 1, 1) + kThickness * Vec3(1, 1, 1).normalized();
    const Vec3 along = Vec3(1, -1, 0).normalized();
    EXPECT_TRUE(contacts_of(unit_box(), {Vec3(corner - 0.1 * along), Vec3(corner + 0.1 * along)}).empty());
}

TEST(EdgeContact, ReflexEdgesAndThinWallsAreNone)
{
    const Obstacle l = samples::make_obstacle(samples::l_prism());
    const Obstacle plate = samples::make_obstacle(samples::box({0, 0, 0}, {1, 1, 1e-4}));
    // The edge is across both rims of the plate, but only the upper rim is near on the free side.
    const auto contacts = contacts_of(plate, {Vec3(0.9, 0.5, 1.1e-3), Vec3(1.1, 0.5, 0.9e-3)});
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_NEAR(contacts[0].point.z(), 1e-4, kRounding);
    for (const FeatureEdge& f : l.features().edges) EXPECT_EQ(f.kind, FeatureKind::Convex);
    // The inner ridge of a roof 0.1 mm thick, approached from above, for every edge of the roof.
    const double t = 1e-4 * std::sqrt(2.0);
    const Obstacle roof = samples::make_obstacle(
        samples::moved(samples::prism({{-1, -1}, {0, 0}, {1, -1}, {1, -1 + t}, {0, t}, {-1, -1 + t}},
                                      {0.0, 1.0}, {{0, 1, 4}, {0, 4, 5}, {1, 2, 3}, {1, 3, 4}}),
                       [](const Vec3& p) { return Vec3(p.x(), -p.z(), p.y()); }));
    const Segment across = {Vec3(-0.1, -0.52, t + 8e-4), Vec3(0.1, -0.5, t + 8e-4)};
    const samples::ClothWay cloth({across[0], across[1], {0, 0, 9}}, {across[0], across[1], {0, 0, 9}},
                                  {{0, 1, 2}});
    int count = 0;
    for (int e = 0; e < static_cast<int>(roof.topology().edges.size()); ++e) {
        const auto contact = make_edge_contact(roof, cloth.motion, cloth.motion.end, {0, 1}, e, kThickness);
        if (!contact) continue;
        ++count;
        EXPECT_NEAR(contact->point.z(), t, kRounding);
    }
    EXPECT_EQ(count, 1);
}

TEST(EdgeContact, PairWithoutSideOrDegenerateIsNone)
{
    const Obstacle wire = samples::make_obstacle(samples::wire({{0, -1, 0}, {0, 1, 0}}, false));
    // The cloth rests exactly across the wire, so no side is known.
    EXPECT_TRUE(contacts_of(wire, {Vec3(-1, 0, 0), Vec3(1, 0, 0)}).empty());
    EXPECT_TRUE(contacts_of(wire, {Vec3(0, 0.1, 0), Vec3(0, 0.1, 0)}).empty());
}

TEST(EdgeContact, PlaneBehindWhichItBeganIsNone)
{
    const Obstacle wire = samples::make_obstacle(samples::wire({{0, -1, 0}, {0, 1, 0}}, false));
    const Segment end = {Vec3(-1, 0.9, -1e-3), Vec3(1, 0.9, -1e-3)};
    // The edge goes around the wire's end, from above to below.
    EXPECT_TRUE(contacts_of(wire, {Vec3(-1, 1.7, 1e-3), Vec3(1, 1.7, 1e-3)}, end).empty());
    EXPECT_EQ(contacts_of(wire, {Vec3(-1, 1.7, -1e-3), Vec3(1, 1.7, -1e-3)}, end).size(), 1U);
    EXPECT_EQ(contacts_of(wire, end).size(), 1U);
}

TEST(EdgeContact, ParallelEdgesThatTouchAreHeldApartAlongTheApproach)
{
    const Obstacle wire = samples::make_obstacle(samples::wire({{0, -1, 0}, {0, 1, 0}}, false));
    const Vec3 from = Vec3(1, 0, 2).normalized();
    const auto contacts = contacts_of(wire, {Vec3(0, -2, 0) + 0.05 * from, Vec3(0, 2, 0) + 0.05 * from},
                                      {Vec3(0, -2, 0) - 0.05 * from, Vec3(0, 2, 0) - 0.05 * from});
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_LT((contacts[0].normal - from).norm(), kTouch);
}

TEST(EdgeContact, PairMayBeAnyEdgeOfTheTopology)
{
    // The exact check also asks for the diagonal of the top. This edge is flat, so its normal is the top's.
    const ObstacleTopology& topology = unit_box().topology();
    int flat = 0;
    for (int e = 0; e < static_cast<int>(topology.edges.size()); ++e) {
        const auto& [a, b] = topology.edges[e].points;
        const std::vector<Vec3>& points = unit_box().mesh().points;
        const Vec3 middle = 0.5 * (points[a] + points[b]), along = points[b] - points[a];
        if (std::abs(middle.z() - 1.0) > 1e-12 || along.norm() < 1.2) continue;
        ++flat;
        const Vec3 across = 0.1 * Vec3(-along.y(), along.x(), 0);
        const Vec3 up(0, 0, 0.02), third(0, 0, 9);
        const samples::ClothWay cloth({middle - across + up, middle + across + up, third},
                                      {middle - across - up, middle + across - up, third}, {{0, 1, 2}});
        const auto contact =
            make_edge_contact(unit_box(), cloth.motion, cloth.motion.end, {0, 1}, e, kThickness);
        ASSERT_TRUE(contact.has_value());
        EXPECT_LT((contact->normal - Vec3::UnitZ()).norm(), kTouch);
        EXPECT_EQ(contact->element, e);
    }
    EXPECT_EQ(flat, 1);
}

// A plane exists for every pair of a cloth edge and a feature edge with a local minimum of the distance
// inside both. Every plane is at such a place or at a node.
void expect_all_pairs(const ObstacleMesh& mesh, double size, const Vec3& at, double tolerance)
{
    const Obstacle obstacle = samples::make_obstacle(mesh);
    const double thickness = 0.02 * size;
    std::mt19937 engine(17);
    std::uniform_real_distribution<double> uniform(0.1, 0.9);
    std::normal_distribution<double> normal;
    int expected_count = 0;
    for (int k = 0; k < 600; ++k) {
        const FeatureEdge& feature = obstacle.features().edges[k % obstacle.features().edges.size()];
        const auto& [a, b] = obstacle.topology().edges[feature.edge].points;
        const Vec3 along = mesh.points[b] - mesh.points[a];
        const Vec3 foot = mesh.points[a] + uniform(engine) * along;
        const Vec3 cloth = Vec3(normal(engine), normal(engine), normal(engine)).normalized();
        const Vec3 apart = cloth.cross(along).normalized() * (normal(engine) > 0.0 ? 1.0 : -1.0);
        if (cloth.cross(along.normalized()).norm() < 0.2) continue;
        const Vec3 middle = foot + thickness * uniform(engine) * apart;
        const Segment edge = {Vec3(middle - 0.3 * size * uniform(engine) * cloth),
                              Vec3(middle + 0.3 * size * uniform(engine) * cloth)};
        const samples::ClothWay way({edge[0], edge[1], at}, {edge[0], edge[1], at}, {{0, 1, 2}});
        auto contacts = find_edge_contacts(obstacle, way.motion, way.motion.end, thickness);
        std::erase_if(contacts, [](const ObstacleContact& c) { return c.vertices[1] != 1; });

        for (const ObstacleContact& c : contacts) {
            const Vec3 on_cloth = c.weights[0] * edge[0] + c.weights[1] * edge[1];
            EXPECT_TRUE(samples::is_local_minimum(mesh, c.point, on_cloth, 0.06));
            EXPECT_LT((c.normal - (on_cloth - c.point).normalized()).norm(), 0.06);
        }
        const bool is_minimum = samples::is_local_minimum(mesh, foot, middle, 1e-6);
        const bool is_behind = feature.kind == FeatureKind::Convex && obstacle.topology().is_solid[0] != 0 &&
                               (feature.normals[0] + feature.normals[1]).dot(apart) < 0.0;
        const bool is_found = std::any_of(contacts.begin(), contacts.end(), [&](const ObstacleContact& c) {
            return c.element == feature.edge && (c.point - foot).norm() < tolerance * size &&
                   (c.normal - apart).norm() < std::sqrt(tolerance);
        });
        if (is_minimum && !is_behind) {
            ++expected_count;
            EXPECT_TRUE(is_found) << k;
        }
    }
    EXPECT_GT(expected_count, 20);
}

TEST(EdgeContact, AgreesWithBruteForce)
{
    const auto bumps = [](int i, int j) { return 0.8 * std::sin(1.7 * i) * std::cos(2.3 * j); };
    for (const ObstacleMesh& mesh :
         {samples::box({0, 0, 0}, {1, 1, 0.5}), samples::l_prism(), samples::teeth(3), samples::cylinder(16),
          samples::sheet(3, 3, bumps),
          samples::wire({{0, 0, 0}, {1, 0.2, 0}, {1, 1, 0.4}, {0.2, 1, 0}}, true)}) {
        expect_all_pairs(mesh, 1.0, {0, 0, 90}, 1e-9);
        for (const double size : {1e-6, 1e6})
            expect_all_pairs(samples::moved(mesh, [&](const Vec3& p) { return Vec3(size * p); }), size,
                             {0, 0, 90 * size}, 1e-9);
        const Vec3 far(1e6, -1e6, 1e6);
        expect_all_pairs(samples::moved(mesh, [&](const Vec3& p) { return Vec3(p + far); }), 1.0,
                         far + Vec3(0, 0, 90), 1e-7);
    }
}

TEST(EdgeContact, SortedAndTheSameForAnyNumberOfThreads)
{
    const Obstacle teeth = samples::make_obstacle(samples::teeth(5));
    const Box3& bounds = teeth.bounds();
    const Vec3 origin(bounds.min().x() - 0.1, bounds.min().y() - 0.1, bounds.max().z() + 0.003);
    const Vec3 size = bounds.sizes() / 40.0;
    const std::vector<Vec3> begin = samples::grid_points(42, 42, origin, {size.x(), 0, 0}, {0, size.y(), 0});
    const samples::ClothWay cloth(begin, samples::shifted(begin, {0.01, 0, -0.02}),
                                  samples::grid_faces(42, 42));
    const std::vector<Vec3> reference = slide(teeth, cloth.motion, kThickness);
    const auto key = [](const ObstacleContact& c) { return std::tuple(c.vertices, c.element); };
    const auto same = [&](const ObstacleContact& a, const ObstacleContact& b) {
        return key(a) == key(b) && a.normal == b.normal && a.weights == b.weights &&
               a.least_gap == b.least_gap;
    };
    const auto expected = find_edge_contacts(teeth, cloth.motion, reference, kThickness);
    EXPECT_GT(expected.size(), 100U);
    EXPECT_TRUE(std::is_sorted(expected.begin(), expected.end(),
                               [&](const auto& a, const auto& b) { return key(a) < key(b); }));
    for (const int threads : {1, 2, 4}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const auto contacts = find_edge_contacts(teeth, cloth.motion, reference, kThickness);
        EXPECT_TRUE(std::equal(contacts.begin(), contacts.end(), expected.begin(), expected.end(), same));
    }
}

}  // namespace
}  // namespace arris
