// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "geometry/contact/obstacle_contact.h"
#include "tests/geometry/contact_scene.h"
#include "tests/geometry/sample_obstacles.h"

namespace arris {
namespace {

constexpr double kThickness = 1e-3;
constexpr double kRounding = 1e-12;  // for coordinates near 1

Vec3 slide_one(const Obstacle& obstacle, const Vec3& begin, const Vec3& end, double thickness = kThickness)
{
    return slide(obstacle, samples::points_way({begin}, {end}), thickness)[0];
}

TEST(Slide, LeavesAFreeWayAsItIs)
{
    const Obstacle box = samples::make_obstacle(samples::box({0, 0, 0}, {1, 1, 1}));
    for (const Vec3& end : {Vec3(0.1, 0.2, 1.0 + 1e-9), Vec3(5, 5, 5), Vec3(-1, 0.5, 0.5)})
        EXPECT_EQ(slide_one(box, {-0.5, 0.2, 1.5}, end), end);
}

TEST(Slide, StopsAFallThroughAThinPlateAboveIt)
{
    const Obstacle plate = samples::make_obstacle(samples::box({-1, -1, 0}, {1, 1, 1e-3}));
    const Vec3 end = slide_one(plate, {0.11, 0.23, 0.06}, {0.13, 0.20, -0.04});
    EXPECT_NEAR(end.x(), 0.13, kRounding);  // the whole motion along the plate
    EXPECT_NEAR(end.y(), 0.20, kRounding);
    EXPECT_NEAR(end.z(), 2e-3, kRounding);  // at the stand-off
}

TEST(Slide, GlidesOnATopAtItsOwnHeight)
{
    const Obstacle box = samples::make_obstacle(samples::box({0, 0, 0}, {1, 1, 1}));
    for (const double height : {1e-3, 4e-4, 1e-9}) {
        const Vec3 end = slide_one(box, {0.2, 0.2, 1.0 + height}, {0.3, 0.25, 0.9});
        EXPECT_NEAR(end.z() - 1.0, height, kRounding);
        EXPECT_LT((end - Vec3(0.3, 0.25, end.z())).norm(), kRounding);
    }
    // Beyond the rim the motion continues straight ahead.
    EXPECT_LT((slide_one(box, {0.9, 0.5, 1.001}, {1.2, 0.5, 0.99}) - Vec3(1.2, 0.5, 1.001)).norm(),
              kRounding);
}

TEST(Slide, MeetsASideRatherThanTheRimInWhosePlaneItMoves)
{
    ObstacleMesh mesh = samples::box({0, 0, 0}, {1, 1, 1});
    const Obstacle straight = samples::make_obstacle(mesh);
    std::reverse(mesh.faces.begin(), mesh.faces.end());
    const Obstacle reversed = samples::make_obstacle(mesh);
    for (const double turn : {0.0, 0.5, 1.0, 1.5}) {  // each of the four sides, for any order of faces
        const Mat3 rotation = Eigen::AngleAxisd(turn * M_PI, Vec3::UnitZ()).toRotationMatrix();
        const Vec3 centre(0.5, 0.5, 0);
        const auto turned = [&](double x, double y, double z) {
            return Vec3(rotation * Vec3(x, y, z) + centre);
        };
        for (const double z : {0.0, 1.0}) {
            Vec3 begin = turned(0.6, 0.0, z), end = turned(0.4, 0.1, z);
            begin.z() = end.z() = z;
            for (const Obstacle* box : {&straight, &reversed})
                EXPECT_LT((slide_one(*box, begin, end) - turned(0.5 + kThickness, 0.1, z)).norm(), 1e-9);
        }
    }
}

TEST(Slide, KeepsToItsSideOfASheet)
{
    const Obstacle sheet = samples::make_obstacle(samples::sheet(3, 3, [](int, int) { return 0.0; }));
    for (const double side : {1.0, -1.0}) {
        const Vec3 end = slide_one(sheet, {1.2, 1.3, 0.1 * side}, {1.25, 1.3, -0.2 * side});
        EXPECT_NEAR(end.z(), kThickness * side, kRounding);
        EXPECT_NEAR(end.x(), 1.25, kRounding);
        // Head-on against the rim no side is preferred.
        const Vec3 before = slide_one(sheet, {-0.5, 1.3, 0.0}, {0.5, 1.3, 0.0});
        EXPECT_LT(before.x(), 0.0);
        EXPECT_GT(before.x(), -2.0 * kThickness);
    }
}

TEST(Slide, EndsInAReflexCorner)
{
    const Obstacle room = samples::make_obstacle(samples::inside_out(samples::box({0, 0, 0}, {1, 1, 1})));
    const Vec3 corner = slide_one(room, {0.3, 0.2, 0.4}, {-0.3, -0.4, -0.2});
    for (int d = 0; d < 3; ++d) {
        EXPECT_GT(corner[d], 0.0);
        EXPECT_LE(corner[d], 1.01 * kThickness);
    }
    const Vec3 edge = slide_one(room, {0.3, 0.2, 0.4}, {-0.3, -0.4, 0.5});
    EXPECT_NEAR(edge.x(), kThickness, 1e-2 * kThickness);
    EXPECT_NEAR(edge.y(), kThickness, 1e-2 * kThickness);
    EXPECT_NEAR(edge.z(), 0.5, kRounding);
}

TEST(Slide, GoesAlongAnAcuteReflexEdge)
{
    // A valley of 40 degrees along y. The motion leads into the valley and a little along it.
    const double w = std::tan(20.0 * M_PI / 180.0);
    const Obstacle valley =
        samples::make_obstacle(samples::sheet(2, 3, [&](int i, int) { return std::abs(i - 1) / w; }));
    const Vec3 end = slide_one(valley, {0.99, 1.0, 0.5}, {1.05, 1.7, -1.0});
    EXPECT_NEAR(end.y(), 1.7, 1e-9);
    EXPECT_GT(end.z(), 0.0);
    EXPECT_LT(end.z(), 5.0 * kThickness / w);
}

TEST(Slide, SlidesInABowlAndOverABall)
{
    const ObstacleMesh ball = samples::sphere(50, 100);
    const Obstacle outside = samples::make_obstacle(ball),
                   bowl = samples::make_obstacle(samples::inside_out(ball));
    const Vec3 over = slide_one(outside, {0.1, 0.0, 1.02}, {0.2, 0.0, 0.9});
    EXPECT_GT(over.norm(), 1.0);
    EXPECT_NEAR(over.x(), 0.2, 0.02);
    const Vec3 within = slide_one(bowl, {0.3, 0.1, -0.9}, {0.35, 0.15, -1.1});
    EXPECT_LT(within.norm(), 1.0);
    EXPECT_GT(within.norm(), 0.99);
    EXPECT_FALSE(samples::is_inside(ball, 1.01 * within.normalized()));
}

enum class Free { Outside, Inside };

// A place on the free side of a closed surface must stay there and never reach the surface.
void expect_never_through(const ObstacleMesh& mesh, int count, Free side = Free::Outside)
{
    const bool is_cavity = side == Free::Inside;
    const Obstacle obstacle = samples::make_obstacle(is_cavity ? samples::inside_out(mesh) : mesh);
    const Box3& bounds = obstacle.bounds();
    const double size = bounds.diagonal().norm();
    std::mt19937 engine(7);
    std::uniform_real_distribution<double> uniform(-0.7, 0.7);
    const auto anywhere = [&] {
        return Vec3(bounds.center() + size * Vec3(uniform(engine), uniform(engine), uniform(engine)));
    };
    std::vector<Vec3> begin, end;
    while (static_cast<int>(begin.size()) < count) {
        const Vec3 p = anywhere();
        if (samples::is_inside(mesh, p) != is_cavity) continue;
        begin.push_back(p);
        end.push_back(anywhere());
        // The start may also be barely above the surface.
        const Vec3 q = samples::nearest_point(mesh, p);
        const Vec3 close = q + 1e-9 * (p - q);
        if (samples::is_inside(mesh, close) != is_cavity) continue;
        begin.push_back(close);
        end.push_back(anywhere());
    }
    const std::vector<Vec3> reference = slide(obstacle, samples::points_way(begin, end), 1e-3 * size);
    std::vector<int> found;
    int moved = 0;
    for (std::size_t i = 0; i < begin.size(); ++i) {
        EXPECT_EQ(samples::is_inside(mesh, reference[i]), is_cavity) << i;
        obstacle.find_faces_touching(reference[i], reference[i], found);
        EXPECT_TRUE(found.empty());
        if (reference[i] != end[i]) ++moved;
    }
    EXPECT_GT(moved, count / 10);
}

TEST(Slide, NeverCrossesASurface)
{
    for (const ObstacleMesh& mesh : {samples::box({0, 0, 0}, {1, 1, 1e-4}), samples::l_prism(),
                                     samples::teeth(4), samples::sphere(10, 20), samples::cone(12, 0.2)}) {
        expect_never_through(mesh, 1000);
        expect_never_through(mesh, 300, Free::Inside);
        expect_never_through(samples::moved(mesh, [](const Vec3& p) { return Vec3(1e-6 * p); }), 300);
        expect_never_through(samples::moved(mesh, [](const Vec3& p) { return Vec3(1e6 * p); }), 300);
    }
}

TEST(Slide, LeavesWhatIsNoNumber)
{
    const Obstacle box = samples::make_obstacle(samples::box({0, 0, 0}, {1, 1, 1}));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(slide_one(box, {0.5, 0.5, 2}, {0.5, nan, 0.5}).allFinite());
}

TEST(Slide, IsTheSameForAnyNumberOfThreads)
{
    const Obstacle ball = samples::make_obstacle(samples::sphere(20, 40));
    const std::vector<Vec3> begin = samples::grid_points(40, 40, {-1, -1, 1.2}, {0.05, 0, 0}, {0, 0.05, 0});
    const ClothMotion motion = samples::points_way(begin, samples::shifted(begin, {0.1, 0, -0.7}));
    const std::vector<Vec3> expected = slide(ball, motion, kThickness);
    for (const int threads : {1, 2, 4}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        EXPECT_EQ(slide(ball, motion, kThickness), expected);
    }
}

}  // namespace
}  // namespace arris
