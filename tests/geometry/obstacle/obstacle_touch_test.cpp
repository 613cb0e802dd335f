// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle/obstacle_touch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "tests/geometry/sample_obstacles.h"

namespace arris {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

using Triangle = std::array<Vec3, 3>;

Obstacle obstacle_of(const ObstacleMesh& mesh)
{
    return Obstacle(mesh, 30.0);
}

ObstacleTouch touches_of(const Obstacle& obstacle, const Triangle& triangle)
{
    ObstacleTouch found;
    find_touches(obstacle, triangle, found);
    return found;
}

// An exact oracle in integers: shapes with corners on a small lattice.
using Lattice = Eigen::Matrix<long, 3, 1>;

long orientation(const Lattice& a, const Lattice& b, const Lattice& c, const Lattice& d)
{
    return (b - a).cross(c - a).dot(d - a);
}

bool is_on_segment(const Lattice& p, const Lattice& a, const Lattice& b)
{
    return (p - a).cross(p - b).isZero() && (p - a).dot(p - b) <= 0;
}

bool do_segments_meet(const Lattice& p, const Lattice& q, const Lattice& a, const Lattice& b)
{
    if (is_on_segment(p, a, b) || is_on_segment(q, a, b) || is_on_segment(a, p, q) || is_on_segment(b, p, q))
        return true;
    const Lattice normal = (q - p).cross(b - a);
    if (normal.isZero() || orientation(p, q, a, b) != 0) return false;
    const long t = (a - p).cross(b - a).dot(normal), u = (a - p).cross(q - p).dot(normal);
    return 0 <= t && t <= normal.dot(normal) && 0 <= u && u <= normal.dot(normal);
}

bool is_on_triangle(const Lattice& p, const std::array<Lattice, 3>& t)
{
    for (int i = 0; i < 3; ++i)
        if (is_on_segment(p, t[i], t[(i + 1) % 3])) return true;
    const Lattice normal = (t[1] - t[0]).cross(t[2] - t[0]);
    if (normal.isZero() || normal.dot(p - t[0]) != 0) return false;
    for (int i = 0; i < 3; ++i)
        if ((t[(i + 1) % 3] - t[i]).cross(p - t[i]).dot(normal) < 0) return false;
    return true;
}

bool do_meet(const Lattice& p, const Lattice& q, const std::array<Lattice, 3>& t)
{
    if (is_on_triangle(p, t) || is_on_triangle(q, t)) return true;
    for (int i = 0; i < 3; ++i)
        if (do_segments_meet(p, q, t[i], t[(i + 1) % 3])) return true;
    const long begin = orientation(t[0], t[1], t[2], p), end = orientation(t[0], t[1], t[2], q);
    if (begin == 0 || end == 0 || (begin > 0) == (end > 0)) return false;
    const long first = orientation(p, q, t[0], t[1]), second = orientation(p, q, t[1], t[2]),
               third = orientation(p, q, t[2], t[0]);
    return (first >= 0 && second >= 0 && third >= 0) || (first <= 0 && second <= 0 && third <= 0);
}

bool do_meet(const std::array<Lattice, 3>& s, const std::array<Lattice, 3>& t)
{
    for (int i = 0; i < 3; ++i)
        if (do_meet(s[i], s[(i + 1) % 3], t) || do_meet(t[i], t[(i + 1) % 3], s)) return true;
    return false;
}

class Lattices {
  public:
    Lattice point() { return {number_(random_), number_(random_), number_(random_)}; }
    std::array<Lattice, 3> triangle() { return {point(), point(), point()}; }

  private:
    std::mt19937 random_{11};
    std::uniform_int_distribution<long> number_{0, 3};
};

Vec3 to_real(const Lattice& p)
{
    return p.cast<double>();
}

TEST(ObstacleTouch, IsThatOfWholeNumbersOnALatticeWhereNothingIsInGeneralPosition)
{
    Lattices random;
    int counts[2] = {0, 0}, degenerate = 0;
    for (int i = 0; i < 20000; ++i) {
        const std::array<Lattice, 3> face = random.triangle(), cloth = random.triangle();
        const std::array<Lattice, 2> segment = {random.point(), random.point()};
        const Lattice nail = random.point();
        if ((face[1] - face[0]).cross(face[2] - face[0]).isZero() || segment[0] == segment[1]) continue;
        degenerate += (cloth[1] - cloth[0]).cross(cloth[2] - cloth[0]).isZero() ? 1 : 0;
        ObstacleMesh mesh;
        mesh.points = {to_real(face[0]),    to_real(face[1]),    to_real(face[2]),
                       to_real(segment[0]), to_real(segment[1]), to_real(nail)};
        mesh.faces = {{0, 1, 2}};
        mesh.segments = {{3, 4}};
        mesh.lone_points = {5};
        const Obstacle obstacle = obstacle_of(mesh);
        const ObstacleTouch touch =
            touches_of(obstacle, {to_real(cloth[0]), to_real(cloth[1]), to_real(cloth[2])});
        ASSERT_EQ(!touch.faces.empty(), do_meet(cloth, face)) << i;
        ASSERT_EQ(!touch.segments.empty(), do_meet(segment[0], segment[1], cloth)) << i;
        ASSERT_EQ(!touch.lone_points.empty(), is_on_triangle(nail, cloth)) << i;
        ++counts[touch.faces.empty() ? 0 : 1];
    }
    EXPECT_GT(counts[0], 3000);
    EXPECT_GT(counts[1], 3000);
    EXPECT_GT(degenerate, 500);
}

TEST(ObstacleTouch, NamesEdgesOfTheTopologyAndPointsOfTheMesh)
{
    // A wire and a nail are listed after a box, whose edges and corners come first among the features.
    const ObstacleMesh wire = samples::wire({{5, 0, 0}, {6, 0, 0}, {7, 1, 0}}, false);
    const ObstacleMesh nail = samples::nails({{9, 0, 0}});
    const Obstacle obstacle =
        obstacle_of(samples::together(samples::together(samples::box({0, 0, 0}, {1, 1, 1}), wire), nail));
    const int first = obstacle.topology().surface_edge_count;
    const auto across = [](double x) { return Triangle{Vec3(x, -1, -1), Vec3(x, 1, -1), Vec3(x, 0, 1)}; };
    EXPECT_THAT(touches_of(obstacle, across(5.5)).segments, ElementsAre(first));
    EXPECT_THAT(touches_of(obstacle, across(6)).segments, ElementsAre(first, first + 1));
    EXPECT_THAT(touches_of(obstacle, across(5.5)).faces, IsEmpty());
    EXPECT_THAT(touches_of(obstacle, across(9)).lone_points, ElementsAre(11));
    EXPECT_FALSE(touches_of(obstacle, across(3)).is_any());
    EXPECT_TRUE(touches_of(obstacle, across(0.5)).is_any());
    // Contacts at ends of wires and corners of boxes are reported as edges and faces, not as points.
    EXPECT_THAT(touches_of(obstacle, across(5)).lone_points, IsEmpty());
    EXPECT_THAT(touches_of(obstacle, across(5)).segments, ElementsAre(first));
}

TEST(ObstacleTouch, OneRoundingErrorDecides)
{
    const Obstacle box = obstacle_of(samples::box({-1, -1, -1}, {1, 1, 1}));
    const double above = std::nextafter(1.0, 2.0);
    EXPECT_FALSE(touches_of(box, {Vec3(-3, -3, above), Vec3(3, -3, above), Vec3(0, 3, above)}).is_any());
    EXPECT_TRUE(touches_of(box, {Vec3(-3, -3, 1), Vec3(3, -3, 1), Vec3(0, 3, 1)}).is_any());
    EXPECT_TRUE(touches_of(box, {Vec3(1, 1, 1), Vec3(3, 1, 2), Vec3(1, 3, 2)}).is_any());
    EXPECT_FALSE(touches_of(box, {Vec3(above, 1, 1), Vec3(3, 1, 2), Vec3(1, 3, 2)}).is_any());

    const Obstacle nail = obstacle_of(samples::nails({{0.25, 0.25, 0.1}}));
    const double off = std::nextafter(0.1, 1.0);
    EXPECT_TRUE(touches_of(nail, {Vec3(0, 0, 0.1), Vec3(1, 0, 0.1), Vec3(0, 1, 0.1)}).is_any());
    EXPECT_FALSE(touches_of(nail, {Vec3(0, 0, off), Vec3(1, 0, off), Vec3(0, 1, off)}).is_any());
}

TEST(ObstacleTouch, MiddleIsOnBothAtAnySizeAndPlace)
{
    std::mt19937 random(2);
    std::normal_distribution<double> number;
    for (const double size : {1e-6, 1.0, 1e6})
        for (const double offset : {0.0, 1e4}) {
            int met = 0;
            for (int i = 0; i < 500; ++i) {
                Triangle triangles[2];
                for (Triangle& t : triangles)
                    for (Vec3& p : t)
                        p = size *
                            (Vec3(number(random), number(random), number(random)) + Vec3::Constant(offset));
                ObstacleMesh mesh;
                mesh.points = {triangles[0][0], triangles[0][1], triangles[0][2]};
                mesh.faces = {{0, 1, 2}};
                if (!touches_of(obstacle_of(mesh), triangles[1]).is_any()) continue;
                ++met;
                const Vec3 middle = middle_of_touch(triangles[0], triangles[1]);
                for (const Triangle& t : triangles) {
                    const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
                    // The tolerance is 1e-9 of the triangles' size; coordinates have rounding, and some
                    // triangles are needles.
                    EXPECT_NEAR(normal.dot(middle - t[0]), 0.0, size * (1e-8 + 1e-11 * offset));
                }
            }
            EXPECT_GT(met, 50);
        }
}

TEST(ObstacleTouch, MiddleOfATouchInAPointIsThatPoint)
{
    const Triangle flat = {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(0, 2, 0)};
    const Triangle upright = {Vec3(0.5, 0.5, 0), Vec3(0.5, 0, 1), Vec3(0.5, 1, 1)};
    EXPECT_LT((middle_of_touch(flat, upright) - Vec3(0.5, 0.5, 0)).norm(), 1e-15);
    const Triangle line = {Vec3(0.3, 0.4, -1), Vec3(0.3, 0.4, 1), Vec3(0.3, 0.4, 1)};
    EXPECT_LT((middle_of_touch(flat, line) - Vec3(0.3, 0.4, 0)).norm(), 1e-15);
}

}  // namespace
}  // namespace arris
