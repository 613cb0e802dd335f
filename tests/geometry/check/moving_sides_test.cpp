// SPDX-License-Identifier: GPL-3.0-or-later
// The check of cloth and an obstacle that both move: it must say what the check of their relative motion
// says.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>

#include "geometry/check/sweep_check.h"
#include "geometry/cloth/mesh_topology.h"
#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "geometry/rigid_motion.h"

namespace arris {
namespace {

constexpr double kThickness = 1e-3;

/// A box, a wire and a nail in a row, .2 m apart.
ObstacleMesh make_kinds()
{
    ObstacleMesh mesh = make_box({0.1, 0.1, 0.1});
    const int first = static_cast<int>(mesh.points.size());
    mesh.points.insert(mesh.points.end(),
                       {Vec3(0.2, -0.05, 0.0), Vec3(0.22, 0.05, 0.01), Vec3(0.4, 0.0, 0.0)});
    mesh.segments = {{first, first + 1}};
    mesh.lone_points = {first + 2};
    return mesh;
}

struct Sheet {
    ClothMesh mesh;
    MeshTopology topology;

    Sheet()
    {
        ClothGrid grid;
        grid.size = {0.6, 0.3};
        grid.resolution = {9, 5};
        mesh = make_cloth_grid(grid);
        topology = make_topology(mesh.vertex_count(), mesh.faces);
    }
    ClothMotion move(const std::vector<Vec3>& begin, const std::vector<Vec3>& end) const
    {
        return {&mesh.faces, &topology.edges, begin, end};
    }
    /// The cloth and the obstacle move; `carried` is the cloth's begin, carried by the obstacle.
    ClothMotion move_both(const std::shared_ptr<const Obstacle>& before, const std::vector<Vec3>& begin,
                          const std::vector<Vec3>& carried, const std::vector<Vec3>& end) const
    {
        return {&mesh.faces, &topology.edges, carried, end,
                std::make_shared<const MovingSides>(MovingSides{before, begin})};
    }
    std::vector<Vec3> at(const Vec3& corner) const
    {
        std::vector<Vec3> places = mesh.world;
        for (Vec3& x : places) x += corner;
        return places;
    }
};

std::vector<Vec3> moved(std::vector<Vec3> points, const Vec3& way)
{
    for (Vec3& p : points) p += way;
    return points;
}

TEST(MovingSides, FindWhatTheCheckOfTheRelativeMotionFinds)
{
    const Sheet sheet;
    const auto before = std::make_shared<const Obstacle>(make_kinds(), 30.0);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> part(-1.0, 1.0);
    int met = 0, planes = 0, same = 0;
    for (int trial = 0; trial < 40; ++trial) {
        const Vec3 drift = 0.3 * Vec3(part(random), part(random), part(random));
        const Vec3 fall(0.05 * part(random), 0.05 * part(random), -0.08 - 0.1 * std::abs(part(random)));
        const std::vector<Vec3> begin = sheet.at(Vec3(-0.12, -0.15, 0.07));
        // The obstacle drifts, and the cloth falls past it while it drifts along.
        const Obstacle after(*before, moved(before->mesh().points, drift));
        const ClothMotion carried =
            sheet.move_both(before, begin, moved(begin, drift), moved(begin, drift + fall));
        const SweepReport relative = check_sweep(*before, sheet.move(begin, moved(begin, fall)), kThickness);
        const SweepReport both = check_sweep(after, carried, kThickness);
        EXPECT_EQ(both.crossings, relative.crossings);
        EXPECT_EQ(both.intersections, relative.intersections);
        EXPECT_EQ(both.faces, relative.faces);
        // A cloth face reports its nine deepest meetings; rounding decides between equally deep ones.
        for (const ObstacleContact& a : both.violations) {
            const auto b = std::find_if(
                relative.violations.begin(), relative.violations.end(), [&](const ObstacleContact& other) {
                    return a.kind == other.kind && a.vertices == other.vertices && a.element == other.element;
                });
            ++planes;
            if (b == relative.violations.end()) continue;
            ++same;
            EXPECT_LT((a.normal - b->normal).norm(), 1e-9);
            EXPECT_LT((a.point - drift - b->point).norm(), 1e-9);
            EXPECT_NEAR(a.least_gap, b->least_gap, 1e-12);
        }
        met += relative.crossings > 0;
    }
    EXPECT_GT(met, 30);
    EXPECT_GT(same, 0.9 * planes) << planes;
}

TEST(MovingSides, FindsAnObstacleThatPassesThroughClothAtRest)
{
    const Sheet sheet;
    const auto before = std::make_shared<const Obstacle>(make_kinds(), 30.0);
    const Obstacle after(*before, moved(before->mesh().points, Vec3(0.0, 0.0, 0.3)));
    const std::vector<Vec3> rest = sheet.at(Vec3(-0.12, -0.15, 0.1));
    const std::vector<Vec3> risen = moved(rest, Vec3(0.0, 0.0, 0.3));
    const SweepReport report = check_sweep(after, sheet.move_both(before, rest, risen, rest), kThickness);
    EXPECT_FALSE(report.is_clean());
    EXPECT_GT(report.violations.size(), 4u);
    for (const ObstacleContact& contact : report.violations) {
        EXPECT_GT(contact.normal.z(), -1e-9);
        EXPECT_LT(contact.normal.dot(contact.at(rest) - contact.point), contact.least_gap);
    }
    // Rides along: nothing is met.
    const SweepReport riding = check_sweep(after, sheet.move_both(before, rest, risen, risen), kThickness);
    EXPECT_TRUE(riding.is_clean());
}

/// Cloth that rides on a turning obstacle keeps off: a rigid turn's way by chords is one to one below 180
/// degrees.
TEST(MovingSides, RidingOnATurningObstacleMeetsNothing)
{
    const Sheet sheet;
    const auto before = std::make_shared<const Obstacle>(make_kinds(), 30.0);
    const std::vector<Vec3> begin = sheet.at(Vec3(-0.12, -0.15, 0.051));
    for (const double degrees : {0.1, 1.0, 10.0, 45.0, 90.0, 150.0}) {
        const Placement turn{rotation_about(Vec3(0.3, 0.2, 1.0), degrees), Vec3(0.1, 0.2, 0.0)};
        std::vector<Vec3> points = before->mesh().points, end = begin;
        for (Vec3& p : points) p = turn(p);
        for (Vec3& x : end) x = turn(x);
        const Obstacle after(*before, points);
        EXPECT_TRUE(check_sweep(after, sheet.move_both(before, begin, end, end), kThickness).is_clean())
            << degrees;
    }
}

}  // namespace
/// A sheet that folds to a ridge under a cloth edge, whose ends ride down on both sides of the ridge while
/// the edge itself stays above: planes hold it up, though its carried ends are below.
TEST(MovingSides, AnEdgeStaysOnItsSideOfASheetThatFolds)
{
    const ObstacleMesh folded = {
        {{0, -1, 0}, {0, 1, 0}, {-1, 0, -0.2}, {1, 0, -0.2}}, {{0, 1, 2}, {1, 0, 3}}, {}, {}};
    const Obstacle after(folded, 5.0);
    const auto before = std::make_shared<const Obstacle>(
        after, std::vector<Vec3>{{0, -1, 0}, {0, 1, 0}, {-1, 0, 0}, {1, 0, 0}});
    const std::vector<Face> faces = {{0, 1, 2}};
    const std::vector<MeshEdge> edges = make_topology(3, faces).edges;
    const auto cloth = [](double z) {
        return std::vector<Vec3>{{-0.5, 0.1, z}, {0.5, 0.1, z}, {0.0, 0.1, 0.5}};
    };
    const std::vector<Vec3> begin = cloth(1e-4), carried = cloth(-0.1);
    for (const double end : {1e-5, -1e-3, -0.05}) {
        const ClothMotion motion = {&faces, &edges, carried, cloth(end),
                                    std::make_shared<const MovingSides>(MovingSides{before, begin})};
        std::vector<ObstacleContact> planes = check_sweep(after, motion, kThickness).violations;
        EXPECT_EQ(planes.empty(), end > 0.0);
        const auto found = find_edge_contacts(after, motion, motion.end, kThickness);
        EXPECT_EQ(found.size(), 1u);
        planes.insert(planes.end(), found.begin(), found.end());
        for (const ObstacleContact& plane : planes) {
            EXPECT_GT(plane.normal.z(), 0.9);
            EXPECT_GT(plane.least_gap, 0.0);
            EXPECT_LE(plane.least_gap, 1e-4 * (1.0 + 1e-9));
        }
    }
}

}  // namespace arris
