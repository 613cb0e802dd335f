// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/report/svg_plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <regex>

namespace arris {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Every coordinate pair of the drawing's lines and areas.
std::vector<std::array<double, 2>> drawn_points(const std::string& svg)
{
    std::vector<std::array<double, 2>> points;
    const std::regex path("class=\"(line|area)[^\"]*\" d=\"([^\"]*)\""), pair("[ML](-?[0-9.]+) (-?[0-9.]+)");
    for (std::sregex_iterator p(svg.begin(), svg.end(), path), end; p != end; ++p) {
        const std::string data = (*p)[2];
        for (std::sregex_iterator q(data.begin(), data.end(), pair); q != end; ++q)
            points.push_back({std::stod((*q)[1]), std::stod((*q)[2])});
    }
    return points;
}

Plot plot_of(const std::vector<std::array<double, 2>>& points, PlotKind kind = PlotKind::Lines)
{
    return {"Title", "J", kind, {{"line", points}}};
}

TEST(RoundTicks, SpanTheRangeInRoundSteps)
{
    EXPECT_EQ(round_ticks(0.0, 1.0, 5), (std::vector<double>{0.0, 0.2, 0.4, 0.2 * 3, 0.8, 1.0}));
    EXPECT_EQ(round_ticks(-3.0, 7.0, 5), (std::vector<double>{-4.0, -2.0, 0.0, 2.0, 4.0, 6.0, 8.0}));
    EXPECT_EQ(round_ticks(0.0, 2.0, 4), (std::vector<double>{0.0, 0.5, 1.0, 1.5, 2.0}));
}

TEST(RoundTicks, AreFewAndAscendingWhateverTheNumbers)
{
    constexpr double kTiny = std::numeric_limits<double>::denorm_min();
    for (const auto& [least, greatest] : std::vector<std::array<double, 2>>{{0, 0},
                                                                            {5, 5},
                                                                            {-5, -5},
                                                                            {0, kTiny},
                                                                            {kTiny, 2 * kTiny},
                                                                            {-1e300, 1e300},
                                                                            {1e300, 1e300},
                                                                            {1.0, std::nextafter(1.0, 2.0)},
                                                                            {123456789.0, 123456789.1},
                                                                            {-1e-200, 1e200},
                                                                            {1e-300, 3e-300}}) {
        const std::vector<double> ticks = round_ticks(least, greatest, 5);
        ASSERT_GE(ticks.size(), 2U) << least << " " << greatest;
        EXPECT_LE(ticks.size(), 20U) << least << " " << greatest;
        for (std::size_t i = 1; i < ticks.size(); ++i) EXPECT_LT(ticks[i - 1], ticks[i]);
        const double slack = 1e-5 * (ticks[1] - ticks[0]);
        EXPECT_LE(ticks.front(), least + slack);
        EXPECT_GE(ticks.back(), greatest - slack);
    }
}

TEST(SvgPlot, KeepsEveryPointInsideTheDrawing)
{
    constexpr double kTiny = std::numeric_limits<double>::denorm_min(),
                     kHuge = std::numeric_limits<double>::max();
    for (const PlotKind kind : {PlotKind::Lines, PlotKind::LogLines, PlotKind::Stacked})
        for (const auto& ys : std::vector<std::vector<double>>{{0, 0, 0},
                                                               {1, 2, 3},
                                                               {kTiny, 0, 1},
                                                               {kHuge, 1, 2},
                                                               {1e-12, 1e-9, 1e-15},
                                                               {7},
                                                               {1e9, 1e9 + 1}}) {
            std::vector<std::array<double, 2>> points;
            for (const double y : ys) points.push_back({0.1 * static_cast<double>(points.size()), y});
            const std::string html = draw_plot(plot_of(points, kind));
            EXPECT_THAT(html, Not(HasSubstr("nan")));
            EXPECT_THAT(html, Not(HasSubstr("inf")));
            for (const auto& [x, y] : drawn_points(html)) {
                EXPECT_TRUE(x >= 0 && x <= 640) << x;
                EXPECT_TRUE(y >= 0 && y <= 250) << y;
            }
        }
}

TEST(SvgPlot, HasTicksOnEveryRangeHoweverSmall)
{
    constexpr double kTiny = std::numeric_limits<double>::denorm_min();
    for (const double last : {kTiny, 1e-300, 1e-291, 1e-20, 1.0})
        for (const double first : {0.0, -last, 0.3 * last, 0.9 * last}) {
            const std::string html = draw_plot(plot_of({{first, first}, {last, last}}));
            const std::regex tick("<text class=\"tick\"");
            const auto ticks = std::distance(std::sregex_iterator(html.begin(), html.end(), tick), {});
            EXPECT_GE(ticks, 5) << first << " " << last;  // two of each axis, and the label
            EXPECT_THAT(html, Not(HasSubstr("nan")));
            EXPECT_THAT(html, Not(HasSubstr("inf")));
        }
}

TEST(SvgPlot, DrawsGreaterValuesHigherUp)
{
    for (const PlotKind kind : {PlotKind::Lines, PlotKind::LogLines, PlotKind::Stacked}) {
        const auto points = drawn_points(draw_plot(plot_of({{0, 1}, {1, 10}, {2, 100}}, kind)));
        ASSERT_GE(points.size(), 3U);
        EXPECT_GT(points[0][1], points[1][1]);
        EXPECT_GT(points[1][1], points[2][1]);
        EXPECT_LT(points[0][0], points[1][0]);
    }
}

TEST(SvgPlot, SpacesDecadesEvenlyOnALogarithmicAxis)
{
    const auto points =
        drawn_points(draw_plot(plot_of({{0, 1e-12}, {1, 1e-10}, {2, 0.0}, {3, 1e-8}}, PlotKind::LogLines)));
    ASSERT_EQ(points.size(), 3U);                                                 // 0 has no logarithm
    EXPECT_NEAR(points[0][1] - points[1][1], points[1][1] - points[2][1], 0.11);  // one decimal is written
}

TEST(SvgPlot, StacksAreasOnTopOfOneAnother)
{
    const Plot plot = {"t", "s", PlotKind::Stacked, {{"a", {{0, 1}, {1, 1}}}, {"b", {{0, 3}, {1, 3}}}}};
    const auto points = drawn_points(draw_plot(plot));
    ASSERT_GE(points.size(), 5U);
    const double base = 210.0, first_drawn = points[0][1], second_drawn = points[3][1];
    EXPECT_NEAR(base - first_drawn, 4.0 * (base - second_drawn), 0.5);
}

TEST(SvgPlot, SaysThatThereIsNothing)
{
    EXPECT_THAT(draw_plot({"Empty", "", PlotKind::Lines, {}}), HasSubstr("nothing to show"));
    EXPECT_THAT(draw_plot(plot_of({})), HasSubstr("nothing to show"));
    EXPECT_THAT(draw_plot(plot_of({{0, 0}, {1, -1}}, PlotKind::LogLines)), HasSubstr("nothing to show"));
}

TEST(SvgPlot, TakesNamesForText)
{
    const std::string evil = "</script><img src=x onerror=alert(1)>\"'&";
    const std::string html = draw_plot({evil, evil, PlotKind::Lines, {{evil, {{0, 0}, {1, 1}}}}, evil});
    EXPECT_THAT(html, Not(HasSubstr("<img")));
    EXPECT_THAT(html, Not(HasSubstr("</script")));
    EXPECT_THAT(
        html, HasSubstr("aria-label=\"&lt;/script&gt;&lt;img src=x onerror=alert(1)&gt;&quot;&#39;&amp;\""));
}

}  // namespace
}  // namespace arris
