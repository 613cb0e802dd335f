// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/study/shape_distance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/app/error_of.h"

namespace arris {
namespace {

/// A grid of `cells` x `cells` over 1 x 1 m of material, with the place of each material point.
template <class Place>
Frame grid_frame(int cells, const Place& place)
{
    Frame frame;
    for (int k = 0; k <= cells; ++k)
        for (int i = 0; i <= cells; ++i) {
            const Vec2 point(static_cast<double>(i) / cells, static_cast<double>(k) / cells);
            frame.material.push_back(point);
            frame.world.push_back(place(point));
        }
    const auto at = [cells](int i, int k) { return k * (cells + 1) + i; };
    for (int k = 0; k < cells; ++k)
        for (int i = 0; i < cells; ++i) {
            frame.faces.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
            frame.faces.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
        }
    return frame;
}

TEST(ShapeDistance, DifferentMeshesOfOneLinearShapeAreAtTheSamePlace)
{
    const auto tilted = [](const Vec2& p) { return Vec3(2.0 * p.x(), p.y() - p.x(), 3.0 * p.y()); };
    const ShapeDistance distance = measure_shape_distance(grid_frame(3, tilted), grid_frame(7, tilted));
    EXPECT_EQ(distance.points, 64 * 64);
    EXPECT_LT(distance.greatest, 1e-14);
}

TEST(ShapeDistance, MeanAndGreatestAreThoseOfTheMaterialPoints)
{
    const auto flat = [](const Vec2& p) { return Vec3(p.x(), p.y(), 0.0); };
    const auto tilted = [](const Vec2& p) { return Vec3(p.x(), p.y(), p.x()); };
    const ShapeDistance distance = measure_shape_distance(grid_frame(4, tilted), grid_frame(5, flat));
    EXPECT_NEAR(distance.mean, 0.5, 1e-14);
    EXPECT_NEAR(distance.greatest, 1.0 - 0.5 / 64, 1e-14) << "at the outermost column of points";
    EXPECT_NEAR(world_diagonal(grid_frame(2, tilted)), std::sqrt(3.0), 1e-14);
}

TEST(ShapeDistance, ClothWithoutHalfOfTheMaterialIsAnotherCloth)
{
    const auto flat = [](const Vec2& p) { return Vec3(p.x(), p.y(), 0.0); };
    Frame small = grid_frame(4, flat);
    for (Vec2& point : small.material) point *= 0.5;
    EXPECT_THAT(error_of([&] { measure_shape_distance(small, grid_frame(4, flat)); }),
                ::testing::HasSubstr("only 1024 are in both cloths"));
}

}  // namespace
}  // namespace arris
