// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/polygon.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>

namespace arris {
namespace {

constexpr double kRounding = 1e-12;  // relative to the area

struct Case {
    const char* name;
    std::vector<Vec2> corners;
    double area;
    int triangles;  // fewer than the corners less two where corners coincide
};

std::vector<Case> simple_polygons()
{
    return {
        {"square", {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 1.0, 2},
        {"kite", {{0, 0}, {2, -1}, {5, 0}, {2, 1}}, 5.0, 2},
        {"dart", {{0, 0}, {4, -1}, {1, 0}, {4, 1}}, 1.0, 2},
        {"pentagon with a corner on a side", {{0.2, 0}, {0.4, 0}, {0.4, 0.3}, {0, 0.3}, {0, 0}}, 0.12, 3},
        {"rectangle with a corner on each side",
         {{0, 0}, {0.2, 0}, {0.4, 0}, {0.4, 0.1}, {0.4, 0.3}, {0.1, 0.3}, {0, 0.3}, {0, 0.2}},
         0.12,
         6},
        {"two steps, a corner on a diagonal", {{0, 0}, {0, 2}, {1, 2}, {1, 1}, {2, 1}, {2, 0}}, 3.0, 4},
        {"six steps",
         {{0, 0},
          {0, 6},
          {1, 6},
          {1, 5},
          {2, 5},
          {2, 4},
          {3, 4},
          {3, 3},
          {4, 3},
          {4, 2},
          {5, 2},
          {5, 1},
          {6, 1},
          {6, 0}},
         21.0,
         12},
        {"plus",
         {{1, 0}, {2, 0}, {2, 1}, {3, 1}, {3, 2}, {2, 2}, {2, 3}, {1, 3}, {1, 2}, {0, 2}, {0, 1}, {1, 1}},
         5.0,
         10},
        {"C", {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {3, 2}, {3, 3}, {0, 3}}, 7.0, 6},
        {"repeated corner", {{0, 0}, {1, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 1}}, 1.0, 2},
        {"triangle with a corner twice", {{0, 0}, {1, 0}, {0, 1}, {0, 1}}, 0.5, 1},
        {"square hole, joined by a bridge",
         {{0, 0}, {3, 0}, {3, 3}, {0, 3}, {0, 0}, {1, 1}, {1, 2}, {2, 2}, {2, 1}, {1, 1}},
         8.0,
         8},
        {"corner that touches another corner",
         {{0, 0}, {2, 0}, {2, 2}, {1, 1}, {0, 2}, {0, 1.5}, {1, 1}, {0, 0.5}},
         2.5,
         4},
        {"corner that touches a side", {{0, 0}, {4, 0}, {4, 2}, {2, 0}, {0, 2}}, 4.0, 2},
        {"spur", {{0, 0}, {1, 0}, {2, 0}, {1, 0}, {1, 1}, {0, 1}}, 1.0, 2},
        {"far away",
         {{60000, 0}, {60001, 0}, {60001, 0.5}, {60000.5, 0.5}, {60000.5, 1}, {60000, 1}},
         0.75,
         4},
        {"tiny", {{0, 0}, {2e-9, 0}, {2e-9, 1e-9}, {1e-9, 1e-9}, {1e-9, 2e-9}, {0, 2e-9}}, 3e-18, 4},
        {"needle", {{0, 0}, {1e6, 1e-3}, {2e6, 0}, {1e6, -1e-3}}, 2000.0, 2},
    };
}

template <class Point>
std::vector<Point> started_at(std::vector<Point> corners, std::size_t start, bool is_reversed)
{
    std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(start), corners.end());
    if (is_reversed) std::reverse(corners.begin(), corners.end());
    return corners;
}

double area_of(const std::vector<Vec2>& p, const Face& f)
{
    const Vec2 u = p[f[1]] - p[f[0]], v = p[f[2]] - p[f[0]];
    return 0.5 * (u.x() * v.y() - u.y() * v.x());
}

// Triangles as sets of places, which name neither corners nor orientations.
std::multiset<std::set<std::pair<double, double>>> places(const std::vector<Vec2>& p,
                                                          const std::vector<Face>& faces)
{
    std::multiset<std::set<std::pair<double, double>>> all;
    for (const Face& f : faces) {
        std::set<std::pair<double, double>> triangle;
        for (const int k : f) triangle.emplace(p[k].x(), p[k].y());
        all.insert(triangle);
    }
    return all;
}

TEST(Polygon, EveryStartAndOrientationGivesTheSameTriangles)
{
    for (const Case& c : simple_polygons()) {
        const auto expected = places(c.corners, triangulate_polygon(c.corners).faces);
        for (std::size_t start = 0; start < c.corners.size(); ++start)
            for (const bool is_reversed : {false, true}) {
                SCOPED_TRACE(std::string(c.name) + ", start " + std::to_string(start) +
                             (is_reversed ? ", reversed" : ""));
                const std::vector<Vec2> corners = started_at(c.corners, start, is_reversed);
                const PolygonTriangles cut = triangulate_polygon(corners);
                EXPECT_EQ(cut.defect, PolygonDefect::None);
                EXPECT_EQ(static_cast<int>(cut.faces.size()), c.triangles);
                EXPECT_EQ(places(corners, cut.faces), expected);
                // All triangles have the orientation of the polygon, so areas do not cancel.
                double area = 0.0;
                for (const Face& f : cut.faces) {
                    const double signed_area = area_of(corners, f);
                    area += std::abs(signed_area);
                    EXPECT_GT(std::abs(signed_area), 0.0);
                }
                double outline = 0.0;
                for (const Face& f : cut.faces) outline += area_of(corners, f);
                EXPECT_NEAR(area, c.area, kRounding * c.area);
                EXPECT_NEAR(std::abs(outline), area, kRounding * area);
            }
    }
}

TEST(Polygon, TrianglesRunAsThePolygonDoes)
{
    const std::vector<Vec2> square = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0.5}};
    for (const Face& f : triangulate_polygon(square).faces) EXPECT_GT(area_of(square, f), 0.0);
    const std::vector<Vec2> reversed(square.rbegin(), square.rend());
    for (const Face& f : triangulate_polygon(reversed).faces) EXPECT_LT(area_of(reversed, f), 0.0);
}

TEST(Polygon, MayLieInAnyPlaneAndBeSlightlyBent)
{
    const Eigen::Quaterniond turns[] = {
        Eigen::Quaterniond::Identity(), Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5),
        Eigen::Quaterniond(0.5, -0.5, -0.5, -0.5), Eigen::Quaterniond(1, 0.3, -0.7, 0.2).normalized(),
        Eigen::Quaterniond(0, 1, 1e-4, 0).normalized()};
    for (const Case& c : simple_polygons())
        for (const Eigen::Quaterniond& turn : turns)
            for (const double bend : {0.0, 1e-6}) {
                if (std::string(c.name) == "needle" && bend > 0.0) continue;  // thinner than the bend
                double size = 0.0;
                for (const Vec2& p : c.corners) size = std::max(size, (p - c.corners[0]).norm());
                for (std::size_t start = 0; start < c.corners.size(); ++start) {
                    SCOPED_TRACE(std::string(c.name) + ", start " + std::to_string(start));
                    std::vector<Vec3> corners;
                    const std::vector<Vec2> flat = started_at(c.corners, start, false);
                    for (const Vec2& p : flat) {
                        const Vec2 q = p - c.corners[0];
                        corners.push_back(
                            turn * Vec3(q.x(), q.y(), bend * size * std::sin(37.0 * (q.x() + q.y()) / size)));
                    }
                    const PolygonTriangles cut = triangulate_polygon(corners);
                    EXPECT_EQ(cut.defect, PolygonDefect::None);
                    double area = 0.0;
                    for (const auto& [i, j, k] : cut.faces)
                        area += 0.5 * (corners[j] - corners[i]).cross(corners[k] - corners[i]).norm();
                    // A side that is bent to a corner leaves out, or takes in, a sliver as wide as rounding.
                    EXPECT_NEAR(area, c.area, 1e-5 * c.area);
                }
            }
}

// The two cuts of a saddle are different surfaces. A plane at 45 degrees has two equal components.
TEST(Polygon, BentPolygonsAreCutAlikeFromEveryStart)
{
    std::vector<std::vector<Vec3>> polygons = {
        {{0, 0, 0.1}, {1, 0, 0}, {1, 1, 0.1}, {0, 1, 0}},
        {{0, 0, 0.1}, {1, 0, 1}, {1, 1, 1.1}, {0, 1, 0}},
        {{0, 0.1, 0}, {0.1, 0, 1}, {1, 1.1, 1}, {1, 1, 0}},
        {{0.3, 0, 0},
         {0.7, 0, 0.1},
         {1, 0.3, 0},
         {1, 0.7, 0.1},
         {0.7, 1, 0},
         {0.3, 1, 0.1},
         {0, 0.7, 0},
         {0, 0.3, 0.1}},
        {{0, 0, 0}, {0, 2, 2}, {1, 2, 2.1}, {1, 1, 1}, {2, 1, 1.1}, {2, 0, 0}},
    };
    // Hexagons in a plane at 45 degrees, bent, and shifted so that rounding makes the components unequal.
    for (int k = 0; k < 100; ++k) {
        std::vector<Vec3> hexagon;
        for (int corner = 0; corner < 6; ++corner) {
            const double x = std::cos(M_PI / 3.0 * corner + 0.1), bend = corner % 2 == 0 ? 1e-3 : -1e-3;
            hexagon.emplace_back(x + bend, std::sin(M_PI / 3.0 * corner + 0.1), x - bend + 0.037 * k);
        }
        polygons.push_back(hexagon);
    }
    const auto sets = [](const std::vector<Vec3>& p) {
        std::multiset<std::set<std::array<double, 3>>> all;
        for (const Face& f : triangulate_polygon(p).faces) {
            std::set<std::array<double, 3>> triangle;
            for (const int k : f) triangle.insert({p[k].x(), p[k].y(), p[k].z()});
            all.insert(triangle);
        }
        return all;
    };
    for (const std::vector<Vec3>& polygon : polygons)
        for (std::size_t start = 0; start < polygon.size(); ++start)
            for (const bool is_reversed : {false, true})
                EXPECT_EQ(sets(started_at(polygon, start, is_reversed)), sets(polygon))
                    << &polygon - polygons.data() << " " << start;
}

// Polygons that touch themselves, as files round their corners: to single precision, and to a few digits.
struct Touching {
    const char* name;
    std::vector<Vec2> corners;
    double area;
};

std::vector<Touching> touching_polygons()
{
    return {
        {"corner on a side", {{0, 0}, {4, 0}, {4, 2}, {4 / 3.0, 0}, {0, 2}}, 4.0},
        {"hole by a bridge with a corner on one way",
         {{0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}, {1 / 3.0, 1 / 3.0}, {0, 0}, {4, 0}, {4, 4}, {0, 4}},
         12.0},
        {"bridge with corners on both ways",
         {{0, 0},
          {0.7, 0.7},
          {1, 1},
          {1, 3},
          {3, 3},
          {3, 1},
          {1, 1},
          {0.3, 0.3},
          {0, 0},
          {4, 0},
          {4, 4},
          {0, 4}},
         12.0},
        {"slit with a corner on one side",
         {{0, 0}, {4, 0}, {4, 4}, {2, 4}, {2, 2}, {2, 3}, {2, 4}, {0, 4}},
         16.0},
        {"spur", {{0, 0}, {2, 0}, {2, 1}, {3.1, 1.7}, {2, 1}, {2, 2}, {0, 2}}, 4.0},
        {"two lobes at a corner", {{0, 0}, {1, 1}, {2, 0}, {2, 2}, {1, 1}, {0, 2}}, 2.0},
        {"room whose wall touches a wall",
         {{0, 0}, {5, 0}, {5, 3}, {3, 3}, {3, 1}, {2, 1}, {2, 3}, {5, 3}, {5, 4}, {0, 4}},
         18.0},
    };
}

double area_of(const std::vector<Vec3>& corners, const std::vector<Face>& faces)
{
    double area = 0.0;
    for (const auto& [i, j, k] : faces)
        area += 0.5 * (corners[j] - corners[i]).cross(corners[k] - corners[i]).norm();
    return area;
}

TEST(Polygon, CrossingsWithinRoundingAreTouches)
{
    const Eigen::Quaterniond turn = Eigen::Quaterniond(1, 0.3, -0.7, 0.2).normalized();
    constexpr double kDigits = 1e6;  // of %.6f
    for (const Touching& c : touching_polygons())
        for (const double scale : {1.0, 1e-4, 1e5})
            for (const bool is_single : {false, true})
                for (const NearTouch touch : {NearTouch::Keep, NearTouch::Join})
                    for (std::size_t start = 0; start < c.corners.size(); ++start) {
                        SCOPED_TRACE(std::string(c.name) + ", start " + std::to_string(start));
                        std::vector<Vec3> corners;
                        for (const Vec2& p : started_at(c.corners, start, start % 2 == 1)) {
                            const Vec3 q = turn * Vec3(p.x(), p.y(), 1.0);
                            if (is_single)
                                corners.push_back((scale * q).cast<float>().cast<double>());
                            else
                                corners.push_back(scale * (kDigits * q).array().round().matrix() / kDigits);
                        }
                        const PolygonTriangles cut = triangulate_polygon(corners, touch);
                        EXPECT_EQ(cut.defect, PolygonDefect::None);
                        EXPECT_NEAR(area_of(corners, cut.faces), scale * scale * c.area,
                                    1e-5 * scale * scale * c.area);
                    }
}

// Corners that are nearly one belong to one vertex of cloth. Which of them stays depends on places only.
TEST(Polygon, JoinedCornersAreNamed)
{
    const std::vector<Vec2> bridge = {{0, 0},        {1, 1},    {1, 2}, {2, 2}, {2, 1},
                                      {1, 1 + 1e-8}, {1e-8, 0}, {3, 0}, {3, 3}, {0, 3}};
    const PolygonTriangles cut = triangulate_polygon(bridge, NearTouch::Join);
    ASSERT_EQ(cut.defect, PolygonDefect::None);
    EXPECT_EQ(cut.joined.size(), 2u);
    for (const auto& [corner, other] : cut.joined) {
        EXPECT_LT((bridge[corner] - bridge[other]).norm(), 1e-6);
        for (const Face& face : cut.faces)
            EXPECT_EQ(std::count(face.begin(), face.end(), corner), 0) << corner;
    }
    // A thin plate with corners on its long sides is a shape, and its short sides are no touches.
    std::vector<Vec2> plate;
    for (int k = 0; k <= 10; ++k) plate.emplace_back(k, 0.0);
    for (int k = 10; k >= 0; --k) plate.emplace_back(k, 2e-6);
    for (const NearTouch touch : {NearTouch::Keep, NearTouch::Join}) {
        const PolygonTriangles thin = triangulate_polygon(plate, touch);
        EXPECT_EQ(thin.defect, PolygonDefect::None);
        if (touch == NearTouch::Keep) {
            EXPECT_EQ(thin.faces.size(), plate.size() - 2);
        }
    }
}

TEST(Polygon, FansDoNotDependOnTheStart)
{
    const std::vector<std::vector<Vec3>> polygons = {
        {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}},
        {{2, 0, 1}, {0, 1, 0}, {2, 0, 1}, {0, 1, 0}, {-1, 0, 3}},
        {{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
        {{1, 0, 0}, {-0.8, 0.6, 0}, {0.3, -0.95, 0}, {0.3, 0.95, 0}, {-0.8, -0.6, 0}},
        {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 1, 0}, {3, 1, 0}, {1, 3, 0}},
    };
    const auto sets = [](const std::vector<Vec3>& p) {
        std::multiset<std::multiset<std::array<double, 3>>> all;
        for (const Face& f : fan_polygon(p)) {
            std::multiset<std::array<double, 3>> triangle;
            for (const int k : f) triangle.insert({p[k].x(), p[k].y(), p[k].z()});
            all.insert(triangle);
        }
        return all;
    };
    for (const std::vector<Vec3>& polygon : polygons)
        for (std::size_t start = 0; start < polygon.size(); ++start) {
            EXPECT_EQ(sets(started_at(polygon, start, false)), sets(polygon)) << &polygon - polygons.data();
            EXPECT_EQ(fan_polygon(polygon).size(), polygon.size() - 2);
        }
}

TEST(Polygon, BendIsTheDistanceFromThePlane)
{
    EXPECT_NEAR(find_bend({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}).distance, 0.0, 1e-15);
    const PolygonBend bend = find_bend({{0, 0, 0.1}, {2, 0, -0.1}, {2, 2, 0.1}, {0, 2, -0.1}});
    EXPECT_NEAR(bend.distance, 0.1, 1e-12);
    EXPECT_NEAR(bend.size, std::sqrt(2.0 + 0.01), 1e-12);
}

TEST(Polygon, DefectsAreNamed)
{
    struct Defect {
        const char* name;
        std::vector<Vec2> corners;
        PolygonDefect defect;
    };
    std::vector<Vec2> pentagram;
    for (int k = 0; k < 5; ++k) pentagram.emplace_back(std::cos(0.8 * M_PI * k), std::sin(0.8 * M_PI * k));
    const std::vector<Defect> cases = {
        {"symmetric bow-tie", {{0, 0}, {1, 1}, {1, 0}, {0, 1}}, PolygonDefect::CrossesItself},
        {"bow-tie", {{0, 0}, {1, 0}, {0.2, 1}, {0.8, 1.2}}, PolygonDefect::CrossesItself},
        {"pentagram", pentagram, PolygonDefect::CrossesItself},
        {"twice around", {{0, 0}, {1, 0}, {0, 1}, {0, 0}, {1, 0}, {0, 1}}, PolygonDefect::CrossesItself},
        {"loop inside", {{0, 0}, {4, 0}, {4, 4}, {2, 1}, {3, 1}, {1, 3}}, PolygonDefect::CrossesItself},
        {"collinear", {{0, 0}, {1, 1}, {2, 2}, {3, 3}}, PolygonDefect::NoArea},
        {"point", {{1, 2}, {1, 2}, {1, 2}, {1, 2}}, PolygonDefect::NoArea},
        {"there and back", {{0, 0}, {1, 0}, {1, 1}, {1, 0}}, PolygonDefect::NoArea},
    };
    for (const Defect& d : cases)
        for (std::size_t start = 0; start < d.corners.size(); ++start)
            for (const bool is_reversed : {false, true}) {
                const std::vector<Vec2> corners = started_at(d.corners, start, is_reversed);
                EXPECT_EQ(triangulate_polygon(corners).defect, d.defect) << d.name << " " << start;
                EXPECT_TRUE(triangulate_polygon(corners).faces.empty()) << d.name;
                std::vector<Vec3> placed;
                for (const Vec2& p : corners) placed.emplace_back(0.25, p.x(), p.y());
                EXPECT_EQ(triangulate_polygon(placed).defect, d.defect) << d.name << " " << start;
            }
}

// Rounded corners of a grid's cells must not turn some of its cuts.
TEST(Polygon, CellsOfAGridAreCutAlike)
{
    const double angle = 0.3;
    for (int j = 0; j < 20; ++j)
        for (int i = 0; i < 20; ++i) {
            const auto at = [&](int a, int b) {
                const double x = (i + a) / 7.0, y = (j + b) / 11.0;
                return Vec2(static_cast<float>(std::cos(angle) * x - std::sin(angle) * y),
                            static_cast<float>(std::sin(angle) * x + std::cos(angle) * y));
            };
            const PolygonTriangles cut =
                triangulate_polygon(std::vector<Vec2>{at(0, 0), at(1, 0), at(1, 1), at(0, 1)});
            EXPECT_EQ(cut.faces, (std::vector<Face>{{0, 1, 2}, {0, 2, 3}})) << i << " " << j;
        }
}

TEST(Polygon, ManyCornersTakeNoQuadraticTime)
{
    std::vector<Vec2> circle;
    constexpr int kCorners = 20000;
    for (int k = 0; k < kCorners; ++k) {
        const double angle = 2.0 * M_PI * k / kCorners;
        circle.emplace_back((k % 2 == 0 ? 1.0 : 0.9) * std::cos(angle),
                            (k % 2 == 0 ? 1.0 : 0.9) * std::sin(angle));
    }
    EXPECT_EQ(triangulate_polygon(circle).faces.size(), static_cast<std::size_t>(kCorners - 2));
}

}  // namespace
}  // namespace arris
