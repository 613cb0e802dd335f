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
const double kCos20 = std::cos(20.0 * M_PI / 180.0);

std::vector<ObstacleContact> contacts_at(const Obstacle& obstacle, const Vec3& begin, const Vec3& end,
                                         double thickness = kThickness)
{
    return find_vertex_contacts(obstacle, samples::points_way({begin}, {end}), {end}, thickness);
}

std::vector<ObstacleContact> contacts_at(const Obstacle& obstacle, const Vec3& place)
{
    return contacts_at(obstacle, place, place);
}

bool has_normal(const std::vector<ObstacleContact>& contacts, const Vec3& normal,
                double tolerance = kRounding)
{
    return std::any_of(contacts.begin(), contacts.end(),
                       [&](const ObstacleContact& c) { return (c.normal - normal).norm() <= tolerance; });
}

const Obstacle& unit_box()
{
    static const Obstacle box = samples::make_obstacle(samples::box({0, 0, 0}, {1, 1, 1}));
    return box;
}

TEST(VertexContact, AboveATopNearTheRimIsTheTopsPlane)
{
    for (const double x : {0.5, 0.999, 0.9999, 1.0 - 1e-9, 1.0}) {
        const auto contacts = contacts_at(unit_box(), {x, 0.5, 1.001});
        ASSERT_EQ(contacts.size(), 1U) << x;
        EXPECT_LT((contacts[0].normal - Vec3::UnitZ()).norm(), 1e-5);
        EXPECT_NEAR(contacts[0].least_gap, kThickness, 1e-9);
        EXPECT_EQ(contacts[0].kind, ContactKind::Vertex);
        EXPECT_EQ(contacts[0].vertices, (std::array<int, 3>{0, -1, -1}));
    }
}

TEST(VertexContact, BeyondTheRimIsOnePlaneAcrossIt)
{
    for (const double degrees : {1.0, 30.0, 45.0, 89.0}) {
        const double a = degrees * M_PI / 180.0;
        const Vec3 direction(std::sin(a), 0.0, std::cos(a));
        const auto contacts = contacts_at(unit_box(), Vec3(1, 0.5, 1) + kThickness * direction);
        ASSERT_EQ(contacts.size(), 1U);
        EXPECT_LT((contacts[0].normal - direction).norm(), kRounding);
        EXPECT_LT((contacts[0].point - Vec3(1, 0.5, 1)).norm(), kRounding);
    }
    const Vec3 diagonal = Vec3(1, 1, 1).normalized();
    const auto corner = contacts_at(unit_box(), Vec3(1, 1, 1) + kThickness * diagonal);
    ASSERT_EQ(corner.size(), 1U);
    EXPECT_LT((corner[0].normal - diagonal).norm(), kRounding);
}

TEST(VertexContact, OnTheRimItselfIsOnePlaneOutOfTheSolid)
{
    const Vec3 rim(1, 0.5, 1);
    for (const Vec3& begin : {Vec3(0.99, 0.5, 1.001), Vec3(1.001, 0.5, 0.99), Vec3(1.01, 0.5, 1.01), rim}) {
        for (const double distance : {0.0, 1e-17, 1e-10, 1e-7}) {
            const auto contacts = contacts_at(unit_box(), begin, rim + Vec3(distance, 0, distance));
            ASSERT_EQ(contacts.size(), 1U) << distance;
            const Vec3& n = contacts[0].normal;
            EXPECT_GE(n.x(), -kRounding);
            EXPECT_GE(n.z(), -kRounding);
            EXPECT_NEAR(n.norm(), 1.0, kRounding);
        }
    }
}

TEST(VertexContact, BarelyOnATopItIsTheTopsPlaneAlone)
{
    // The vertex came from the side, but the top's face is nearest to its present place and gives the normal.
    const auto contacts = contacts_at(unit_box(), {1.002, 0.5, 0.9995}, {1.0 - 1e-9, 0.5, 1.0 + 1e-7});
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_LT((contacts[0].normal - Vec3::UnitZ()).norm(), kRounding);
}

TEST(VertexContact, FarFromTheObstacleIsNone)
{
    EXPECT_TRUE(contacts_at(unit_box(), {0.5, 0.5, 1.0031}).empty());
    EXPECT_TRUE(contacts_at(unit_box(), {50, 0.5, 1}).empty());
    // The reach is a quarter of the motion if nothing is nearer.
    EXPECT_EQ(contacts_at(unit_box(), {0.3, 0.5, 1.02}, {0.5, 0.5, 1.02}).size(), 1U);
    EXPECT_TRUE(contacts_at(unit_box(), {0.47, 0.5, 1.02}, {0.5, 0.5, 1.02}).empty());
}

TEST(VertexContact, GapMayCloseToTheThicknessAndASmallerOneNoFurther)
{
    const auto least_gap = [](double before, double after) {
        return contacts_at(unit_box(), {0.5, 0.5, 1.0 + before}, {0.5, 0.5, 1.0 + after})[0].least_gap;
    };
    EXPECT_NEAR(least_gap(2e-3, 0.1e-3), kThickness, kRounding);
    EXPECT_NEAR(least_gap(0.3e-3, 0.1e-3), 0.3e-3, kRounding);
    // A vertex that moves outward keeps only its former gap: the contact must not maintain its speed.
    EXPECT_NEAR(least_gap(0.3e-3, 0.7e-3), 0.3e-3, kRounding);
    EXPECT_NEAR(least_gap(0.3e-3, 2e-3), 0.3e-3, kRounding);
}

TEST(VertexContact, GapIsOfTheEndNotOfTheReference)
{
    const Vec3 begin(0.5, 0.5, 1.0003), slid(0.5, 0.5, 1.0003), end(0.5, 0.5, 0.9);
    const auto contacts =
        find_vertex_contacts(unit_box(), samples::points_way({begin}, {end}), {slid}, kThickness);
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_NEAR(contacts[0].least_gap, 0.3e-3, kRounding);
}

TEST(VertexContact, ReflexEdgeGivesTwoPlanesAndReflexCornerThree)
{
    const Obstacle room = samples::make_obstacle(samples::inside_out(samples::box({0, 0, 0}, {1, 1, 1})));
    const auto edge = contacts_at(room, {1e-3, 0.5, 1.5e-3});
    EXPECT_EQ(edge.size(), 2U);
    EXPECT_TRUE(has_normal(edge, Vec3::UnitX()));
    EXPECT_TRUE(has_normal(edge, Vec3::UnitZ()));
    const auto corner = contacts_at(room, {1e-3, 1.2e-3, 1.5e-3});
    EXPECT_EQ(corner.size(), 3U);
    for (int d = 0; d < 3; ++d) EXPECT_TRUE(has_normal(corner, Vec3::Unit(d)));
}

TEST(VertexContact, ThinPlateIsSeenFromItsOwnSideOnly)
{
    const Obstacle plate = samples::make_obstacle(samples::box({0, 0, 0}, {1, 1, 1e-4}));
    for (const Vec3& place : {Vec3(0.5, 0.5, 1.1e-3), Vec3(0.9999, 0.5, 5e-4)}) {
        const auto above = contacts_at(plate, place);
        ASSERT_EQ(above.size(), 1U);
        EXPECT_LT((above[0].normal - Vec3::UnitZ()).norm(), kRounding);
        EXPECT_NEAR(above[0].point.z(), 1e-4, kRounding);
    }
    const auto below = contacts_at(plate, {0.5, 0.5, -1e-3});
    ASSERT_EQ(below.size(), 1U);
    EXPECT_LT((below[0].normal + Vec3::UnitZ()).norm(), kRounding);
}

TEST(VertexContact, BehindAReflexEdgeIsTheOuterEdgeOnly)
{
    // A thin roof, 1e-4 thick: its ridge is convex outside and reflex inside.
    const double t = 1e-4 * std::sqrt(2.0);
    const Obstacle roof = samples::make_obstacle(
        samples::moved(samples::prism({{-1, -1}, {0, 0}, {1, -1}, {1, -1 + t}, {0, t}, {-1, -1 + t}},
                                      {0.0, 1.0}, {{0, 1, 4}, {0, 4, 5}, {1, 2, 3}, {1, 3, 4}}),
                       [](const Vec3& p) { return Vec3(p.x(), -p.z(), p.y()); }));
    const auto above = contacts_at(roof, {0, -0.5, t + 8e-4});
    ASSERT_EQ(above.size(), 1U);
    EXPECT_NEAR(above[0].point.z(), t, kRounding);
    const auto below = contacts_at(roof, {0, -0.5, -8e-4});
    EXPECT_EQ(below.size(), 2U);
}

TEST(VertexContact, SheetIsSeenFromBothSides)
{
    const Obstacle sheet = samples::make_obstacle(samples::sheet(2, 2, [](int, int) { return 0.0; }));
    for (const double side : {1.0, -1.0}) {
        for (const double height : {1e-3, 1e-9, 0.0}) {  // the vertex rests on the roof
            const auto contacts = contacts_at(sheet, {0.3, 0.4, side * 0.01}, {0.3, 0.4, side * height});
            ASSERT_EQ(contacts.size(), 1U);
            EXPECT_LT((contacts[0].normal - side * Vec3::UnitZ()).norm(), kRounding);
        }
    }
    // The vertex is beside the sheet's border.
    const auto beside = contacts_at(sheet, {-1e-3, 0.5, 0});
    ASSERT_EQ(beside.size(), 1U);
    EXPECT_LT((beside[0].normal + Vec3::UnitX()).norm(), kRounding);
}

TEST(VertexContact, WireIsSeenFromAllAround)
{
    const Obstacle wire = samples::make_obstacle(samples::wire({{0, 0, 0}, {1, 0, 0}, {2, 0.1, 0}}, false));
    for (int k = 0; k < 36; ++k) {
        const double a = k * M_PI / 18.0;
        const Vec3 direction(0, std::cos(a), std::sin(a));
        for (const double x : {0.0, 0.4}) {  // on the wire and at its end
            const auto contacts = contacts_at(wire, Vec3(x, 0, 0) + kThickness * direction);
            ASSERT_EQ(contacts.size(), 1U);
            EXPECT_LT((contacts[0].normal - direction).norm(), kRounding);
        }
        // At the bend there is one plane on each side.
        EXPECT_EQ(contacts_at(wire, Vec3(1, 0, 0) + kThickness * direction).size(), 1U);
    }
    // Inside a sharp bend the vertex is between two segments.
    const Obstacle bend = samples::make_obstacle(samples::wire({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, false));
    EXPECT_EQ(contacts_at(bend, {0.999, 1e-3, 0}).size(), 2U);
}

TEST(VertexContact, NailPushesAway)
{
    const Obstacle nails = samples::make_obstacle(samples::nails({{0, 0, 0}, {1, 0, 0}}));
    std::mt19937 engine(3);
    std::normal_distribution<double> normal;
    for (int k = 0; k < 50; ++k) {
        const Vec3 direction = Vec3(normal(engine), normal(engine), normal(engine)).normalized();
        const auto contacts = contacts_at(nails, Vec3(1, 0, 0) + 2.0 * kThickness * direction);
        ASSERT_EQ(contacts.size(), 1U);
        EXPECT_LT((contacts[0].normal - direction).norm(), kRounding);
        EXPECT_EQ(contacts[0].element, 1);
    }
}

TEST(VertexContact, PlaneBehindWhichItBeganIsNone)
{
    // Cloth may fall past a wire, a nail or a sheet's border. A vertex that has passed must not be held below
    // it.
    const Obstacle wire = samples::make_obstacle(samples::wire({{0, -1, 0}, {0, 1, 0}}, false));
    const Obstacle nails = samples::make_obstacle(samples::nails({{0, 0, 0}}));
    const Obstacle sheet = samples::make_obstacle(samples::sheet(2, 2, [](int, int) { return 0.0; }));
    const Vec3 above(1e-3, 0.1, 0.05), below(1e-3, 0.1, -1e-3);
    EXPECT_TRUE(contacts_at(wire, above, below).empty());
    EXPECT_EQ(contacts_at(wire, below, below).size(), 1U);
    EXPECT_TRUE(contacts_at(nails, {1e-3, 0, 0.05}, {1e-3, 0, -1e-3}).empty());
    EXPECT_TRUE(contacts_at(sheet, {-1e-3, 1, 0.05}, {-1e-3, 1, -1e-3}).empty());
    EXPECT_TRUE(contacts_at(sheet, {-1e-3, 1, 0.05}, {2e-3, 1, -1e-3}).empty());
    for (const Obstacle* thin : {&wire, &nails})
        EXPECT_TRUE(contacts_at(*thin, {1e-3, 0, 2e-3}, {1e-3, 0, -1e-3}).empty());
    EXPECT_TRUE(contacts_at(sheet, {-1e-3, 1, 2e-3}, {-1e-3, 1, -1e-3}).empty());
    // The vertex moves over a table's rim and down its side.
    EXPECT_TRUE(contacts_at(unit_box(), {0.97, 0.5, 1.001}, {1.001, 0.5, 0.98}).empty());
    EXPECT_EQ(contacts_at(unit_box(), {1.001, 0.5, 1.001}, {1.001, 0.5, 0.98}).size(), 1U);
    // Moving around a round obstacle, the vertex is still held.
    const Obstacle ball = samples::make_obstacle(samples::sphere(51, 100));
    for (const double turn : {0.1, 0.3, 0.45})
        EXPECT_EQ(contacts_at(ball, {0, 0, 1.0 + kThickness},
                              (1.0 + kThickness) * Vec3(std::sin(turn), 0, std::cos(turn)))
                      .size(),
                  1U);
}

TEST(VertexContact, SmoothFineSurfaceIsOnePlane)
{
    // Neighbours among 10 000 faces differ by at most 3 degrees, so normals are radial to within that angle.
    const ObstacleMesh mesh = samples::sphere(51, 100);
    const Obstacle ball = samples::make_obstacle(mesh),
                   bowl = samples::make_obstacle(samples::inside_out(mesh));
    std::mt19937 engine(5);
    std::normal_distribution<double> normal;
    for (int k = 0; k < 300; ++k) {
        const Vec3 radial = Vec3(normal(engine), normal(engine), normal(engine)).normalized();
        const Vec3 tangent = radial.cross(Vec3(normal(engine), normal(engine), normal(engine))).normalized();
        for (const double side : {1.0, -1.0}) {
            const Obstacle& obstacle = side > 0.0 ? ball : bowl;
            const Vec3 foot = samples::nearest_point(mesh, (1.0 + side * kThickness) * radial);
            const Vec3 place = foot + side * kThickness * radial;
            const Vec3 from = place - 0.005 * tangent;
            const Vec3 from_foot = samples::nearest_point(mesh, from);
            const Vec3 begin = from_foot + kThickness * (from - from_foot).normalized();
            const auto contacts = contacts_at(obstacle, begin, place);
            ASSERT_EQ(contacts.size(), 1U);
            EXPECT_GT(side * contacts[0].normal.dot(radial), std::cos(4.0 * M_PI / 180.0));
            EXPECT_NEAR(contacts[0].least_gap, kThickness, 0.1 * kThickness);
        }
    }
}

TEST(VertexContact, WhatSlidesUnderItsStandOffStaysAsFarAsItWas)
{
    // The free motion leads outward, and along the obstacle by much more than the stand-off.
    const Obstacle wire = samples::make_obstacle(samples::wire({{-1, 0, 0}, {1, 0, 0}}, false));
    for (const Obstacle* obstacle : {&wire, &unit_box()})
        for (const double share : {0.0, 0.4, 0.99}) {
            const Vec3 on = obstacle == &wire ? Vec3(0.1, 0, 0) : Vec3(0.1, 0.5, 1);
            const Vec3 begin = on + Vec3(0, 0, share * kThickness);
            const auto contacts = contacts_at(*obstacle, begin, on + Vec3(0.05, 0, 1.5 * kThickness));
            ASSERT_EQ(contacts.size(), 1U);
            EXPECT_NEAR(contacts[0].least_gap, share * kThickness, kRounding);
        }
}

TEST(VertexContact, WhatSlidesOverARimStaysAsFarAsItWas)
{
    // The vertex moves from beside the box to above its rim. At begin it was below the final plane.
    const double gap = 0.6 * kThickness;
    const Vec3 up = Vec3(1, 0, 1).normalized();
    const auto contacts = contacts_at(unit_box(), Vec3(1 + gap, 0.5, 0.9995), Vec3(1, 0.5, 1) + 2 * gap * up);
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_NEAR(contacts[0].least_gap, gap, kRounding);
}

struct Sample {
    const char* name;
    ObstacleMesh mesh;
    bool is_solid;
};

std::vector<Sample> all_samples()
{
    const auto bumps = [](int i, int j) { return 0.4 * std::sin(1.7 * i) * std::cos(2.3 * j); };
    const auto gentle = [](int i, int j) { return 0.02 * std::sin(0.7 * i) * std::cos(0.9 * j); };
    return {
        {"box", samples::box({0, 0, 0}, {1, 1, 0.05}), true},
        {"l", samples::l_prism(), true},
        {"teeth", samples::teeth(3), true},
        {"sphere", samples::sphere(8, 14), true},
        {"cone", samples::cone(7, 0.3), true},
        {"cylinder", samples::cylinder(16), true},
        {"sliver", samples::box({0, 0, 0}, {1, 1e-6, 0.3}), true},
        {"bumps", samples::sheet(5, 5, bumps), false},
        {"gentle", samples::sheet(12, 12, gentle), false},
        {"wire", samples::wire({{0, 0, 0}, {1, 0.2, 0}, {1, 1, 0.4}, {0.2, 1, 0}}, true), false},
        {"nails", samples::nails({{0, 0, 0}, {0.3, 0.1, 0}, {1, 1, 1}}), false},
        {"mixed", samples::together(samples::l_prism(), samples::wire({{0.2, 0.2, 3.2}, {1, 3, 3.1}}, false)),
         false}};
}

// Places near a mesh, outside its solids.
std::vector<Vec3> places_near(const ObstacleMesh& mesh, double reach, int count, bool has_inside)
{
    std::mt19937 engine(11);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::normal_distribution<double> normal;
    std::vector<std::array<Vec3, 3>> pieces;
    for (const auto& [a, b, c] : mesh.faces)
        pieces.push_back({mesh.points[a], mesh.points[b], mesh.points[c]});
    for (const auto& [a, b] : mesh.segments)
        pieces.push_back({mesh.points[a], mesh.points[b], mesh.points[b]});
    for (const int p : mesh.lone_points) pieces.push_back({mesh.points[p], mesh.points[p], mesh.points[p]});
    std::vector<Vec3> places;
    for (int k = 0; static_cast<int>(places.size()) < count; ++k) {
        const auto& t = pieces[k % pieces.size()];
        double u = uniform(engine), v = (1.0 - u) * uniform(engine);
        if (k % 4 == 1) v = 0.0;      // near an edge
        if (k % 4 == 2) u = v = 0.0;  // near a corner
        const Vec3 direction = Vec3(normal(engine), normal(engine), normal(engine)).normalized();
        const Vec3 place = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]) + reach * uniform(engine) * direction;
        if (!has_inside || !samples::is_inside(mesh, place)) places.push_back(place);
    }
    return places;
}

// Brute force: all local minima of the distance within reach that are not behind the solid's surface.
std::vector<Vec3> brute_minima(const ObstacleMesh& mesh, const Vec3& y, double reach, bool has_inside,
                               double tolerance)
{
    std::vector<Vec3> minima;
    const auto offer = [&](const ObstacleMesh& one) {
        const Vec3 c = samples::nearest_point(one, y);
        if (!((c - y).norm() <= reach) || !samples::is_local_minimum(mesh, c, y, tolerance)) return;
        if (has_inside && samples::is_inside(mesh, c + 1e-7 * (y - c))) return;
        minima.push_back(c);
    };
    for (const Face& f : mesh.faces) offer({mesh.points, {f}, {}, {}});
    for (const auto& s : mesh.segments) offer({mesh.points, {}, {s}, {}});
    for (const int p : mesh.lone_points) offer({mesh.points, {}, {}, {p}});
    return minima;
}

// Comparison with brute force. `size` is the mesh's scale, `rounding` that of directions.
void expect_all_minima(const Sample& sample, double size, double rounding)
{
    const double thickness = 0.02 * size, reach = 3.0 * thickness;
    const bool has_inside = sample.is_solid || std::string(sample.name) == "mixed";
    const Obstacle obstacle = samples::make_obstacle(sample.mesh);
    const std::vector<Vec3> places = places_near(sample.mesh, 0.99 * reach, 400, has_inside);
    const auto all = find_vertex_contacts(obstacle, samples::points_way(places, places), places, thickness);
    for (int v = 0; v < static_cast<int>(places.size()); ++v) {
        std::vector<ObstacleContact> contacts;
        for (const ObstacleContact& c : all)
            if (c.vertices[0] == v) contacts.push_back(c);
        const Vec3& y = places[v];
        const Vec3 nearest = samples::nearest_point(sample.mesh, y);
        if ((nearest - y).norm() < 1e-2 * thickness) continue;  // directions are inaccurate there

        // The nearest point is among the contacts, all contacts are local minima, and their normals differ.
        EXPECT_TRUE(std::any_of(contacts.begin(), contacts.end(),
                                [&](const ObstacleContact& c) {
                                    return std::abs(c.normal.dot(y - c.point) - (nearest - y).norm()) <=
                                               rounding * size &&
                                           (c.normal - (y - nearest).normalized()).norm() < 0.06;
                                }))
            << sample.name << " " << v << " " << y.transpose();
        EXPECT_LE(contacts.size(), 3U);
        for (const ObstacleContact& c : contacts) {
            EXPECT_LE((samples::nearest_point(sample.mesh, c.point) - c.point).norm(), rounding * size);
            EXPECT_TRUE(samples::is_local_minimum(sample.mesh, c.point, y, 0.06)) << sample.name << " " << v;
            EXPECT_NEAR(c.normal.norm(), 1.0, kRounding);
            EXPECT_LT((c.normal - (y - c.point).normalized()).norm(), 0.06) << sample.name << " " << v;
            for (const ObstacleContact& d : contacts) {
                if (&c != &d) {
                    EXPECT_LT(c.normal.dot(d.normal), kCos20);
                }
            }
        }
        // Every minimum has a contact with its direction, unless there are three nearer ones.
        for (const Vec3& m : brute_minima(sample.mesh, y, 0.999 * reach, has_inside, 1e-6)) {
            const Vec3 direction = (y - m).normalized();
            EXPECT_TRUE(contacts.size() == 3 ||
                        std::any_of(contacts.begin(), contacts.end(),
                                    [&](const auto& c) { return c.normal.dot(direction) > kCos20 - 1e-3; }))
                << sample.name << " " << v << " misses " << direction.transpose();
        }
    }
}

TEST(VertexContact, AgreesWithBruteForce)
{
    for (const Sample& sample : all_samples()) expect_all_minima(sample, 1.0, 1e-9);
}

TEST(VertexContact, AgreesWithBruteForceTinyHugeAndFar)
{
    for (Sample sample : all_samples()) {
        const ObstacleMesh mesh = sample.mesh;
        for (const double size : {1e-6, 1e6}) {
            sample.mesh = samples::moved(mesh, [&](const Vec3& p) { return Vec3(size * p); });
            expect_all_minima(sample, size, 1e-9);
        }
        // The sliver is 1e-6 wide, too thin for coordinates accurate to 1e-10.
        if (std::string(sample.name) == "sliver") continue;
        sample.mesh = samples::moved(mesh, [](const Vec3& p) { return Vec3(p + Vec3(1e6, -1e6, 1e6)); });
        expect_all_minima(sample, 1.0, 1e-7);
    }
}

TEST(VertexContact, FinHasClothOnBothSides)
{
    const Obstacle fin = samples::make_obstacle(samples::box({0, 0, 0}, {1e-3, 1, 0.02}));
    const std::vector<Vec3> places = {{-1e-3, 0.5, 0.01}, {2e-3, 0.5, 0.01}};
    const auto contacts = find_vertex_contacts(fin, samples::points_way(places, places), places, kThickness);
    ASSERT_EQ(contacts.size(), 2U);
    EXPECT_LT((contacts[0].normal + Vec3::UnitX()).norm(), kRounding);
    EXPECT_LT((contacts[1].normal - Vec3::UnitX()).norm(), kRounding);
}

TEST(VertexContact, SortedAndTheSameForAnyNumberOfThreads)
{
    const Obstacle teeth = samples::make_obstacle(samples::teeth(5));
    const std::vector<Vec3> begin = places_near(teeth.mesh(), 0.02, 2000, true);
    const ClothMotion motion = samples::points_way(begin, samples::shifted(begin, {0.01, 0, -0.02}));
    const std::vector<Vec3> reference = slide(teeth, motion, 0.01);
    const auto key = [](const ObstacleContact& c) { return std::tuple(c.vertices, c.element); };
    const auto same = [&](const ObstacleContact& a, const ObstacleContact& b) {
        return key(a) == key(b) && a.normal == b.normal && a.point == b.point && a.least_gap == b.least_gap;
    };
    const auto expected = find_vertex_contacts(teeth, motion, reference, 0.01);
    EXPECT_GT(expected.size(), 1000U);
    EXPECT_TRUE(std::is_sorted(expected.begin(), expected.end(),
                               [&](const auto& a, const auto& b) { return key(a) < key(b); }));
    for (const int threads : {1, 2, 4}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const auto contacts = find_vertex_contacts(teeth, motion, reference, 0.01);
        EXPECT_TRUE(std::equal(contacts.begin(), contacts.end(), expected.begin(), expected.end(), same));
    }
}

}  // namespace
}  // namespace arris
