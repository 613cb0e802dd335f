// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth/material_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace arris {
namespace {

MaterialGrid make_grid()
{
    return make_material_grid({Vec2(-1.0, 2.0), Vec2(0.5, 2.7)}, 0.1, 1 << 20);
}

TEST(MaterialGrid, CoversThePointsWithTheSpacing)
{
    const MaterialGrid grid = make_grid();
    EXPECT_EQ(grid.low, Vec2(-1.0, 2.0));
    EXPECT_EQ(grid.spacing, 0.1);
    EXPECT_EQ(grid.count, (std::array<int, 2>{16, 8}));
}

TEST(MaterialGrid, HasAtMostAboutTheGivenNumberOfNodes)
{
    for (const Vec2& size : {Vec2(1.0, 1.0), Vec2(1e3, 1e-3), Vec2(1e-6, 2e-6)})
        for (const int most : {10, 1000, 100000}) {
            const MaterialGrid grid = make_material_grid({Vec2::Zero(), size}, 1e-9, most);
            EXPECT_LE(grid.size(), 2.0 * most + 10) << size.transpose();
            EXPECT_GE(grid.spacing * (grid.count[0] - 1), size.x() * (1.0 - 1e-8));
        }
}

TEST(MaterialGrid, InterpolatesLinearFunctionsExactlyAndExtendsItsBorder)
{
    const MaterialGrid grid = make_grid();
    std::vector<float> values(static_cast<std::size_t>(grid.size()));
    const auto f = [](const Vec2& X) { return 3.0 + 2.0 * X.x() - X.y(); };
    for (int i = 0; i < grid.count[0]; ++i)
        for (int j = 0; j < grid.count[1]; ++j)
            values[grid.index(i, j)] = static_cast<float>(f(grid.node(i, j)));
    EXPECT_NEAR(interpolate(grid, values, Vec2(-0.333, 2.123)), f(Vec2(-0.333, 2.123)), 1e-6);
    EXPECT_NEAR(interpolate(grid, values, Vec2(-9.0, 2.0)), f(Vec2(-1.0, 2.0)), 1e-6);
}

TEST(MaterialGrid, LimitsTheSlopeInAllDirectionsAndLowersNoMoreThanThat)
{
    const MaterialGrid grid = make_grid();
    std::vector<float> values(static_cast<std::size_t>(grid.size()), 10.0f);
    const Vec2 low = grid.node(5, 3), other = grid.node(12, 7);
    values[grid.index(5, 3)] = 0.1f;
    values[grid.index(12, 7)] = 0.3f;
    limit_slope(grid, 0.5, values);
    for (int i = 0; i < grid.count[0]; ++i)
        for (int j = 0; j < grid.count[1]; ++j) {
            const Vec2 X = grid.node(i, j);
            const double cone =
                std::min({10.0, 0.1 + 0.5 * (X - low).norm(), 0.3 + 0.5 * (X - other).norm()});
            EXPECT_GE(values[grid.index(i, j)], cone - 1e-6) << X.transpose();
            EXPECT_LE(values[grid.index(i, j)], 1.09 * cone + 1e-6) << "eight directions only";
        }
}

TEST(MaterialGrid, SumsOverRectangles)
{
    const MaterialGrid grid = make_grid();
    std::mt19937 random(1);
    using Value = GridSums<2>::Value;
    std::vector<Value> values(static_cast<std::size_t>(grid.size()));
    for (Value& v : values) v = Value(random() % 100, random() % 100);
    const GridSums<2> sums(grid, values);
    const auto expect = [&](std::array<int, 2> first, std::array<int, 2> last) {
        Value sum = Value::Zero();
        for (int i = std::max(first[0], 0); i <= std::min(last[0], grid.count[0] - 1); ++i)
            for (int j = std::max(first[1], 0); j <= std::min(last[1], grid.count[1] - 1); ++j)
                sum += values[grid.index(i, j)];
        EXPECT_EQ(sums.over(first, last), sum);
    };
    expect({2, 3}, {5, 6});
    expect({0, 0}, {0, 0});
    expect({-3, -2}, {100, 100});
    expect({15, 7}, {20, 9});
}

}  // namespace
}  // namespace arris
