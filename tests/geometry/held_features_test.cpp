// SPDX-License-Identifier: GPL-3.0-or-later
// Cloth beside a vertex that is on a wire may touch the wire there, and nowhere else.
#include "geometry/held_features.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/penetration.h"
#include "geometry/sweep_check.h"
#include "tests/geometry/contact_scene.h"
#include "tests/geometry/sample_obstacles.h"

namespace arris {
namespace {

constexpr double kThickness = 1e-3;
constexpr double kCell = 0.1;  // m

/// A wire along y.
Obstacle make_straight_wire()
{
    return samples::make_obstacle(samples::wire({{0, -1, 0}, {0, 1, 0}}, false));
}

/// Cloth folded over the y axis, a stand-off above it: three vertices on it (0, 1, 2), three cells down on
/// the left (3, 4, 5) and on the right (6, 7, 8); `open` degrees between its sides.
struct Fold {
    std::vector<Face> faces = {{0, 1, 3}, {1, 4, 3}, {1, 2, 4}, {2, 5, 4},
                               {0, 6, 1}, {1, 6, 7}, {1, 7, 2}, {2, 7, 8}};
    MeshTopology topology;
    ClothMotion motion;

    explicit Fold(double open = 0.0, double height = kThickness) : topology(make_topology(9, faces))
    {
        const double half = 0.5 * open * M_PI / 180.0;
        for (const double side : {0.0, -1.0, 1.0})
            for (int k = -1; k <= 1; ++k)
                motion.begin.emplace_back(side * kCell * std::sin(half), k * kCell,
                                          height - std::abs(side) * kCell * std::cos(half));
        motion.faces = &faces;
        motion.edges = &topology.edges;
        motion.end = motion.begin;
    }
    Fold(const Fold&) = delete;

    void hold(int feature = 0)
    {
        for (const int v : {0, 1, 2}) motion.holds.push_back({v, false, feature});
    }
    void move(const Vec3& by)
    {
        for (Vec3& x : motion.end) x += by;
    }
    SweepReport check(const Obstacle& obstacle) const { return check_sweep(obstacle, motion, kThickness); }
};

TEST(HeldFeatures, ClothThatHangsOverAWireTouchesItBesideHeldVertices)
{
    const Obstacle wire = make_straight_wire();
    Fold cloth;
    EXPECT_FALSE(cloth.check(wire).is_clean()) << "both its sides are in the wire's line";
    EXPECT_TRUE(find_penetration(wire, cloth.motion.begin, cloth.faces).is_any());
    cloth.hold();
    EXPECT_TRUE(cloth.check(wire).is_clean());
    EXPECT_FALSE(
        find_penetration(wire, cloth.motion.begin, cloth.faces, cloth.motion.holds, kThickness).is_any());
    cloth.move(Vec3(0, 0.03, 0));  // along it
    EXPECT_TRUE(cloth.check(wire).is_clean());
}

TEST(HeldFeatures, SidesMayClapTogetherAndOpen)
{
    const Obstacle wire = make_straight_wire();
    for (const double from : {0.0, 1.0, 60.0, 170.0})
        for (const double to : {0.0, 1.0, 60.0, 170.0}) {
            Fold cloth(from);
            cloth.hold();
            cloth.motion.end = Fold(to).motion.begin;
            EXPECT_TRUE(cloth.check(wire).is_clean()) << from << " to " << to;
        }
}

TEST(HeldFeatures, AreTheSameOverManySegments)
{
    std::vector<Vec3> points;
    for (int k = 0; k <= 200; ++k) points.emplace_back(0.0, -1.0 + 0.01 * k, 0.0);
    const Obstacle wire = samples::make_obstacle(samples::wire(points, false));
    Fold cloth;
    for (const int v : {0, 1, 2}) {
        const int near = static_cast<int>(std::lround((cloth.motion.begin[v].y() + 1.0) / 0.01)) - 1;
        cloth.motion.holds.push_back({v, false, near});  // a node: it is at the end of that segment
    }
    EXPECT_TRUE(cloth.check(wire).is_clean());
    cloth.motion.holds.clear();
    EXPECT_FALSE(cloth.check(wire).is_clean());
}

TEST(HeldFeatures, AnotherWireThroughTheSameFacesIsFound)
{
    ObstacleMesh mesh = samples::wire({{0, -1, 0}, {0, 1, 0}}, false);
    mesh.points.emplace_back(-1.0, 0.03, -0.05);
    mesh.points.emplace_back(1.0, 0.03, -0.05);
    mesh.segments.push_back({2, 3});
    const Obstacle wires = samples::make_obstacle(mesh);
    Fold cloth(30.0);
    cloth.hold(0);
    EXPECT_GE(cloth.check(wires).intersections, 1);
}

TEST(HeldFeatures, TheSameWireFartherAlongIsFound)
{
    // A hairpin: its second leg is below the first, between the cloth's sides, then goes through one.
    const Obstacle hairpin = samples::make_obstacle(samples::wire(
        {{0, -1, 0}, {0, 1, 0}, {0, 1.02, -0.005}, {0, 1.02, -0.02}, {0, 1, -0.03}, {0, -1, -0.03}}, false));
    Fold cloth(20.0);
    int feature = 0;
    while (hairpin.topology().edges[hairpin.features().edges[feature].edge].points[0] != 0) ++feature;
    cloth.hold(feature);
    EXPECT_TRUE(cloth.check(hairpin).is_clean());
    for (const int v : {3, 4, 5}) cloth.motion.end[v].x() += 0.06;  // past the leg below
    const SweepReport report = cloth.check(hairpin);
    EXPECT_GE(report.crossings, 1);
    EXPECT_FALSE(report.violations.empty());
}

TEST(HeldFeatures, AWireThatGetsThroughAnEdgeAwayFromTheTraceIsFound)
{
    const Obstacle wire = make_straight_wire();
    Fold cloth(90.0, 0.02);
    cloth.hold();
    for (const int v : {3, 4, 5}) {  // the left side is thrown over to the right, above the wire
        cloth.motion.begin[v] = Vec3(-kCell, cloth.motion.begin[v].y(), 0.02);
        cloth.motion.end[v] = Vec3(-kCell, cloth.motion.begin[v].y(), -0.05);
    }
    EXPECT_TRUE(cloth.check(wire).is_clean());
    // Its lower border goes through the wire: an edge that no held vertex is at.
    for (const int v : {3, 4, 5}) {
        cloth.motion.begin[v] = Vec3(-0.01, cloth.motion.begin[v].y(), -0.005);
        cloth.motion.end[v] = Vec3(0.02, cloth.motion.begin[v].y() + 0.01, 0.01 + 0.001 * (v - 4));
    }
    EXPECT_GE(cloth.check(wire).crossings, 1);
}

TEST(HeldFeatures, AWiresEndInTheMiddleOfAFaceIsFound)
{
    // It ends below the middle vertex and a bit beside.
    for (const double end : {0.004, 0.03}) {
        const Obstacle wire = samples::make_obstacle(samples::wire({{0, -1, 0}, {0, end, 0}}, false));
        Fold cloth(60.0);
        for (const int v : {0, 1}) cloth.motion.holds.push_back({v, false, 0});
        EXPECT_TRUE(cloth.check(wire).is_clean()) << end;
        cloth.move(Vec3(-0.01, 0, -0.01));
        for (const int v : {0, 1, 2}) cloth.motion.end[v] = cloth.motion.begin[v];
        cloth.motion.end[2].x() += 0.03;
        cloth.motion.end[2].z() -= 0.06;
        EXPECT_GE(cloth.check(wire).crossings, 1) << end;
    }
}

TEST(HeldFeatures, ANailMayNotBeTouched)
{
    // All around it the cloth bends down, and a nail that got into a face would be through.
    const Obstacle nail = samples::make_obstacle(samples::nails({{0, 0, 0}}));
    Fold cloth;
    cloth.motion.holds.push_back({1, true, 0});
    EXPECT_FALSE(cloth.check(nail).is_clean());
}

TEST(HeldFeatures, WhereTheWireBendsAwayItMayNotBeTouched)
{
    for (const double bend : {0.0, 1e-4, 5e-3}) {
        const Obstacle wire = samples::make_obstacle(
            samples::wire({{0, -1, 0}, {0, -0.1, 0}, {0, -0.05, -bend}, {0, 0, 0}, {0, 1, 0}}, false));
        Fold cloth;
        for (const auto& [v, y] : {std::pair(0, -0.1), {1, 0.0}, {2, 0.1}})
            cloth.motion.holds.push_back({v, false, y < -0.05 ? 0 : 3});
        EXPECT_EQ(cloth.check(wire).is_clean(), bend < 1e-3) << bend;
    }
}

TEST(HeldFeatures, OnAnEdgeOfASolidLetNothingTouch)
{
    const Obstacle box = samples::make_obstacle(samples::box(Vec3(0, -1, -1), Vec3(1, 1, 0)));
    Fold cloth;
    for (int f = 0; f < static_cast<int>(box.features().edges.size()); ++f) {
        cloth.motion.holds.clear();
        cloth.hold(f);
        EXPECT_FALSE(cloth.check(box).is_clean());
        EXPECT_FALSE(HeldFeatures(box, cloth.motion, kThickness).is_any());
    }
}

TEST(IsClear, ComparesTheFacesDistanceToTheWire)
{
    const Obstacle wire = make_straight_wire();
    for (const double open : {0.0, 1.0, 20.0, 90.0, 180.0}) {
        const Fold cloth(open);
        std::vector<std::array<Vec3, 3>> faces;
        for (const Face& f : cloth.faces)
            faces.push_back({cloth.motion.begin[f[0]], cloth.motion.begin[f[1]], cloth.motion.begin[f[2]]});
        const double truth = kThickness * std::sin(0.5 * open * M_PI / 180.0);
        const auto is_clear_by = [&](double distance) {
            return is_clear(wire, {0, false, 0}, Vec3(0, 0, kThickness), faces, distance);
        };
        EXPECT_FALSE(is_clear_by(1.001 * truth)) << open;
        EXPECT_EQ(is_clear_by(0.999 * truth), open > 0.0) << open;
    }
}

}  // namespace
}  // namespace arris
