// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle/surface_ride.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "geometry/obstacle/moving_obstacle.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "tests/formula_deformation.h"

namespace arris {
namespace {

Vec3 random_vector(std::mt19937& random)
{
    std::uniform_real_distribution<double> part(-1.0, 1.0);
    return {part(random), part(random), part(random)};
}

/// A box, a wire with a bend, and a nail.
ObstacleMesh make_all_kinds()
{
    ObstacleMesh mesh = make_box({0.4, 0.3, 0.2});
    const int first = static_cast<int>(mesh.points.size());
    for (const Vec3& p : {Vec3(1, 0, 0), Vec3(1.2, 0.1, 0), Vec3(1.3, 0.3, 0.1), Vec3(2, 0, 0)})
        mesh.points.push_back(p);
    mesh.segments = {{first, first + 1}, {first + 1, first + 2}};
    mesh.lone_points = {first + 3};
    return mesh;
}

/// Places near each kind of element, in the frame of the mesh.
const std::vector<Vec3> kPlaces = {{0.05, 0.02, 0.11},  {0.2, 0.03, 0.11},  {0.21, 0.16, 0.11},
                                   {-0.21, 0.05, 0.02}, {1.1, 0.05, 0.02},  {1.22, 0.08, -0.02},
                                   {0.99, 0.0, 0.01},   {2.01, 0.01, 0.01}, {1.26, 0.2, 0.0}};

TEST(SurfaceRide, FindsTheElementBelow)
{
    const Obstacle obstacle(make_all_kinds(), 30.0);
    const std::vector<SurfaceKind> kinds = {SurfaceKind::Triangle, SurfaceKind::Edge,  SurfaceKind::Point,
                                            SurfaceKind::Triangle, SurfaceKind::Edge,  SurfaceKind::Point,
                                            SurfaceKind::Point,    SurfaceKind::Point, SurfaceKind::Edge};
    for (std::size_t k = 0; k < kPlaces.size(); ++k) {
        const auto on = find_nearest(obstacle, kPlaces[k], 1.0);
        ASSERT_TRUE(on) << k;
        EXPECT_EQ(on->kind, kinds[k]) << k;
        EXPECT_NEAR(on->weights[0] + on->weights[1] + on->weights[2], 1.0, 1e-15);
        EXPECT_LT((on->at(obstacle.mesh().points) - kPlaces[k]).norm(), 0.05);
    }
    EXPECT_FALSE(find_nearest(obstacle, Vec3(0, 0, 0.2), 0.09));
    EXPECT_TRUE(find_nearest(obstacle, Vec3(0, 0, 1000.0), std::numeric_limits<double>::infinity()));
}

TEST(SurfaceRide, IsTheObstaclesOwnMotionWhereThatIsRigid)
{
    std::mt19937 random(3);
    const Obstacle from(make_all_kinds(), 30.0);
    for (int trial = 0; trial < 20; ++trial) {
        const Placement motion{rotation_about(random_vector(random), 200.0 * random_vector(random).x()),
                               random_vector(random)};
        std::vector<Vec3> points = from.mesh().points;
        for (Vec3& p : points) p = motion(p);
        const Obstacle to(from, std::move(points));
        for (const Vec3& place : kPlaces) {
            const auto on = find_nearest(from, place, 1.0);
            // A wire does not show its turn about itself, a nail none: their own places are carried.
            const bool is_on_faces = place.x() < 0.5;
            const Vec3 rider = is_on_faces ? place : on->at(from.mesh().points);
            EXPECT_LT((find_way(from, to, *on)(rider) - motion(rider)).norm(), 1e-13);
        }
    }
}

TEST(SurfaceRide, ItsVelocityIsTheDerivativeOfItsWay)
{
    constexpr double kDt = 1e-5, kError = 1e-8;
    std::mt19937 random(5);
    const Obstacle rest(make_all_kinds(), 30.0);
    std::vector<Vec3> velocities;
    for (std::size_t p = 0; p < rest.mesh().points.size(); ++p) velocities.push_back(random_vector(random));
    const auto pose_at = [&](double time) {
        std::vector<Vec3> points = rest.mesh().points;
        for (std::size_t p = 0; p < points.size(); ++p) points[p] += time * velocities[p];
        return Obstacle(rest, std::move(points));
    };
    const Obstacle before = pose_at(-kDt), after = pose_at(kDt);
    for (const Vec3& place : kPlaces) {
        const auto on = find_nearest(rest, place, 1.0);
        const Vec3 difference =
            (find_way(rest, after, *on)(place) - find_way(rest, before, *on)(place)) / (2.0 * kDt);
        EXPECT_LT((riding_velocity(rest, velocities, *on, place) - difference).norm(), kError)
            << place.transpose();
    }
}

TEST(SurfaceRide, StaysFiniteWhereFacesLoseTheirArea)
{
    const Obstacle from(make_all_kinds(), 30.0);
    for (const Vec3& keep : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0)}) {
        std::vector<Vec3> points = from.mesh().points;
        for (Vec3& p : points) p = p.cwiseProduct(keep);
        const Obstacle to(from, points);
        std::vector<int> found;
        to.find_faces(to.bounds(), found);
        EXPECT_EQ(found.size(), 12u);
        for (const Vec3& place : kPlaces) {
            const auto on = find_nearest(from, place, 1.0);
            EXPECT_TRUE(find_way(from, to, *on)(place).allFinite());
            EXPECT_TRUE(find_way(to, from, *on)(place).allFinite());
            EXPECT_TRUE(riding_velocity(to, points, *on, place).allFinite());
        }
        if (keep.x() > 0.0) {
            to.find_faces_touching(Vec3(0.05, 0.01, -1), Vec3(0.05, 0.01, 1), found);
            EXPECT_EQ(found.empty(), keep.y() == 0.0);
            to.find_faces_touching(Vec3(0.05, -1, -1), Vec3(0.05, 1, -1), Vec3(0.05, 0, 1), found);
            EXPECT_FALSE(found.empty());
        }
    }
}

TEST(MovingObstacle, CarriesItsDeformationWithItsMotion)
{
    const ObstacleMesh mesh = make_box({2, 2, 2});
    const auto grow = [](const Vec3& rest, double time) { return Vec3((1.0 + time) * rest); };
    const auto speed = [](const Vec3& rest, double) { return rest; };
    RigidMotion motion;
    motion.velocity = Vec3(0, 0, 3);
    motion.angular_velocity = Vec3(0, 0, 1);
    const Placement placement{rotation_about(Vec3::UnitX(), 90.0), Vec3(5, 0, 0)};
    const MovingObstacle moving("it", mesh, placement, motion, 45.0,
                                std::make_shared<FormulaDeformation>(mesh.points, grow, speed));
    const MovingObstacle rigid("it", mesh, placement, motion, 45.0);
    EXPECT_TRUE(moving.is_moving());
    for (const double time : {0.0, 0.5, 1.0, 0.5, 0.25, 2.0, 3.0, 4.0, 0.0}) {
        const std::vector<Vec3> points = moving.points_at(time);
        for (std::size_t p = 0; p < points.size(); ++p) {
            const Vec3 own = (1.0 + time) * mesh.points[p];
            const Vec3 world = rigid.at(time).placement(own);
            EXPECT_LT((points[p] - world).norm(), 1e-14);
            EXPECT_LT((moving.velocity_after(time, world) - rigid.velocity_after(time, world) -
                       rigid.at(time).placement.rotation * mesh.points[p])
                          .norm(),
                      1e-12);
        }
    }
}

TEST(MovingObstacle, KeepsTheFeaturesOfAllItsPoses)
{
    // A book: two covers that share a spine, flat at first, and folded by 120 degrees at the end.
    const ObstacleMesh mesh = {{{-1, 0, 0}, {-1, 1, 0}, {0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}},
                               {{0, 2, 3}, {0, 3, 1}, {2, 4, 5}, {2, 5, 3}},
                               {},
                               {}};
    const auto fold = [](const Vec3& rest, double time) {
        return rest.x() > 0.0 ? Vec3(rotation_about(-Vec3::UnitY(), 120.0 * time) * rest) : rest;
    };
    const auto still = [](const Vec3&, double) { return Vec3(Vec3::Zero()); };
    const MovingObstacle book(
        "book", mesh, {}, {}, 45.0,
        std::make_shared<FormulaDeformation>(mesh.points, fold, still, std::vector<double>{0.0, 0.5, 1.0}));
    const auto spine = [&](const Obstacle& pose) {
        const std::vector<FeatureEdge>& edges = pose.features().edges;
        return std::find_if(edges.begin(), edges.end(),
                            [](const FeatureEdge& edge) { return edge.kind == FeatureKind::Convex; });
    };
    std::vector<int> found;
    for (const auto& [time, is_awake] : {std::pair(0.0, false), {0.3, false}, {0.45, true}, {1.0, true}}) {
        const ObstaclePose pose = book.at(time);
        ASSERT_EQ(pose->features().edges.size(), 7u) << time;
        ASSERT_NE(spine(pose), pose->features().edges.end());
        EXPECT_EQ(spine(pose)->is_awake, is_awake) << time;
        pose->find_feature_edges(Box3(Vec3(-0.1, 0.4, -0.1), Vec3(0.1, 0.6, 0.1)), found);
        EXPECT_EQ(found.size(), is_awake ? 1u : 0u) << time;
    }
}

}  // namespace
}  // namespace arris
