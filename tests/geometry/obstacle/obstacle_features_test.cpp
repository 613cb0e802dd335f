// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle/obstacle_features.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>

#include "tests/geometry/sample_obstacles.h"

namespace arris {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

ObstacleFeatures features_of(const ObstacleMesh& mesh, double feature_angle = 30.0)
{
    EXPECT_EQ(validate(mesh), "");
    return find_features(mesh, make_topology(mesh), feature_angle);
}

int count(const ObstacleFeatures& features, FeatureKind kind)
{
    return static_cast<int>(std::count_if(features.edges.begin(), features.edges.end(),
                                          [kind](const FeatureEdge& e) { return e.kind == kind; }));
}

std::vector<int> corner_points(const ObstacleFeatures& features)
{
    std::vector<int> points;
    for (const FeatureCorner& corner : features.corners) points.push_back(corner.point);
    return points;
}

/// Number of edges of each polyline, ascending.
std::vector<int> polylines(const ObstacleFeatures& features)
{
    std::vector<int> lengths(features.polylines.size(), 0);
    for (const FeatureEdge& edge : features.edges) ++lengths.at(edge.polyline);
    std::sort(lengths.begin(), lengths.end());
    return lengths;
}

int patch_count(const ObstacleFeatures& features)
{
    return features.patch.empty() ? 0 : *std::max_element(features.patch.begin(), features.patch.end()) + 1;
}

Mat3 some_rotation()
{
    return Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
}

const ObstacleMesh kBox = samples::box({-1, -2, -3}, {1, 2, 3});

TEST(ObstacleFeatures, BoxHasTwelveConvexEdgesAndEightCornersOfThreePlanes)
{
    const ObstacleFeatures features = features_of(kBox);
    EXPECT_EQ(count(features, FeatureKind::Convex), 12);
    EXPECT_THAT(features.edges, SizeIs(12));
    EXPECT_THAT(polylines(features), ElementsAre(1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1));
    EXPECT_THAT(corner_points(features), ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
    EXPECT_EQ(patch_count(features), 6);

    const ObstacleTopology topology = make_topology(kBox);
    for (const FeatureEdge& edge : features.edges) {
        const std::array<int, 2>& ends = topology.edges[edge.edge].points;
        const Vec3 middle = (kBox.points[ends[0]] + kBox.points[ends[1]]) / 2;
        for (const Vec3& normal : edge.normals) {
            // The box is centred, so both normals have a positive component towards the edge and none along
            // it.
            EXPECT_DOUBLE_EQ(normal.norm(), 1.0);
            EXPECT_GT(normal.dot(middle), 0.5);
            EXPECT_EQ(normal.dot(kBox.points[ends[1]] - kBox.points[ends[0]]), 0.0);
        }
        EXPECT_EQ(edge.normals[0].dot(edge.normals[1]), 0.0);
    }
    for (const FeatureCorner& corner : features.corners) {
        ASSERT_THAT(corner.normals, SizeIs(3));
        Vec3 sum = Vec3::Zero();
        for (const Vec3& normal : corner.normals) sum += normal;
        const Vec3 signs = kBox.points[corner.point].cwiseSign();
        EXPECT_EQ(sum, signs);
    }
}

TEST(ObstacleFeatures, BoxAtItsOwnAngleHasNoSharpEdgesButCorners)
{
    for (const double angle : {90.0, 91.0, 179.0}) {
        const ObstacleFeatures features = features_of(kBox, angle);
        EXPECT_THAT(features.edges, IsEmpty()) << angle;
        EXPECT_THAT(features.corners, SizeIs(8)) << angle;  // each has an angle defect of 90 degrees
        EXPECT_EQ(patch_count(features), 6) << angle;
    }
    EXPECT_THAT(features_of(kBox, 89.98).edges, SizeIs(12));
}

TEST(ObstacleFeatures, RoundingDoesNotDecideAtTheThreshold)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    for (int i = 0; i < 100; ++i) {
        const Vec3 axis = Vec3(number(random), number(random), number(random)).normalized();
        const Mat3 rotation = Eigen::AngleAxisd(3.0 * number(random), axis).toRotationMatrix();
        const ObstacleMesh turned = samples::moved(kBox, [&](const Vec3& p) { return Vec3(rotation * p); });
        EXPECT_THAT(features_of(turned, 90.0).edges, IsEmpty());
        EXPECT_THAT(features_of(turned, 89.98).edges, SizeIs(12));
    }
}

// Mesh files keep coordinates in single precision, or as text of six digits.
TEST(ObstacleFeatures, RoundingOfFilesDoesNotDecideAtTheThreshold)
{
    const auto to_float = [](double x) { return static_cast<double>(static_cast<float>(x)); };
    const auto to_six_digits = [](double x) { return std::round(1e6 * x) / 1e6; };
    const auto exactly = [](double x) { return x; };
    std::mt19937 random(5);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    for (const int sides : {8, 12, 16, 20, 24, 25, 36})
        for (const double radius : {0.1, 1.0})
            for (const std::function<double(double)>& rounded :
                 {std::function<double(double)>(exactly), {to_float}, {to_six_digits}}) {
                const Vec3 axis = Vec3(number(random), number(random), number(random)).normalized();
                const Mat3 rotation = Eigen::AngleAxisd(3.0 * number(random), axis).toRotationMatrix();
                const auto place = [&](const Vec3& p) {
                    const Vec3 q = rotation * (radius * p) + Vec3(0.3, -0.2, 0.5);
                    return Vec3(rounded(q.x()), rounded(q.y()), rounded(q.z()));
                };
                const double turn = 360.0 / sides;
                const auto roof = samples::sheet(
                    2, 1, [&](int i, int) { return i == 1 ? std::tan(0.5 * turn * M_PI / 180.0) : 0.0; });
                for (const auto& [angle, are_sharp] :
                     {std::pair(turn - 0.02, true), {turn, false}, {turn + 0.02, false}}) {
                    SCOPED_TRACE(fmt::format("{} sides, radius {}, {} degrees", sides, radius, angle));
                    const ObstacleMesh solid = samples::moved(samples::cylinder(sides), place);
                    EXPECT_THAT(features_of(solid, angle).edges, SizeIs((are_sharp ? 3 : 2) * sides));
                    const ObstacleMesh sheet = samples::moved(roof, place);
                    EXPECT_EQ(count(features_of(sheet, angle), FeatureKind::Convex), are_sharp ? 1 : 0);
                }
            }
}

TEST(ObstacleFeatures, CountsAreThoseOfTheShapeAtAnySizeAndPlace)
{
    const Mat3 rotation = some_rotation();
    for (const double size : {1e-6, 1.0, 1e6})
        for (const double offset : {0.0, 1e6}) {  // in units of the obstacle's size
            const auto map = [&](const Vec3& p) {
                return Vec3(size * (rotation * p + Vec3::Constant(offset)));
            };
            const ObstacleFeatures features = features_of(samples::moved(samples::l_prism(), map));
            EXPECT_THAT(features.edges, SizeIs(27)) << size << " " << offset;
            EXPECT_THAT(features.corners, SizeIs(12));
            EXPECT_EQ(features.polylines.size(), 17u);
            EXPECT_THAT(features_of(samples::moved(kBox, map)).edges, SizeIs(12));
            EXPECT_EQ(patch_count(features_of(samples::moved(kBox, map))), 6);
        }
}

TEST(ObstacleFeatures, SidesOfACylinderAreSharpBelowTheirTurn)
{
    const ObstacleFeatures coarse = features_of(samples::cylinder(16), 30.0);
    EXPECT_THAT(polylines(coarse), ElementsAre(16, 16));  // two closed rims
    EXPECT_THAT(coarse.corners, IsEmpty());
    EXPECT_EQ(patch_count(coarse), 18);

    const ObstacleFeatures fine = features_of(samples::cylinder(16), 20.0);
    EXPECT_THAT(fine.edges, SizeIs(48));
    EXPECT_THAT(fine.corners, SizeIs(32));
    EXPECT_EQ(fine.polylines.size(), 48u);
}

TEST(ObstacleFeatures, ARimThatTurnsByThirtyDegreesIsOnePolylineByMoreIsCut)
{
    EXPECT_THAT(polylines(features_of(samples::cylinder(12), 80.0)), ElementsAre(12, 12));
    EXPECT_THAT(features_of(samples::cylinder(12), 80.0).corners, IsEmpty());
    EXPECT_THAT(features_of(samples::cylinder(11), 80.0).corners, SizeIs(22));
}

TEST(ObstacleFeatures, ReflexEdgesAreNoneButTheirEndsAreCorners)
{
    const ObstacleMesh mesh = samples::l_prism();
    const ObstacleFeatures features = features_of(mesh);
    EXPECT_EQ(count(features, FeatureKind::Convex), 27);
    EXPECT_THAT(corner_points(features), ElementsAre(0, 1, 2, 3, 4, 5, 18, 19, 20, 21, 22, 23));
    EXPECT_THAT(polylines(features), ElementsAre(1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 3, 3, 3, 3, 3));
    const ObstacleTopology topology = make_topology(mesh);
    for (const FeatureEdge& edge : features.edges) {
        const std::array<int, 2>& ends = topology.edges[edge.edge].points;
        EXPECT_FALSE(ends[0] % 6 == 3 && ends[1] % 6 == 3);  // the reflex line
    }
}

TEST(ObstacleFeatures, InsideOutAllEdgesAreReflexAndPitsAreNoCorners)
{
    const ObstacleFeatures cavity = features_of(samples::inside_out(kBox));
    EXPECT_THAT(cavity.edges, IsEmpty());
    EXPECT_THAT(cavity.corners, IsEmpty());
    EXPECT_THAT(features_of(samples::inside_out(samples::l_prism())).edges, SizeIs(3));
    EXPECT_THAT(features_of(samples::inside_out(samples::cone(64, 0.3))).corners, IsEmpty());
    // A hollow box has the features of its outside.
    const ObstacleFeatures hollow = features_of(
        samples::together(kBox, samples::inside_out(samples::box({-.5, -.5, -.5}, {.5, .5, .5}))));
    EXPECT_THAT(hollow.edges, SizeIs(12));
    EXPECT_THAT(hollow.corners, SizeIs(8));
}

TEST(ObstacleFeatures, AConesApexIsACornerThoughNoEdgeThereIsSharp)
{
    const ObstacleFeatures features = features_of(samples::cone(100, 0.3));
    EXPECT_THAT(corner_points(features), ElementsAre(100));
    EXPECT_THAT(features.corners[0].normals, SizeIs(100));
    EXPECT_THAT(polylines(features), ElementsAre(100));
    // The angle defect is 360 (1 - r / sqrt(r^2 + 1)) degrees: 57.1 at r = 1.56, 62.9 at r = 1.44.
    EXPECT_THAT(features_of(samples::cone(100, 1.56)).corners, IsEmpty());
    EXPECT_THAT(features_of(samples::cone(100, 1.44)).corners, SizeIs(1));
}

TEST(ObstacleFeatures, ConesThatShareTheirApexAreAFanEach)
{
    // An hourglass: the angles around its waist sum up to far more than those of one cone.
    const ObstacleMesh up = samples::cone(40, 1.0);
    ObstacleMesh mesh = samples::together(
        up, samples::moved(up, [](const Vec3& p) { return Vec3(p.x(), -p.y(), 2.0 - p.z()); }));
    for (Face& face : mesh.faces)
        for (int& p : face)
            if (p == 81) p = 40;
    mesh.points.pop_back();
    EXPECT_THAT(corner_points(features_of(mesh)), ElementsAre(40));
}

TEST(ObstacleFeatures, PointsOnTheLineOfAnEdgeChain)
{
    const ObstacleMesh layered = samples::prism({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {0, .2, .4, .7, 1});
    const ObstacleFeatures features = features_of(layered);
    EXPECT_THAT(features.edges, SizeIs(24));
    EXPECT_THAT(polylines(features), ElementsAre(1, 1, 1, 1, 1, 1, 1, 1, 4, 4, 4, 4));
    EXPECT_THAT(features.corners, SizeIs(8));
    EXPECT_EQ(patch_count(features), 6);
}

TEST(ObstacleFeatures, RidgesOfTeethAreSharpAndValleysAreNot)
{
    // Along y there are 5 tips, 2 ends of the row above and 2 below. On either side there are 10 slopes and 5
    // + 2 edges of the slab.
    const ObstacleFeatures features = features_of(samples::teeth(5));
    EXPECT_EQ(count(features, FeatureKind::Convex), 9 + 2 * 17);
    EXPECT_THAT(features.edges, SizeIs(9 + 2 * 17));
    // Corners are at tips, valleys (where two slopes meet) and the slab's four. Points inside its under side
    // are no corners.
    EXPECT_THAT(features.corners, SizeIs(2 * (5 + 6 + 2)));
}

TEST(ObstacleFeatures, FlatSheetHasItsBorder)
{
    const ObstacleFeatures features = features_of(samples::sheet(4, 3, [](int, int) { return 0.0; }));
    EXPECT_EQ(count(features, FeatureKind::Border), 14);
    EXPECT_THAT(features.edges, SizeIs(14));
    EXPECT_THAT(polylines(features), ElementsAre(3, 3, 4, 4));
    EXPECT_THAT(corner_points(features), ElementsAre(0, 3, 16, 19));
    EXPECT_EQ(patch_count(features), 1);
    for (const FeatureEdge& edge : features.edges) {
        EXPECT_EQ(edge.normals[0], Vec3(0, 0, 1));
        EXPECT_EQ(edge.normals[1], Vec3(0, 0, 1));
    }
    for (const FeatureCorner& corner : features.corners) EXPECT_THAT(corner.normals, SizeIs(1));
}

TEST(ObstacleFeatures, EveryCreaseOfASheetIsOneWhicheverWayItTurns)
{
    // The sheet goes up and down: creases at i = 1, 2, 3, with the middle one in the opposite direction.
    const ObstacleFeatures features = features_of(samples::sheet(4, 2, [](int i, int) { return i % 2; }));
    EXPECT_EQ(count(features, FeatureKind::Convex), 6);
    EXPECT_EQ(count(features, FeatureKind::Border), 12);
    EXPECT_THAT(features.corners, SizeIs(4 + 6));
    EXPECT_EQ(features.polylines.size(), 3u + 2 + 8);
    EXPECT_EQ(patch_count(features), 4);
    // Inside out, the sheet has the same number of feature edges.
    EXPECT_THAT(
        features_of(samples::inside_out(samples::sheet(4, 2, [](int i, int) { return i % 2; }))).edges,
        SizeIs(18));
}

TEST(ObstacleFeatures, SheetAndSolidOfOneMeshAreToldApart)
{
    ObstacleMesh valley = samples::sheet(2, 1, [](int i, int) { return std::abs(i - 1); });
    valley = samples::moved(valley, [](const Vec3& p) { return Vec3(p + Vec3(10, 0, 0)); });
    const ObstacleFeatures features = features_of(samples::together(samples::l_prism(), valley));
    EXPECT_EQ(count(features, FeatureKind::Convex), 27 + 1);
    EXPECT_EQ(count(features, FeatureKind::Border), 6);
}

TEST(ObstacleFeatures, APlateWithoutThicknessIsSharpAllAround)
{
    ObstacleMesh plate;
    plate.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    plate.faces = {{0, 1, 2}, {0, 2, 1}};
    const ObstacleFeatures features = features_of(plate);
    EXPECT_EQ(count(features, FeatureKind::Convex), 3);
    EXPECT_THAT(corner_points(features), ElementsAre(0, 1, 2));
    EXPECT_EQ(patch_count(features), 2);
}

TEST(ObstacleFeatures, AKnifesEdgeIsConvexAndItsNotchReflexByTheExactSign)
{
    for (const double half : {1e-3, 1e-9, 1e-15}) {
        const ObstacleMesh knife = samples::prism({{-1, 0}, {0, -half}, {1, 0}, {0, half}}, {0.0, 1.0});
        const ObstacleFeatures features = features_of(knife);
        // The two edges of the blade, besides the caps' eight.
        EXPECT_EQ(count(features, FeatureKind::Convex), 10) << half;
        EXPECT_THAT(features_of(samples::inside_out(knife)).edges, IsEmpty()) << half;
    }
}

TEST(ObstacleFeatures, NoiseOnFlatSidesMakesNoFeatures)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> noise(-1e-7, 1e-7);
    std::vector<double> levels;
    for (int i = 0; i <= 50; ++i) levels.push_back(i / 50.0);
    ObstacleMesh mesh = samples::prism({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, levels);
    for (Vec3& p : mesh.points) p += Vec3(noise(random), noise(random), noise(random));
    const ObstacleFeatures features = features_of(mesh);
    EXPECT_THAT(features.edges, SizeIs(8 + 4 * 50));
    EXPECT_EQ(features.polylines.size(), 12u);
    EXPECT_THAT(features.corners, SizeIs(8));
}

/// A box with a point 8 beside its edge from 4 to 5. Only the upper face uses this point; a triangle closes
/// the gap. The triangle is as flat as the point is near.
ObstacleMesh box_with_cap(const Vec3& off)
{
    ObstacleMesh mesh = samples::box({0, 0, 0}, {1, 1, 1});
    mesh.points.push_back((mesh.points[4] + mesh.points[5]) / 2 + off);
    for (Face& face : mesh.faces)
        for (int i = 0; i < 3; ++i)
            if (face[i] == 4 && face[(i + 1) % 3] == 5) {
                const int apex = face[(i + 2) % 3];
                face = {4, 8, apex};
                mesh.faces.push_back({8, 5, apex});
                mesh.faces.push_back({4, 5, 8});
                return mesh;
            }
    return mesh;
}

TEST(ObstacleFeatures, ASliverBentByRoundingIsNoEdgeOfItsOwn)
{
    std::mt19937 random(9);
    std::normal_distribution<double> number;
    for (const double size : {1e-13, 1e-10, 1e-7})
        for (int i = 0; i < 50; ++i) {
            const Vec3 off = size * Vec3(number(random), number(random), number(random)).stableNormalized();
            const ObstacleFeatures features = features_of(box_with_cap(off));
            EXPECT_THAT(features.edges, SizeIs(13)) << off.transpose();
            EXPECT_EQ(count(features, FeatureKind::Convex), 13);
            EXPECT_EQ(features.polylines.size(), 12u);
            EXPECT_THAT(features.corners, SizeIs(8));
        }
}

TEST(ObstacleFeatures, ASmallFacetIsOneOfItsOwn)
{
    // A chamfer twice as high as the bound for rounding.
    const ObstacleFeatures features = features_of(box_with_cap(1e-6 * Vec3(0, 1, 1).normalized()));
    EXPECT_THAT(features.edges, SizeIs(14));
}

TEST(ObstacleFeatures, AThinPlateKeepsItsEdges)
{
    // Proportions are 1e6 to 1: the side faces are lower than rounding in single precision.
    EXPECT_THAT(features_of(samples::box({0, 0, 0}, {1, 1, 1e-6})).edges, SizeIs(12));
    EXPECT_THAT(features_of(samples::box({0, 0, 0}, {1, 1e-6, 1e-6})).edges, SizeIs(12));
}

TEST(ObstacleFeatures, WiresEndTurnAndCross)
{
    const ObstacleFeatures straight = features_of(samples::wire({{0, 0, 0}, {1, 0, 0}, {3, 0, 0}}, false));
    EXPECT_EQ(count(straight, FeatureKind::Wire), 2);
    EXPECT_THAT(corner_points(straight), ElementsAre(0, 2));
    EXPECT_THAT(polylines(straight), ElementsAre(2));
    EXPECT_THAT(straight.corners[0].normals, IsEmpty());
    EXPECT_EQ(straight.edges[0].normals[0], Vec3(0, 0, 0));
    EXPECT_THAT(straight.patch, IsEmpty());

    const ObstacleFeatures square =
        features_of(samples::wire({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, true));
    EXPECT_THAT(corner_points(square), ElementsAre(0, 1, 2, 3));
    EXPECT_THAT(polylines(square), ElementsAre(1, 1, 1, 1));

    ObstacleMesh cross;
    cross.points = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, 0}};
    cross.segments = {{0, 4}, {4, 1}, {2, 4}, {4, 3}};
    EXPECT_THAT(corner_points(features_of(cross)), ElementsAre(0, 1, 2, 3, 4));
    EXPECT_THAT(polylines(features_of(cross)), ElementsAre(1, 1, 1, 1));
}

TEST(ObstacleFeatures, AClosedSmoothWireIsOnePolylineWithoutCorners)
{
    std::vector<Vec3> circle;
    for (int i = 0; i < 32; ++i) {
        const double angle = 2 * std::numbers::pi * i / 32;
        circle.push_back(some_rotation() * Vec3(std::cos(angle), std::sin(angle), 0.0));
    }
    const ObstacleFeatures features = features_of(samples::wire(circle, true));
    EXPECT_THAT(polylines(features), ElementsAre(32));
    EXPECT_THAT(features.corners, IsEmpty());
    // A nail on a wire divides the polyline.
    ObstacleMesh nailed = samples::wire(circle, true);
    nailed.lone_points = {7};
    EXPECT_THAT(corner_points(features_of(nailed)), ElementsAre(7));
    EXPECT_THAT(polylines(features_of(nailed)), ElementsAre(32));
}

TEST(ObstacleFeatures, AWireTurnsAtMoreThanSixtyDegrees)
{
    for (const auto& [turn, corners] :
         std::map<double, int>{{0, 2}, {29.9, 2}, {30.1, 2}, {60, 2}, {60.1, 3}, {180, 3}}) {
        const double angle = turn * std::numbers::pi / 180;
        const Vec3 end = Vec3(1, 0, 0) + 2.0 * Vec3(std::cos(angle), std::sin(angle), 0);
        const ObstacleMesh mesh = samples::wire({{0, 0, 0}, {1, 0, 0}, end}, false);
        EXPECT_THAT(features_of(mesh).corners, SizeIs(corners)) << turn;
    }
}

TEST(ObstacleFeatures, PolylinesAreOfOneKind)
{
    // A crease leads from a sheet's rim and ends in the sheet's middle; from there a wire continues straight
    // on.
    constexpr int kRim = 16;
    ObstacleMesh mesh;
    mesh.points = {{0, 0, 0}, {0, -1, 0}};
    for (int i = 0; i < kRim; ++i) {
        const double angle = 2 * std::numbers::pi * i / kRim;  // measured from the crease
        mesh.points.emplace_back(-std::sin(angle), std::cos(angle), -1.2 * std::sin(angle / 2));
        mesh.faces.push_back({0, 2 + i, 2 + (i + 1) % kRim});
    }
    mesh.segments = {{0, 1}};
    const ObstacleFeatures features = features_of(mesh, 40.0);
    EXPECT_EQ(count(features, FeatureKind::Convex), 1);
    EXPECT_EQ(count(features, FeatureKind::Wire), 1);
    EXPECT_THAT(corner_points(features), ::testing::Contains(0));
    std::map<int, FeatureKind> kinds;
    for (const FeatureEdge& edge : features.edges)
        EXPECT_EQ(kinds.try_emplace(edge.polyline, edge.kind).first->second, edge.kind);
}

TEST(ObstacleFeatures, LonePointsAreCornersWithoutNormals)
{
    const ObstacleFeatures features = features_of(samples::nails({{0, 0, 0}, {1, 0, 0}, {1, 0, 1}}));
    EXPECT_THAT(corner_points(features), ElementsAre(0, 1, 2));
    EXPECT_THAT(features.corners[1].normals, IsEmpty());
    EXPECT_THAT(features.edges, IsEmpty());
    EXPECT_EQ(features.polylines.size(), 0u);
}

TEST(ObstacleFeatures, NothingHasNone)
{
    const ObstacleFeatures features = features_of({});
    EXPECT_THAT(features.edges, IsEmpty());
    EXPECT_THAT(features.corners, IsEmpty());
    EXPECT_THAT(features.patch, IsEmpty());
    // Unused points are no lone points.
    ObstacleMesh stray;
    stray.points = {{1, 2, 3}};
    EXPECT_THAT(features_of(stray).corners, IsEmpty());
}

TEST(ObstacleFeatures, AFineSheetThatCurvesIsNotOnePatch)
{
    // The normal turns by 0.8e-6 at each row. Each row is within the tolerance of the next, but 20 rows turn
    // by 16e-6 in total.
    const ObstacleMesh mesh = samples::sheet(20, 1, [](int i, int) { return 0.4e-6 * i * i; });
    const ObstacleFeatures features = features_of(mesh);
    EXPECT_GE(patch_count(features), 8);
    EXPECT_LE(patch_count(features), 20);
    const ObstacleTopology topology = make_topology(mesh);
    std::map<int, int> seeds;
    for (int f = 0; f < static_cast<int>(mesh.faces.size()); ++f) {
        const Vec3& seed = topology.face_normals[seeds.try_emplace(features.patch[f], f).first->second];
        EXPECT_LE(seed.cross(topology.face_normals[f]).norm(), 1e-6 * (1 + 1e-6));
    }
}

TEST(ObstacleFeatures, ParallelTerracesAreAPatchEach)
{
    const ObstacleMesh stairs = samples::sheet(6, 1, [](int i, int) { return i / 2; });
    const ObstacleFeatures features = features_of(stairs);
    EXPECT_EQ(patch_count(features), 6);  // treads 0-1, 2-3, 4-5 and the risers behind
    EXPECT_NE(features.patch[0], features.patch[4]);
}

TEST(ObstacleFeatures, ASpiralRampIsNotOnePatch)
{
    // The ramp is so gentle that all its normals agree. Three turns up it is 2.7e-6 of its diagonal above its
    // foot.
    constexpr int kPerTurn = 64;
    ObstacleMesh ramp = samples::sheet(3 * kPerTurn, 1, [](int, int) { return 0.0; });
    for (Vec3& p : ramp.points) {
        const double angle = 2 * std::numbers::pi * p.x() / kPerTurn, radius = 0.9 + 0.1 * p.y();
        p = Vec3(radius * std::cos(angle), radius * std::sin(angle), 0.4e-6 * angle);
    }
    EXPECT_EQ(patch_count(features_of(ramp)), 3);
}

TEST(ObstacleFeatures, AFineSphereHasNoneAndIsQuicklySeen)
{
    const ObstacleMesh mesh = samples::sphere(160, 316);
    ASSERT_GT(mesh.faces.size(), 100000u);
    const ObstacleTopology topology = make_topology(mesh);
    const auto begin = std::chrono::steady_clock::now();
    const ObstacleFeatures features = find_features(mesh, topology, 30.0);
    const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - begin;
    EXPECT_THAT(features.edges, IsEmpty());
    EXPECT_THAT(features.corners, IsEmpty());
    RecordProperty("milliseconds", static_cast<int>(spent.count()));
    EXPECT_LT(spent.count(), 5000.0);  // linear: about 100 ms; anything quadratic takes minutes
}

TEST(ObstacleFeatures, ManyFacesAtOnePointAreNoTrouble)
{
    const ObstacleFeatures features = features_of(samples::cone(5000, 0.3));
    ASSERT_THAT(features.corners, SizeIs(1));
    EXPECT_THAT(features.corners[0].normals, SizeIs(5000));
}

}  // namespace
}  // namespace arris
