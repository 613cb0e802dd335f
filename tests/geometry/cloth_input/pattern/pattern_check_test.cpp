// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/pattern/pattern_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "geometry/input_error.h"
#include "tests/geometry/cloth_input/pattern/pattern_samples.h"

namespace arris {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::string refusal(const SewingPattern& pattern)
{
    try {
        check_pattern(pattern);
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

std::string refusal_of(const SewingPattern& sample, const std::function<void(SewingPattern&)>& damage)
{
    SewingPattern pattern = sample;
    damage(pattern);
    return refusal(pattern);
}

TEST(PatternCheck, SoundPatternsPass)
{
    for (const SewingPattern& pattern :
         {two_rectangles(), pillow(), tube(0.4, 0.3), dart(), cone(0.3, 200.0), moebius_strip(), top()})
        EXPECT_EQ(refusal(pattern), "accepted");
}

TEST(PatternCheck, NamesPanelsThatCannotBe)
{
    const SewingPattern good = two_rectangles();
    EXPECT_EQ(refusal(SewingPattern{}), "the pattern: has no panel; allowed: one or more panels");
    EXPECT_EQ(refusal_of(good, [](auto& p) { p.panels[1].name = ""; }),
              "panel 1: has no name; allowed: a name that no other panel has");
    EXPECT_EQ(refusal_of(good, [](auto& p) { p.panels[1].name = "left"; }),
              "panel \"left\": is there twice; allowed: a name that no other panel has");
    EXPECT_EQ(refusal_of(good, [](auto& p) { p.panels[0].edges.resize(2); }),
              "panel \"left\": has 2 corners; allowed: three or more");
    EXPECT_EQ(refusal_of(good, [](auto& p) { p.panels.resize(1001, p.panels[0]); }),
              "the pattern: has 1001 panels; allowed: at most 1000");
    EXPECT_EQ(refusal_of(good, [](auto& p) { p.panels[0].edges.resize(7000, p.panels[0].edges[0]); }),
              "the pattern: has 7004 edges; allowed: at most 6250");
}

TEST(PatternCheck, NamesValuesThatAreNotFinite)
{
    const SewingPattern good = two_rectangles();
    EXPECT_EQ(refusal_of(good, [](auto& p) { p.panels[0].edges[2].begin.x() = kNan; }),
              "panel \"left\", edge 2: begins at (nan, 0.3) m; allowed: finite numbers up to 1e+06 m");
    EXPECT_EQ(refusal_of(good, [](auto& p) { p.panels[0].edges[1].shape = BezierCurve{{Vec2(0.0, 2e6)}}; }),
              "panel \"left\", edge 1: has the control point (0, 2000000) m; allowed: finite numbers up to "
              "1e+06 m");
    EXPECT_EQ(refusal_of(good,
                         [](auto& p) {
                             p.panels[0].edges[1].shape = CircularArc{kNan, false, true};
                         }),
              "panel \"left\", edge 1: has a radius of nan m; allowed: finite numbers up to 1e+06 m");
    EXPECT_EQ(refusal_of(good, [](auto& p) { p.panels[0].placement.translation.z() = kNan; }),
              "panel \"left\": is not placed at a finite place; allowed: finite numbers up to 1e+06 m");
    EXPECT_EQ(refusal_of(good, [](auto& p) { p.panels[0].placement.rotation(0, 0) = kNan; }),
              "panel \"left\": is not placed at a finite place; allowed: finite numbers up to 1e+06 m");
}

TEST(PatternCheck, NamesEdgesThatCannotBe)
{
    const SewingPattern good = two_rectangles();
    EXPECT_EQ(refusal_of(good, [](auto& p) { p.panels[0].edges[1].begin = Vec2(0.0, 0.0); }),
              "panel \"left\", edge 0: has no length; allowed: edges between two different corners");
    EXPECT_EQ(
        refusal_of(good,
                   [](auto& p) {
                       p.panels[0].edges[1].shape = CircularArc{0.1, false, true};
                   }),
        "panel \"left\", edge 1: is an arc with a radius of 0.1 m between corners 0.3 m apart; allowed: a "
        "radius of at least half of that");
    EXPECT_EQ(refusal_of(good,
                         [](auto& p) {
                             p.panels[0].edges[1].shape = BezierCurve{std::vector<Vec2>(3, Vec2::Zero())};
                         }),
              "panel \"left\", edge 1: has 3 control points; allowed: none, one or two");
}

TEST(PatternCheck, NamesLoopsThatCrossThemselvesAndWhere)
{
    const std::string bow_tie = refusal_of(
        two_rectangles(), [](auto& p) { std::swap(p.panels[0].edges[0].begin, p.panels[0].edges[1].begin); });
    EXPECT_THAT(bow_tie,
                AllOf(HasSubstr("panel \"left\": its loop its side from"), HasSubstr("crosses the side"),
                      HasSubstr("; allowed: sides that neither cross nor touch one another")));
    // The curved top runs through the bottom.
    EXPECT_THAT(refusal_of(two_rectangles(),
                           [](auto& p) { p.panels[1].edges[2].shape = BezierCurve{{Vec2(0.2, -0.4)}}; }),
                AllOf(HasSubstr("panel \"right\""), HasSubstr("cross")));
}

TEST(PatternCheck, NamesPanelsTooSmallOrTooLarge)
{
    const auto scaled = [](double factor) {
        return refusal_of(two_rectangles(), [&](auto& p) {
            for (PanelEdge& edge : p.panels[1].edges) edge.begin *= factor;
        });
    };
    EXPECT_EQ(scaled(1e-6), "panel \"right\": is 4e-07 m large; allowed: 1e-06 to 10000 m");
    EXPECT_EQ(scaled(1e5), "panel \"right\": is 4e+04 m large; allowed: 1e-06 to 10000 m");
}

TEST(PatternCheck, NamesSeamsThatCannotBe)
{
    const SewingPattern good = two_rectangles();
    EXPECT_EQ(refusal_of(good, [](auto& p) { p.seams[0].sides[1].panel = 2; }),
              "seam 0: names panel 2; allowed: 0 to 1");
    EXPECT_EQ(refusal_of(good, [](auto& p) { p.seams[0].sides[1].panel = -1; }),
              "seam 0: names panel -1; allowed: 0 to 1");
    EXPECT_EQ(refusal_of(good, [](auto& p) { p.seams[0].sides[1].edge = 4; }),
              "seam 0: names edge 4 of panel \"right\"; allowed: 0 to 3");
    EXPECT_EQ(refusal_of(good, [](auto& p) { p.seams[0].sides[1].count = 5; }),
              "seam 0: has 5 edges of panel \"right\"; allowed: 1 to 4");
    EXPECT_EQ(
        refusal_of(good, [](auto& p) { p.seams[0].sides[1].is_backward = false; }),
        "seam 0 (panel \"left\", edge 1 with panel \"right\", edge 3): joins the right side of cloth to a "
        "wrong side; allowed: a seam in the other direction, a panel that is turned over, or a tie");
}

TEST(PatternCheck, NamesEdgesSewnTwice)
{
    const SewingPattern good = two_rectangles();
    EXPECT_EQ(
        refusal_of(good, [](auto& p) { p.seams.push_back(simple_seam(0, 3, 1, 3)); }),
        "panel \"right\", edge 3: is sewn twice, in seams 0 and 1; allowed: one seam an edge, or a tie");
    EXPECT_EQ(refusal_of(good, [](auto& p) { p.seams[0] = simple_seam(0, 1, 0, 1); }),
              "panel \"left\", edge 1: is sewn twice, on both sides of seam 0; allowed: one seam an edge");
    EXPECT_EQ(refusal_of(good,
                         [](auto& p) {
                             p.seams[0].sides[0].count = 3;
                             p.seams.push_back(simple_seam(0, 3, 1, 1));
                         }),
              "panel \"left\", edge 3: is sewn twice, in seams 0 and 1; allowed: one seam an edge, or a tie");
}

TEST(PatternCheck, TieMayShareASeamsEdgeOnOneSide)
{
    SewingPattern good = two_rectangles();
    good.panels.push_back(rectangle_panel("third", {0.2, 0.3}));
    const auto tied = [&](const Seam& seam) {
        return refusal_of(good, [&](auto& p) {
            p.seams.insert(p.seams.begin(), seam);  // a tie before the seam is checked after it
            p.seams.front().is_tie = true;
        });
    };
    EXPECT_EQ(tied(simple_seam(2, 3, 0, 1)), "accepted");
    EXPECT_EQ(tied(simple_seam(1, 3, 0, 1)),
              "seam 0 (panel \"right\", edge 3 with panel \"left\", edge 1): has other seams on both sides; "
              "allowed: "
              "a tie with one side that no other seam joins");
    Seam pocket = simple_seam(2, 0, 0, 0);
    const auto along = [&](const std::vector<Vec2>& line) {
        pocket.sides[1] = {0, 0, 0, false, line};
        return tied(pocket);
    };
    EXPECT_EQ(along({Vec2(0.1, 0.1), Vec2(0.3, 0.1)}), "accepted");
    EXPECT_EQ(along({Vec2(0.1, 0.1)}),
              "seam 0 has a line within panel \"left\": with 1 corners; allowed: two or more");
    EXPECT_EQ(
        along({Vec2(0.1, 0.1), Vec2(0.1, 0.1)}),
        "seam 0 has a line within panel \"left\": that stays at one place; allowed: corners that differ");
    EXPECT_EQ(along({Vec2(0.1, 0.1), Vec2(0.11, 0.1)}),
              "seam 0 (panel \"third\", edge 0 with panel \"left\", from (0.1, 0.1) to (0.11, 0.1) m): has "
              "sides of "
              "0.2 and 0.01 m; allowed: one at most 4 times as long as the other");
    EXPECT_EQ(
        refusal_of(good,
                   [](auto& p) {
                       p.seams.push_back(simple_seam(2, 0, 0, 0));
                       p.seams.back().sides[1] = {0, 0, 0, false, {Vec2(0.1, 0.1), Vec2(0.3, 0.1)}};
                   }),
        "seam 1 (panel \"third\", edge 0 with panel \"left\", from (0.1, 0.1) to (0.3, 0.1) m): joins a line "
        "within a panel; allowed: as a tie");
}

TEST(PatternCheck, NamesSeamsOfTooDifferentLengths)
{
    const auto with_side = [](double length) {
        return refusal_of(two_rectangles(), [&](auto& p) {
            p.panels[1] = rectangle_panel("right", {0.4, length});
        });
    };
    EXPECT_EQ(with_side(1.199), "accepted");
    EXPECT_EQ(with_side(1.21),
              "seam 0 (panel \"left\", edge 1 with panel \"right\", edge 3): has sides of 0.3 and 1.21 m; "
              "allowed: one at most 4 times as long as the other");
    EXPECT_EQ(with_side(0.07),
              "seam 0 (panel \"left\", edge 1 with panel \"right\", edge 3): has sides of 0.3 and 0.07 m; "
              "allowed: one at most 4 times as long as the other");
}

}  // namespace
}  // namespace arris
