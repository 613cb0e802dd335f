// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/pattern/edge_curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "geometry/cloth_input/cloth_outline.h"

namespace arris {
namespace {

constexpr double kLength = 1e-9;    // relative: the rule of five points on 64 parts
constexpr double kRounded = 1e-13;  // relative: closed forms
constexpr double kPi = std::numbers::pi;

EdgeCurve bezier(const std::vector<Vec2>& points)
{
    PanelEdge edge;
    edge.begin = points.front();
    edge.shape = BezierCurve{std::vector<Vec2>(points.begin() + 1, points.end() - 1)};
    return {edge, points.back()};
}

EdgeCurve arc(const Vec2& begin, const Vec2& end, const CircularArc& shape)
{
    PanelEdge edge;
    edge.begin = begin;
    edge.shape = shape;
    return {edge, end};
}

// Signed area between the curve and its chord, by a polygon.
double area_beside(const EdgeCurve& curve, int parts)
{
    std::vector<Vec2> polygon;
    for (int k = 0; k <= parts; ++k) polygon.push_back(curve.at(double(k) / parts));
    return area_of(BorderLoops{polygon});
}

// Pieces of the curve between equal shares of its length.
void expect_equal_pieces(const EdgeCurve& curve)
{
    constexpr int kPieces = 40;
    constexpr int kFine = 400;  // chords of a piece
    for (int piece = 0; piece < kPieces; ++piece) {
        double length = 0.0;
        for (int k = 0; k < kFine; ++k) {
            const double share = (piece + double(k) / kFine) / kPieces;
            length += (curve.at(share + 1.0 / (kFine * kPieces)) - curve.at(share)).norm();
        }
        EXPECT_NEAR(length, curve.length() / kPieces, 1e-5 * curve.length()) << "piece " << piece;
    }
}

TEST(EdgeCurve, StraightLineHasItsLengthAndEqualParts)
{
    const EdgeCurve line = bezier({{1.0, 2.0}, {4.0, 6.0}});
    EXPECT_TRUE(line.is_straight());
    EXPECT_DOUBLE_EQ(line.length(), 5.0);
    EXPECT_NEAR((line.at(0.3) - Vec2(1.9, 3.2)).norm(), 0.0, kRounded);
}

TEST(EdgeCurve, ParabolaHasLengthAndAreaOfItsClosedForm)
{
    // y = 2 x (1 - x) from 0 to 1: control (1/2, 1).
    const EdgeCurve parabola = bezier({{0.0, 0.0}, {0.5, 1.0}, {1.0, 0.0}});
    // Length of y = a x^2 over [-w, w] with s = 2 a w: w sqrt(1 + s^2) + w asinh(s) / s.
    const double a = 2.0, w = 0.5, s = 2.0 * a * w;
    EXPECT_NEAR(parabola.length(), w * std::sqrt(1.0 + s * s) + w * std::asinh(s) / s, kLength);
    EXPECT_NEAR(area_beside(parabola, 20000), -1.0 / 3.0, 1e-8) << "2/3 of its triangle";
    expect_equal_pieces(parabola);
}

TEST(EdgeCurve, CubicHasLengthAndAreaOfItsClosedForm)
{
    // Of x = 3 t^2 - 2 t^3 and y = 0 speed vanishes at the ends; a straight line, not equally run through.
    const EdgeCurve line = bezier({{0.0, 0.0}, {0.0, 0.0}, {1.0, 0.0}, {1.0, 0.0}});
    EXPECT_NEAR(line.length(), 1.0, kLength);
    for (const double share : {0.01, 0.2, 0.5, 0.93}) EXPECT_NEAR(line.at(share).x(), share, kLength);
    // y(x) with control points at x = 0, 1/3, 2/3, 1 has the area (y1 + y2) / 4 above its chord.
    const EdgeCurve graph = bezier({{0.0, 0.0}, {1.0 / 3.0, 0.4}, {2.0 / 3.0, -0.1}, {1.0, 0.0}});
    EXPECT_NEAR(area_beside(graph, 20000), -(0.4 - 0.1) / 4.0, 1e-8);
    expect_equal_pieces(graph);
}

TEST(EdgeCurve, LengthDoesNotDependOnDirection)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> at(-1.0, 1.0);
    for (int trial = 0; trial < 50; ++trial) {
        std::vector<Vec2> points;
        for (int k = 0; k < 4; ++k) points.emplace_back(at(random), at(random));
        const EdgeCurve there = bezier(points);
        const EdgeCurve back = bezier({points.rbegin(), points.rend()});
        EXPECT_NEAR(there.length(), back.length(), kLength);
        for (const double share : {0.1, 0.37, 0.8})
            EXPECT_NEAR((there.at(share) - back.at(1.0 - share)).norm(), 0.0, 1e-8);
    }
}

TEST(EdgeCurve, CuspNeedsBoundedWorkAndLosesLittle)
{
    const EdgeCurve back = bezier({{0.0, 0.0}, {2.0, 0.0}, {1.0, 0.0}});
    // x = 4 t - 3 t^2, greatest at t = 2/3: 4/3; then back to 1.
    EXPECT_NEAR(back.length(), 4.0 / 3.0 + 1.0 / 3.0, 1e-4);
    for (int k = 0; k <= 100; ++k) EXPECT_TRUE(back.at(k / 100.0).allFinite());
}

TEST(EdgeCurve, ArcsHaveLengthAreaAndSideOfTheirClosedForm)
{
    // Quarter of a circle from (1, 0) to (0, 1), counter-clockwise about the origin: to the right of the
    // chord.
    const EdgeCurve quarter = arc({1.0, 0.0}, {0.0, 1.0}, {1.0, false, true});
    EXPECT_NEAR(quarter.length(), kPi / 2.0, kRounded);
    EXPECT_NEAR(quarter.at(0.5).norm(), 1.0, kRounded);
    EXPECT_GT(quarter.at(0.5).x() + quarter.at(0.5).y(), 1.0);
    EXPECT_NEAR(area_beside(quarter, 20000), kPi / 4.0 - 0.5, 1e-8);
    // The rest of this circle, clockwise.
    const EdgeCurve rest = arc({1.0, 0.0}, {0.0, 1.0}, {1.0, true, false});
    EXPECT_NEAR(rest.length(), 1.5 * kPi, kRounded);
    EXPECT_NEAR((rest.at(0.5) + Vec2(1.0, 1.0).normalized()).norm(), 0.0, kRounded);
    // About (1, 1): a small one clockwise, and a large one counter-clockwise.
    const EdgeCurve inner = arc({1.0, 0.0}, {0.0, 1.0}, {1.0, false, false});
    EXPECT_NEAR((inner.at(0.5) - Vec2(1.0, 1.0)).norm(), 1.0, kRounded);
    EXPECT_NEAR(inner.length(), kPi / 2.0, kRounded);
    const EdgeCurve outer = arc({1.0, 0.0}, {0.0, 1.0}, {1.0, true, true});
    EXPECT_NEAR((outer.at(0.5) - Vec2(1.0, 1.0) - Vec2(1.0, 1.0).normalized()).norm(), 0.0, kRounded);
}

TEST(EdgeCurve, ArcThatIsRoundedTooSmallIsHalfACircle)
{
    const EdgeCurve half = arc({0.0, 0.0}, {2.0, 0.0}, {0.9999999, false, true});
    EXPECT_NEAR(half.length(), kPi, kRounded);
    EXPECT_NEAR((half.at(0.5) - Vec2(1.0, -1.0)).norm(), 0.0, kRounded);
}

TEST(EdgeCurve, EndsAreExactForEveryKind)
{
    const Vec2 begin(0.1, 0.7), end(0.3, -0.9);
    for (const EdgeCurve& curve :
         {bezier({begin, end}), bezier({begin, {0.2, 0.3}, end}),
          bezier({begin, {0.2, 0.3}, {1.0, 0.1}, end}), arc(begin, end, {1.0, false, true})}) {
        EXPECT_EQ(curve.at(0.0), begin);
        EXPECT_EQ(curve.at(1.0), end);
    }
}

}  // namespace
}  // namespace arris
