// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/check/penetration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <Eigen/Geometry>
#include <chrono>
#include <cmath>
#include <numbers>
#include <random>

#include "geometry/closest_point.h"
#include "tests/geometry/sample_obstacles.h"

namespace arris {
namespace {

// Relative accuracy of the depth promised by the header.
constexpr double kAccuracy = 0.01;

Obstacle obstacle_of(const ObstacleMesh& mesh)
{
    return Obstacle(mesh, 30.0);
}

struct Cloth {
    std::vector<Vec3> positions;
    std::vector<Face> faces;
};

/// Cloth of n x n cells over the parallelogram from `corner` along `u` and `v`.
Cloth cloth(int n, const Vec3& corner, const Vec3& u, const Vec3& v)
{
    Cloth made;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) made.positions.push_back(corner + (i * u + j * v) / n);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const int a = i * (n + 1) + j, b = a + n + 1;
            made.faces.push_back({a, b, b + 1});
            made.faces.push_back({a, b + 1, a + 1});
        }
    return made;
}

/// Level cloth of half-width `half` about the z axis.
Cloth level(int n, double z, double half)
{
    return cloth(n, {-half, -half, z}, {2 * half, 0, 0}, {0, 2 * half, 0});
}

Cloth triangle(const Vec3& a, const Vec3& b, const Vec3& c)
{
    return {{a, b, c}, {{0, 1, 2}}};
}

Penetration penetration_of(const Obstacle& obstacle, const Cloth& cloth)
{
    return find_penetration(obstacle, cloth.positions, cloth.faces);
}

// Oracles: the definitions evaluated face by face.
double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c)
{
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    return 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

double winding_by_angles(const ObstacleMesh& mesh, const Vec3& p)
{
    double sum = 0.0;
    for (const auto& [a, b, c] : mesh.faces)
        sum += solid_angle(mesh.points[a] - p, mesh.points[b] - p, mesh.points[c] - p);
    return sum / (4.0 * std::numbers::pi);
}

double distance_to_surface(const ObstacleMesh& mesh, const Vec3& p)
{
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [a, b, c] : mesh.faces) {
        const Vec3 normal =
            (mesh.points[b] - mesh.points[a]).cross(mesh.points[c] - mesh.points[a]).normalized();
        const PointOnTriangle on =
            closest_on_triangle(p, {mesh.points[a], mesh.points[b], mesh.points[c]}, normal);
        least = std::min(least, (p - on.point).norm());
    }
    return least;
}

double depth_of(const ObstacleMesh& mesh, const Vec3& p)
{
    return std::abs(winding_by_angles(mesh, p)) > 0.5 ? distance_to_surface(mesh, p) : 0.0;
}

const ObstacleMesh kBox = samples::box({-1, -1, -1}, {1, 1, 1});

TEST(WindingNumber, IsThatOfTheSolidAngle)
{
    const ObstacleMesh small = samples::box({-.3, -.3, -.3}, {.3, .3, .3});
    const std::vector<ObstacleMesh> meshes = {
        kBox,
        samples::l_prism(),
        samples::teeth(3),
        samples::sphere(8, 10),
        samples::inside_out(kBox),
        samples::together(kBox, samples::inside_out(small)),
        samples::together(kBox,
                          samples::moved(kBox, [](const Vec3& p) { return Vec3(p + Vec3(1, .5, .3)); })),
    };
    std::mt19937 random(4);
    std::uniform_real_distribution<double> number(-1.5, 3.5);
    for (const ObstacleMesh& mesh : meshes) {
        const Obstacle obstacle = obstacle_of(mesh);
        for (int i = 0; i < 500; ++i) {
            const Vec3 p(number(random), number(random), number(random));
            ASSERT_EQ(winding_number(obstacle, p), std::lround(winding_by_angles(mesh, p))) << p.transpose();
        }
    }
}

TEST(WindingNumber, NestedAndOverlappingSolidsAddUp)
{
    const ObstacleMesh inner = samples::box({-.5, -.5, -.5}, {.5, .5, .5});
    const Obstacle hollow = obstacle_of(samples::together(kBox, samples::inside_out(inner)));
    EXPECT_EQ(winding_number(hollow, {0, 0, 0}), 0);
    EXPECT_EQ(winding_number(hollow, {0.75, 0, 0}), 1);
    const Obstacle twice = obstacle_of(samples::together(kBox, inner));
    EXPECT_EQ(winding_number(twice, {0, 0, 0}), 2);
    EXPECT_EQ(winding_number(twice, {0.75, 0, 0}), 1);
    EXPECT_EQ(winding_number(twice, {1.75, 0, 0}), 0);
    EXPECT_EQ(winding_number(obstacle_of(samples::inside_out(kBox)), {0, 0, 0}), -1);
}

TEST(WindingNumber, HasNothingToDoWithSheetsWiresAndNails)
{
    ObstacleMesh open = kBox;
    open.faces.pop_back();
    EXPECT_EQ(winding_number(obstacle_of(open), {0, 0, 0}), 0);
    EXPECT_EQ(winding_number(obstacle_of(samples::wire({{-1, 0, 0}, {1, 0, 0}}, false)), {0, 0, 0}), 0);
    EXPECT_EQ(winding_number(obstacle_of(samples::together(kBox, open)), {0, 0, 0}), 1);
    EXPECT_EQ(winding_number(obstacle_of({}), {0, 0, 0}), 0);
}

TEST(WindingNumber, IsExactUpToTheSurfaceAtAnySizeAndPlace)
{
    for (const double size : {1e-6, 1.0, 1e6})
        for (const double offset : {0.0, 1e3, 1e6}) {
            const Vec3 centre = Vec3::Constant(offset);
            const ObstacleMesh mesh =
                samples::box(centre - Vec3::Constant(size), centre + Vec3::Constant(size));
            const Obstacle obstacle = obstacle_of(mesh);
            for (int axis = 0; axis < 3; ++axis)
                for (const double end : {-1.0, 1.0}) {
                    Vec3 p = centre;
                    p[axis] = end > 0 ? obstacle.bounds().max()[axis] : obstacle.bounds().min()[axis];
                    EXPECT_EQ(winding_number(obstacle, p), 0) << "on it";
                    const double on = p[axis];
                    p[axis] = std::nextafter(on, end * 1e30);
                    EXPECT_EQ(winding_number(obstacle, p), 0);
                    p[axis] = std::nextafter(on, -end * 1e30);
                    EXPECT_EQ(winding_number(obstacle, p), 1) << size << " " << offset;
                }
        }
}

TEST(WindingNumber, PointsOfTheSurfaceHaveNone)
{
    const ObstacleMesh mesh = samples::l_prism();
    const Obstacle obstacle = obstacle_of(mesh);
    for (const Vec3& p : mesh.points) EXPECT_EQ(winding_number(obstacle, p), 0);
    for (const auto& [a, b, c] : mesh.faces) {
        EXPECT_EQ(winding_number(obstacle, (mesh.points[a] + mesh.points[b]) / 2), 0);
        EXPECT_EQ(winding_number(obstacle, mesh.points[a] / 2 + mesh.points[b] / 4 + mesh.points[c] / 4), 0);
    }
}

TEST(WindingNumber, AWayOutThroughEdgesAndCornersIsTakenAnother)
{
    // The winding number is first counted along one ray from the origin. The test finds that ray's direction:
    // a sheet fixes the bounds, and boxes have an edge or a corner exactly on the ray. There a count of
    // crossings is wrong by one.
    const double z = 1.0 - 1.0 / 64, r = std::sqrt(1.0 - z * z);
    ObstacleMesh frame = samples::box({-10, -10, -10}, {10, 10, 10});
    frame.faces.pop_back();
    const double length = 2.0 * std::sqrt(1200.0);
    const Vec3 on = length * Vec3(r, 0, z) / 16.0;  // a sixteenth is exact
    for (const Vec3& low : {Vec3(-1, -.5, -1), Vec3(-1, -1, -1), Vec3(-.5, -.5, 0), Vec3(0, -.5, -1)})
        for (const double flip : {0.0, 1.0}) {
            const Vec3 begin = on + low + flip * Vec3(0, 0.5, 0);
            ObstacleMesh box = samples::box(begin, begin + Vec3(1, 1, 1));
            for (Vec3& p : box.points)  // puts these coordinates exactly on the point
                for (int k = 0; k < 3; ++k)
                    if (std::abs(p[k] - on[k]) < 1e-9) p[k] = on[k];
            EXPECT_EQ(winding_number(obstacle_of(samples::together(frame, box)), {0, 0, 0}), 0)
                << low.transpose();
        }
}

TEST(Penetration, NothingWhereTheClothIsClear)
{
    const Obstacle box = obstacle_of(kBox);
    for (const double z : {1.0 + 1e-15, 1.001, 5.0, 1e6, -1.0 - 1e-15}) {
        const Penetration found = penetration_of(box, level(4, z, 3));
        EXPECT_FALSE(found.is_any()) << z;
        EXPECT_EQ(found.depth, 0.0);
        EXPECT_EQ(found.faces, 0);
    }
    EXPECT_FALSE(penetration_of(box, {}).is_any());
    EXPECT_FALSE(penetration_of(obstacle_of({}), level(2, 0, 1)).is_any());
}

TEST(Penetration, TouchingIsFoundAndHasNoDepth)
{
    const Obstacle box = obstacle_of(kBox);
    const Penetration lying = penetration_of(box, level(4, 1.0, 3));
    EXPECT_TRUE(lying.is_any());
    EXPECT_EQ(lying.depth, 0.0);
    EXPECT_GE(lying.faces, 8);
    EXPECT_NEAR(lying.place.z(), 1.0, 1e-15);
    EXPECT_LE(lying.place.cwiseAbs().maxCoeff(), 1.0 + 1e-9);

    const Penetration corner = penetration_of(box, triangle({1, 1, 1}, {3, 1, 2}, {1, 3, 2}));
    EXPECT_EQ(corner.faces, 1);
    EXPECT_EQ(corner.face, 0);
    EXPECT_EQ(corner.depth, 0.0);
    EXPECT_LT((corner.place - Vec3(1, 1, 1)).norm(), 1e-12);

    // The cloth is over an edge, and its plane contains the edge.
    const Penetration edge = penetration_of(box, triangle({1, -3, 1}, {1, 3, 1}, {3, 0, 2}));
    EXPECT_EQ(edge.faces, 1);
    EXPECT_EQ(edge.depth, 0.0);
    const Penetration across = penetration_of(box, cloth(4, {0, -3, 2}, {2, 0, -2}, {0, 6, 0}));
    EXPECT_GT(across.faces, 0);
    EXPECT_EQ(across.depth, 0.0);
}

TEST(Penetration, ALevelClothInsideIsAsDeepAsItLies)
{
    const Obstacle box = obstacle_of(kBox);
    for (const double depth : {0.1, 1e-3, 1e-9}) {
        const Penetration found = penetration_of(box, level(4, 1.0 - depth, 0.5));
        EXPECT_EQ(found.faces, 0);
        EXPECT_NEAR(found.depth, depth, 1e-15 + 1e-12 * depth);
        EXPECT_TRUE(found.is_any());
        EXPECT_NEAR(found.place.z(), 1.0 - depth, 1e-15);
    }
}

TEST(Penetration, AClothFaceIsDeeperInItsMiddleThanAtItsCorners)
{
    // The face's corners are near the walls; only its middle is far from them.
    const Penetration found =
        penetration_of(obstacle_of(kBox), triangle({-.99, -.99, 0}, {.99, -.99, 0}, {0, .99, 0}));
    // The depth is the radius of the largest circle in the square with its centre in the triangle: the
    // square's own.
    EXPECT_EQ(found.faces, 0);
    EXPECT_LE(found.depth, 1.0);
    EXPECT_GE(found.depth, 1.0 - kAccuracy);
}

TEST(Penetration, AClothThatHangsIntoASolidIsAsDeepAsItReaches)
{
    for (const double depth : {0.3, 1e-2, 1e-5, 1e-9}) {
        const Penetration found =
            penetration_of(obstacle_of(kBox), cloth(3, {-.2, .1, 1.0 - depth}, {.4, 0, 0}, {0, .1, 2}));
        EXPECT_NEAR(found.depth, depth, 1e-15 + 1e-9 * depth);
        EXPECT_EQ(found.faces, 6);  // the lowest row; the other two rows are 2/3 higher
    }
}

TEST(Penetration, ACornerThatPokesThroughAFace)
{
    // A plane at `height` below the corner, perpendicular to its diagonal. The centre of the cut is height /
    // sqrt(3) from each of the three sides.
    const Obstacle box = obstacle_of(kBox);
    const Vec3 axis = Vec3(1, 1, 1).normalized();
    const Vec3 u = axis.unitOrthogonal(), v = axis.cross(u);
    for (const double height : {0.5, 0.1, 1e-2, 1e-4, 1e-6, 1e-9})
        for (const double shift : {0.0, 0.3}) {
            const Vec3 centre = Vec3(1, 1, 1) - height * axis + shift * u - 0.5 * shift * v;
            const Penetration found =
                penetration_of(box, triangle(centre + 5 * u, centre - 3 * u + 5 * v, centre - 3 * u - 5 * v));
            const double expected = height / std::sqrt(3.0);
            EXPECT_EQ(found.faces, 1);
            EXPECT_LE(found.depth, expected * (1 + 1e-6) + 1e-15) << height;
            EXPECT_GE(found.depth, expected * (1 - kAccuracy)) << height;
        }
}

TEST(Penetration, ACornerPokesInAnyDirectionAndAsDeepAsItsHeight)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(0.05, 1.0);
    const Obstacle box = obstacle_of(kBox);
    for (int i = 0; i < 40; ++i) {
        const Vec3 axis = Vec3(number(random), number(random), number(random)).normalized();
        const Vec3 u = axis.unitOrthogonal(), v = axis.cross(u);
        double share = 0.0;  // depth over height
        for (const double height : {0.05, 1e-2, 1e-4, 1e-6, 1e-8}) {
            const Vec3 centre = Vec3(1, 1, 1) - height * axis + 0.2 * u - 0.3 * v;
            const Penetration found =
                penetration_of(box, triangle(centre + 8 * u, centre - 6 * u + 8 * v, centre - 6 * u - 8 * v));
            if (share <= 0.0) share = found.depth / height;
            EXPECT_GT(found.depth, 0.0);
            EXPECT_NEAR(found.depth / height, share, kAccuracy * share) << axis.transpose() << " " << height;
        }
    }
}

TEST(Penetration, AnEdgeThatPokesThroughAFace)
{
    // The plane cuts a strip between the two sides of an edge, at angles a and b to them. The strip's width
    // is height (cot a + cot b). The deepest line is where w sin a = (width - w) sin b.
    for (const double degrees : {45.0, 20.0, 5.0})
        for (const double height : {0.1, 1e-2, 1e-3, 1e-5, 1e-7}) {
            const double a = degrees * std::numbers::pi / 180, b = std::numbers::pi / 2 - a;
            const Vec3 normal(std::sin(a), 0, std::cos(a)), along(std::cos(a), 0, -std::sin(a));
            const Vec3 centre = Vec3(1, 0, 1) - height * normal;
            const Penetration found = penetration_of(
                obstacle_of(kBox), triangle(centre + Vec3(0, -4, 0) - 3 * along,
                                            centre + Vec3(0, 4, 0) - 3 * along, centre + 6 * along));
            const double width = height * (1 / std::tan(a) + 1 / std::tan(b));
            const double expected = width * std::sin(a) * std::sin(b) / (std::sin(a) + std::sin(b));
            EXPECT_LE(found.depth, expected * (1 + 1e-6) + 1e-15) << degrees << " " << height;
            // For cloth longer than 1e4 times the depth only detection is promised.
            EXPECT_GE(found.depth, expected * (height > 1e-3 ? 1 - kAccuracy : 0.5))
                << degrees << " " << height;
        }
}

TEST(Penetration, AClothRightThroughASolid)
{
    const Penetration found = penetration_of(obstacle_of(samples::box({-1, -2, -.5}, {1, 2, .5})),
                                             cloth(1, {.1, -9, -9}, {0, 18, 0}, {0, 0, 18}));
    EXPECT_EQ(found.faces, 2);
    EXPECT_LE(found.depth, 0.5 * (1 + 1e-9));
    EXPECT_GE(found.depth, 0.5 * (1 - kAccuracy));
}

TEST(Penetration, DepthIsThatOfDenseSamplesOnRandomTriangles)
{
    std::mt19937 random(8);
    std::normal_distribution<double> number;
    const ObstacleMesh holed =
        samples::together(kBox, samples::inside_out(samples::box({-.7, -.6, -.5}, {.7, .6, .5})));
    for (const ObstacleMesh& mesh :
         {kBox, samples::l_prism(), samples::teeth(2), samples::sphere(6, 8), holed}) {
        const Obstacle obstacle = obstacle_of(mesh);
        const Vec3 centre = obstacle.bounds().center();
        int inside = 0;
        for (int i = 0; i < 60; ++i) {
            std::array<Vec3, 3> t;
            for (Vec3& p : t) p = centre + 1.5 * Vec3(number(random), number(random), number(random));
            const Penetration found = penetration_of(obstacle, triangle(t[0], t[1], t[2]));
            double deepest = 0.0;
            constexpr int kSamples = 24;
            for (int j = 0; j <= kSamples; ++j)
                for (int k = 0; j + k <= kSamples; ++k)
                    deepest = std::max(deepest, depth_of(mesh, t[0] + (t[1] - t[0]) * j / kSamples +
                                                                   (t[2] - t[0]) * k / kSamples));
            // The depth is 1-Lipschitz, so between samples it changes by at most their spacing.
            const double spacing = std::max((t[1] - t[0]).norm(), (t[2] - t[0]).norm()) / kSamples;
            ASSERT_GE(found.depth, deepest * (1 - kAccuracy) - 1e-12) << i;
            ASSERT_LE(found.depth, deepest + spacing) << i;
            if (found.depth == 0.0) continue;
            ++inside;
            ASSERT_NEAR(found.depth, depth_of(mesh, found.place), 1e-9);
        }
        EXPECT_GT(inside, 10);
    }
}

TEST(Penetration, EachPieceOfClothIsToldByItself)
{
    Cloth pieces = level(2, 5.0, 1.0);  // cloth outside the box
    const Cloth inside = level(2, 0.75, 0.25);
    const int n = static_cast<int>(pieces.positions.size());
    const int first = static_cast<int>(pieces.faces.size());
    pieces.positions.insert(pieces.positions.end(), inside.positions.begin(), inside.positions.end());
    for (const auto& [a, b, c] : inside.faces) pieces.faces.push_back({a + n, b + n, c + n});
    const Penetration found = penetration_of(obstacle_of(kBox), pieces);
    EXPECT_NEAR(found.depth, 0.25, 1e-15);
    EXPECT_GE(found.face, first);
    EXPECT_EQ(found.faces, 0);
}

TEST(Penetration, AClothInACavityIsOutsideAndOneInTheWallIsNot)
{
    const Obstacle hollow = obstacle_of(
        samples::together(kBox, samples::inside_out(samples::box({-.5, -.5, -.5}, {.5, .5, .5}))));
    EXPECT_FALSE(penetration_of(hollow, level(3, 0.1, 0.4)).is_any());
    EXPECT_NEAR(penetration_of(hollow, level(3, 0.8, 0.4)).depth, 0.2, 1e-12);
    EXPECT_NEAR(penetration_of(hollow, level(3, 0.6, 0.4)).depth, 0.1, 1e-12);
    // The cloth passes through the walls: half of their thickness, although the cloth's middle is in the
    // cavity.
    const double through = penetration_of(hollow, level(1, 0.0, 5)).depth;
    EXPECT_LE(through, 0.25 * (1 + 1e-9) * std::sqrt(2.0) * 2 / (1 + std::sqrt(2.0)));
    EXPECT_GE(through, 0.25 * (1 - kAccuracy));
}

TEST(Penetration, SheetsAreCutButHaveNoInside)
{
    const Obstacle sheet = obstacle_of(samples::sheet(4, 4, [](int, int) { return 0.0; }));
    const Penetration cut = penetration_of(sheet, cloth(2, {2, 2, -1}, {2, 0, 0}, {0, 0.1, 2}));
    EXPECT_TRUE(cut.is_any());
    EXPECT_EQ(cut.depth, 0.0);
    EXPECT_GT(cut.faces, 0);
    EXPECT_NEAR(cut.place.z(), 0.0, 1e-12);
    EXPECT_FALSE(penetration_of(sheet, level(4, 1e-300, 3)).is_any());
    EXPECT_TRUE(penetration_of(sheet, level(4, 0.0, 3)).is_any());
    // A box without a lid, with cloth inside.
    ObstacleMesh open = kBox;
    open.faces.resize(open.faces.size() - 1);
    EXPECT_FALSE(penetration_of(obstacle_of(open), level(3, 0.1, 0.4)).is_any());
}

TEST(Penetration, WiresAndNailsThroughTheCloth)
{
    const Obstacle wire = obstacle_of(samples::wire({{0.1, 0.2, -1}, {0.1, 0.2, 1}, {0.1, 3, 1}}, false));
    const Penetration through = penetration_of(wire, level(3, 0.5, 2));
    EXPECT_EQ(through.faces, 1);
    EXPECT_EQ(through.depth, 0.0);
    EXPECT_LT((through.place - Vec3(0.1, 0.2, 0.5)).norm(), 1e-12);
    EXPECT_TRUE(penetration_of(wire, level(3, 1.0, 2)).is_any());   // cloth in the wire's plane
    EXPECT_TRUE(penetration_of(wire, level(3, -1.0, 2)).is_any());  // cloth at the wire's end
    EXPECT_FALSE(penetration_of(wire, level(3, std::nextafter(1.0, 2), 2)).is_any());
    EXPECT_FALSE(penetration_of(wire, level(3, std::nextafter(-1.0, -2), 2)).is_any());

    const Obstacle nail = obstacle_of(samples::nails({{7, 7, 7}, {0.5, 0.25, 1}}));
    const Penetration pricked = penetration_of(nail, level(1, 1.0, 2));
    EXPECT_EQ(pricked.faces, 1);
    EXPECT_EQ(pricked.place, Vec3(0.5, 0.25, 1));
    EXPECT_FALSE(penetration_of(nail, level(1, std::nextafter(1.0, 2), 2)).is_any());
    // A nail at a vertex.
    EXPECT_EQ(penetration_of(nail, cloth(2, {-.5, -.75, 1}, {2, 0, 0}, {0, 2, 0})).faces, 6);
}

TEST(Penetration, ClothFacesWithoutAreaAreLinesAndPoints)
{
    const Obstacle box = obstacle_of(kBox);
    // The cloth reaches from outside to 0.3 below the top, and the point is there.
    EXPECT_NEAR(penetration_of(box, triangle({0, 0, 2}, {0, 0, .7}, {0, 0, 1.5})).depth, 0.3, 1e-12);
    EXPECT_NEAR(penetration_of(box, triangle({0, 0, .7}, {0, 0, .7}, {0, 0, .7})).depth, 0.3, 1e-12);
    EXPECT_FALSE(penetration_of(box, triangle({0, 0, 2}, {0, 0, 1.1}, {0, 0, 1.5})).is_any());
    const Penetration on = penetration_of(box, triangle({0, 0, 1}, {0, 0, 1}, {0, 0, 1}));
    EXPECT_EQ(on.faces, 1);
    EXPECT_EQ(on.depth, 0.0);
    EXPECT_EQ(on.place, Vec3(0, 0, 1));
}

TEST(Penetration, ScalesAndMovesWithTheScene)
{
    const Vec3 axis = Vec3(1, 1, 1).normalized();
    const Vec3 u = axis.unitOrthogonal(), v = axis.cross(u), centre = Vec3(1, 1, 1) - 0.1 * axis;
    const std::array<Vec3, 3> t = {centre + 5 * u, centre - 3 * u + 5 * v, centre - 3 * u - 5 * v};
    for (const double size : {1e-6, 1.0, 1e6})
        for (const double offset : {0.0, 1e6}) {  // in units of the obstacle's size
            const auto map = [&](const Vec3& p) { return Vec3(size * (p + Vec3::Constant(offset))); };
            const Penetration found = penetration_of(obstacle_of(samples::moved(kBox, map)),
                                                     triangle(map(t[0]), map(t[1]), map(t[2])));
            const double expected = size * 0.1 / std::sqrt(3.0);
            EXPECT_NEAR(found.depth, expected, kAccuracy * expected) << size << " " << offset;
        }
}

TEST(Penetration, IsTheSameAtAnyNumberOfThreads)
{
    const Obstacle obstacle = obstacle_of(samples::sphere(20, 40));
    const Cloth crossing = cloth(60, {-2, -1.9, .3}, {4, 0, .2}, {.1, 4, .1});
    const Penetration all = penetration_of(obstacle, crossing);
    EXPECT_GT(all.faces, 50);
    for (const int threads : {1, 2, 4}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const Penetration found = penetration_of(obstacle, crossing);
        EXPECT_EQ(found.depth, all.depth);
        EXPECT_EQ(found.faces, all.faces);
        EXPECT_EQ(found.face, all.face);
        EXPECT_EQ(found.place, all.place);
    }
}

double milliseconds(const Obstacle& obstacle, const Cloth& cloth, Penetration& found)
{
    const auto begin = std::chrono::steady_clock::now();
    found = penetration_of(obstacle, cloth);
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

TEST(Penetration, EndsInTimeOnFineObstacles)
{
    // Time limits that hold on a shared machine, but not for an unbounded search.
    constexpr double kLongClear = 2000.0, kLongInside = 60000.0;
    const Obstacle sphere = obstacle_of(samples::sphere(160, 316));
    const Obstacle box = obstacle_of(kBox);
    Penetration found;
    const Cloth near = level(100, 1.0 + 1e-4, 1.0);
    const double clear_sphere = milliseconds(sphere, near, found);
    EXPECT_FALSE(found.is_any());
    // The cloth surrounds the upper half of the sphere, where the sphere's bounding box does not help.
    Cloth drape = level(100, 0.0, 1.0);
    for (Vec3& p : drape.positions) {
        const double radius = p.head<2>().cwiseAbs().maxCoeff(), angle = radius * std::numbers::pi / 2;
        const Vec2 way = p.head<2>().stableNormalized();
        p = 1.001 * Vec3(std::sin(angle) * way.x(), std::sin(angle) * way.y(), std::cos(angle));
    }
    const double drape_sphere = milliseconds(sphere, drape, found);
    EXPECT_FALSE(found.is_any());
    const double clear_box = milliseconds(box, near, found);
    EXPECT_FALSE(found.is_any());
    const double touching_box = milliseconds(box, level(100, 1.0, 1.5), found);
    EXPECT_EQ(found.depth, 0.0);
    const double inside_sphere = milliseconds(sphere, level(100, 0.1, 0.6), found);
    EXPECT_NEAR(found.depth, 0.9, kAccuracy);
    const double through_sphere = milliseconds(sphere, level(100, 0.5, 1.5), found);
    EXPECT_NEAR(found.depth, 0.5, kAccuracy);
    const double shallow_sphere = milliseconds(sphere, level(100, 0.999, 1.5), found);
    EXPECT_NEAR(found.depth, 0.001, 2e-4);  // facets are up to 5e-5 below the sphere
    for (const double spent : {clear_sphere, drape_sphere, clear_box}) EXPECT_LT(spent, kLongClear);
    for (const double spent : {touching_box, inside_sphere, through_sphere, shallow_sphere})
        EXPECT_LT(spent, kLongInside);
    const auto record = [](const char* name, double spent) { RecordProperty(name, std::to_string(spent)); };
    record("clear_sphere_ms", clear_sphere);
    record("drape_sphere_ms", drape_sphere);
    record("clear_box_ms", clear_box);
    record("touching_box_ms", touching_box);
    record("inside_sphere_ms", inside_sphere);
    record("through_sphere_ms", through_sphere);
    record("shallow_sphere_ms", shallow_sphere);
}

}  // namespace
}  // namespace arris
