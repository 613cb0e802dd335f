// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/pattern/pattern_border.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geometry/input_error.h"
#include "tests/geometry/cloth_input/pattern/pattern_samples.h"

namespace arris {
namespace {

constexpr double kRounded = 1e-12;  // m
constexpr double kArc = 1e-9;       // m, lengths of Bezier curves

// Distances along a polyline of border vertices from a corner on.
std::vector<double> lengths_from(const PatternBorders& borders, const std::vector<PanelVertexPair>& seam,
                                 std::size_t side)
{
    std::vector<double> lengths = {0.0};
    for (std::size_t k = 1; k < seam.size(); ++k) {
        const auto place = [&](std::size_t i) {
            return borders.panels[seam[i][side].panel].places[seam[i][side].vertex];
        };
        lengths.push_back(lengths.back() + (place(k) - place(k - 1)).norm());
    }
    return lengths;
}

TEST(PatternBorder, FreeEdgesAreDividedByTheirOwnLengthRoundedUp)
{
    SewingPattern pattern = two_rectangles();
    pattern.seams.clear();
    const PatternBorders borders = divide_borders(pattern, 0.07);
    EXPECT_EQ(borders.panels[0].corners, (std::vector<int>{0, 6, 11, 17, 22}))
        << "0.4 / 0.07 = 5.7, 0.3 / 0.07 = 4.3";
    EXPECT_NEAR((borders.panels[0].places[1] - Vec2(0.4 / 6.0, 0.0)).norm(), 0.0, kRounded);
    EXPECT_EQ(borders.panels[0].places[11], Vec2(0.4, 0.3));
    // A length that is a multiple but for rounding gets no interval more.
    EXPECT_EQ(divide_borders(pattern, 0.1).panels[0].corners, (std::vector<int>{0, 4, 7, 11, 14}));
}

TEST(PatternBorder, TieAtASewnEdgeTakesItsVertices)
{
    SewingPattern pattern = two_rectangles();
    pattern.panels[1] = rectangle_panel("right", {0.4, 0.45});
    pattern.panels.push_back(
        polygon_panel("third", {{0.0, 0.0}, {0.1, 0.0}, {0.1, 0.25}, {0.0, 0.25}, {0.0, 0.11}}));
    Seam tie = simple_seam(2, 3, 0, 1);  // edges 3 and 4 of the third: a corner within the side
    tie.sides[0].count = 2;
    tie.is_tie = true;
    pattern.seams.insert(pattern.seams.begin(), tie);
    const PatternBorders borders = divide_borders(pattern, 0.1);
    EXPECT_EQ(borders.panels[0].corners[2] - borders.panels[0].corners[1], 5) << "as without the tie";
    ASSERT_EQ(borders.seams[0].size(), 6U);
    for (int k = 0; k < 6; ++k) {
        const auto& [third, left] = borders.seams[0][static_cast<std::size_t>(k)];
        const double way = 0.25 - borders.panels[2].places[third.vertex].y();
        const double share = borders.panels[0].places[left.vertex].y() / 0.3;
        EXPECT_NEAR(way / 0.25, 1.0 - share, k == 2 || k == 3 ? 0.05 : kRounded) << k;
    }
}

TEST(PatternBorder, LinesWithinAPanelMeetWhereTheyEndTogether)
{
    // A pocket on the left panel, tied along three sides.
    SewingPattern pattern = two_rectangles();
    pattern.panels.push_back(rectangle_panel("pocket", {0.1, 0.1}));
    const std::vector<Vec2> corners = {{0.1, 0.2}, {0.1, 0.1}, {0.2, 0.1}, {0.2, 0.2}};
    for (int k = 0; k < 3; ++k) {
        Seam tie;
        tie.sides[0] = {2, (3 + k) % 4, 1, false, {}};
        tie.sides[1] = {0, 0, 0, false, {corners[k], corners[k + 1]}};
        tie.is_tie = true;
        pattern.seams.push_back(tie);
    }
    const PatternBorders borders = divide_borders(pattern, 0.05);
    const auto border = static_cast<int>(borders.panels[0].places.size());
    EXPECT_EQ(borders.panels[0].inside.size(), 7U) << "two cells a side";
    for (int k = 0; k < 3; ++k) {
        const std::vector<PanelVertexPair>& pairs = borders.seams[1 + k];
        ASSERT_EQ(pairs.size(), 3U);
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec2 place = borders.panels[0].inside[pairs[i][1].vertex - border];
            EXPECT_LT((place - (corners[k] + 0.5 * double(i) * (corners[k + 1] - corners[k]))).norm(),
                      kRounded);
            EXPECT_LT((place - Vec2(0.1, 0.1) - borders.panels[2].places[pairs[i][0].vertex]).norm(),
                      kRounded);
        }
    }
    pattern.seams.back().sides[1].line[1] = {0.39, 0.1};
    EXPECT_THROW(divide_borders(pattern, 0.05), InputError) << "too near the border";
    pattern.seams.back().sides[1].line[1] = {0.45, 0.1};
    EXPECT_THROW(divide_borders(pattern, 0.05), InputError) << "outside";
}

TEST(PatternBorder, BothSidesOfASeamHaveTheCountOfTheLongerOne)
{
    SewingPattern pattern = two_rectangles();
    pattern.panels[1] = rectangle_panel("right", {0.4, 0.45});
    const PatternBorders borders = divide_borders(pattern, 0.1);
    EXPECT_EQ(borders.panels[0].corners[2] - borders.panels[0].corners[1], 5);
    EXPECT_EQ(borders.panels[1].corners[4] - borders.panels[1].corners[3], 5);
    ASSERT_EQ(borders.seams[0].size(), 6U);
    for (int k = 0; k < 6; ++k) {
        const auto& [a, b] = borders.seams[0][static_cast<std::size_t>(k)];
        EXPECT_EQ(a.panel, 0);
        EXPECT_EQ(b.panel, 1);
        EXPECT_NEAR((borders.panels[0].places[a.vertex] - Vec2(0.4, 0.06 * k)).norm(), 0.0, kRounded);
        EXPECT_NEAR((borders.panels[1].places[b.vertex] - Vec2(0.0, 0.09 * k)).norm(), 0.0, kRounded);
    }
}

TEST(PatternBorder, CountsDoNotDependOnWhichSideComesFirst)
{
    SewingPattern pattern = two_rectangles();
    pattern.panels[1] = rectangle_panel("right", {0.4, 0.45});
    std::swap(pattern.seams[0].sides[0], pattern.seams[0].sides[1]);
    EXPECT_EQ(divide_borders(pattern, 0.1).seams[0].size(), 6U);
}

TEST(PatternBorder, SharesOfArcLengthAreEqualAlongCurves)
{
    // A straight side of length pi / 4 sewn to a quarter of a circle of radius 1/2.
    SewingPattern pattern;
    pattern.panels = {polygon_panel("fan", {{0.0, 0.0}, {0.5, 0.0}, {0.0, 0.5}}),
                      rectangle_panel("cuff", {0.25 * std::numbers::pi, 0.2})};
    pattern.panels[0].edges[1].shape = CircularArc{0.5, false, true};
    pattern.seams = {simple_seam(0, 1, 1, 2)};
    const PatternBorders borders = divide_borders(pattern, 0.1);
    ASSERT_EQ(borders.seams[0].size(), 9U);
    for (int k = 0; k <= 8; ++k) {
        const auto& [a, b] = borders.seams[0][static_cast<std::size_t>(k)];
        const double angle = 0.5 * std::numbers::pi * k / 8.0;
        const Vec2 on_arc = 0.5 * Vec2(std::cos(angle), std::sin(angle));
        EXPECT_NEAR((borders.panels[0].places[a.vertex] - on_arc).norm(), 0.0, kRounded);
        EXPECT_NEAR((borders.panels[1].places[b.vertex] - Vec2(0.5 * angle, 0.2)).norm(), 0.0, kArc);
    }
}

TEST(PatternBorder, DartsShareTheirTip)
{
    const PatternBorders borders = divide_borders(dart(), 0.05);
    ASSERT_EQ(borders.seams[0].size(), 5U) << "five intervals, and the tip in no pair";
    const int tip = borders.panels[0].corners[4];
    for (int k = 0; k < 5; ++k) {
        const auto& [a, b] = borders.seams[0][static_cast<std::size_t>(k)];
        EXPECT_EQ(a.vertex, tip - 5 + k);
        EXPECT_EQ(b.vertex, tip + 5 - k);
    }
}

TEST(PatternBorder, TubesPairTheirTwoEdges)
{
    const PatternBorders borders = divide_borders(tube(0.4, 0.3), 0.1);
    ASSERT_EQ(borders.seams[0].size(), 4U);
    EXPECT_EQ(borders.seams[0][0], (PanelVertexPair{PanelVertex{0, 4}, PanelVertex{0, 0}}));
    EXPECT_EQ(borders.seams[0][3], (PanelVertexPair{PanelVertex{0, 7}, PanelVertex{0, 11}}));
}

// Side of two edges, 0.1 and 0.3 m, against one of a single edge or of two.
class SidesOfSeveralEdges : public ::testing::Test {
  protected:
    static SewingPattern make(double other_corner)
    {
        SewingPattern pattern;
        pattern.panels = {
            polygon_panel("one", {{0.0, 0.0}, {0.1, 0.0}, {0.4, 0.0}, {0.4, 0.2}, {0.0, 0.2}}),
            polygon_panel("other", {{0.0, 0.0}, {0.4, 0.0}, {0.4, 0.2}, {other_corner, 0.2}, {0.0, 0.2}})};
        Seam seam;
        seam.sides = {SeamSide{0, 0, 2}, SeamSide{1, 2, 2, true}};
        pattern.seams = {seam};
        return pattern;
    }
};

TEST_F(SidesOfSeveralEdges, HaveTheCornersOfBothAsVertices)
{
    const PatternBorders borders = divide_borders(make(0.25), 0.1);
    // Corners at 0.1 and 0.25 m: one, two and two intervals.
    ASSERT_EQ(borders.seams[0].size(), 6U);
    const std::vector<double> expected = {0.0, 0.1, 0.175, 0.25, 0.325, 0.4};
    for (const std::size_t side : {0U, 1U}) {
        const std::vector<double> lengths = lengths_from(borders, borders.seams[0], side);
        for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(lengths[k], expected[k], kRounded);
    }
}

TEST_F(SidesOfSeveralEdges, MeetAtCornersThatAreNearEachOther)
{
    const PatternBorders borders = divide_borders(make(0.12), 0.1);
    // Corners 2 cm apart meet: two intervals of up to 0.12 m, and three.
    ASSERT_EQ(borders.seams[0].size(), 6U);
    EXPECT_NEAR(lengths_from(borders, borders.seams[0], 0)[2], 0.1, kRounded);
    EXPECT_NEAR(lengths_from(borders, borders.seams[0], 1)[2], 0.12, kRounded);
}

TEST(PatternBorder, ClosedSeamPairsItsEndOnce)
{
    // The whole border of a triangle, three edges, with three edges of a strip's bottom.
    SewingPattern pattern;
    pattern.panels = {
        polygon_panel("lid", {{0.0, 0.0}, {0.3, 0.0}, {0.0, 0.4}}),
        polygon_panel("wall", {{0.0, 0.0}, {0.3, 0.0}, {0.8, 0.0}, {1.2, 0.0}, {1.2, 0.2}, {0.0, 0.2}})};
    Seam seam;
    seam.sides = {SeamSide{0, 0, 3, true}, SeamSide{1, 0, 3}};
    pattern.seams = {seam, simple_seam(1, 3, 1, 5)};
    const PatternBorders borders = divide_borders(pattern, 0.1);
    ASSERT_EQ(borders.seams[0].size(), 13U) << "the wall's two ends are different vertices";
    EXPECT_EQ(borders.seams[0].front()[0], borders.seams[0].back()[0]);
    EXPECT_EQ(find_fault(pattern, 0.1), "");
    // Two such lids, one the mirror image of the other: both sides come back to their beginning.
    pattern.panels[1] = polygon_panel("base", {{0.0, 0.0}, {0.0, 0.4}, {0.3, 0.0}});
    seam.sides = {SeamSide{0, 0, 3}, SeamSide{1, 0, 3, true}};
    pattern.seams = {seam};
    EXPECT_EQ(divide_borders(pattern, 0.1).seams[0].size(), 12U);
    EXPECT_EQ(find_fault(pattern, 0.1), "");
}

}  // namespace
}  // namespace arris
