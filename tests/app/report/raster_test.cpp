// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/report/raster.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <Eigen/Geometry>
#include <random>

namespace arris {
namespace {

constexpr Colour kRed = {255, 0, 0}, kBlue = {0, 0, 255};

std::uint32_t number_at(const std::string& bytes, std::size_t at)
{
    std::uint32_t number = 0;
    for (std::size_t k = 0; k < 4; ++k) number = number << 8 | static_cast<unsigned char>(bytes[at + k]);
    return number;
}

/// Pixels of a PNG file as to_png writes it: red, green, blue, alpha, rows from the top.
std::string pixels_of(const std::string& png, int width, int height)
{
    EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
    std::string rows(static_cast<std::size_t>(4 * width + 1) * height, '\0'), pixels;
    for (std::size_t at = 8; at < png.size();) {
        const std::size_t size = number_at(png, at);
        const auto* body = reinterpret_cast<const Bytef*>(png.data() + at + 4);
        EXPECT_EQ(number_at(png, at + 8 + size), crc32(0, body, static_cast<uInt>(size + 4)));
        uLongf length = rows.size();
        if (png.substr(at + 4, 4) == "IDAT") {
            EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(rows.data()), &length, body + 4, size), Z_OK);
            EXPECT_EQ(length, rows.size());
        }
        at += size + 12;
    }
    EXPECT_EQ(number_at(png, 16), static_cast<std::uint32_t>(width));
    EXPECT_EQ(number_at(png, 20), static_cast<std::uint32_t>(height));
    for (int y = 0; y < height; ++y)
        pixels += rows.substr(static_cast<std::size_t>(4 * width + 1) * y + 1, 4UL * width);
    return pixels;
}

TEST(Raster, ShowsTheNearerOfTwoTrianglesInAnyOrder)
{
    const auto draw = [](Raster& raster, double z, const Colour& colour) {
        raster.draw_triangle({-10, -10, z}, {200, -10, z}, {-10, 200, z}, colour);
    };
    Raster first(40, 20), second(40, 20);
    draw(first, 1.0, kRed);
    draw(first, 2.0, kBlue);
    draw(second, 2.0, kBlue);
    draw(second, 1.0, kRed);
    EXPECT_EQ(first.count(kBlue), 800U);
    EXPECT_EQ(first.to_png(), second.to_png());
}

TEST(Raster, CutsTrianglesWhereTheyCross)
{
    Raster raster(100, 10);
    raster.draw_triangle({-100, -500, 50}, {300, 5, 50}, {-100, 500, 50}, kRed);
    raster.draw_triangle({-100, -500, -100}, {300, 5, 300}, {-100, 500, -100}, kBlue);  // z = x
    EXPECT_EQ(raster.count(kBlue), 490U);                                               // x = 51..99
    EXPECT_EQ(raster.count(kRed), 510U);
}

TEST(Raster, CoversAsManyPixelsAsATriangleHasArea)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(5.0, 395.0);
    for (int n = 0; n < 50; ++n) {
        Vec3 corner[3];
        for (Vec3& p : corner) p = {place(random), place(random), 0.0};
        const double area = 0.5 * (corner[1] - corner[0]).cross(corner[2] - corner[0]).norm();
        double border = 0.0;
        for (int k = 0; k < 3; ++k) border += (corner[(k + 1) % 3] - corner[k]).norm();
        Raster raster(400, 400);
        raster.draw_triangle(corner[0], corner[1], corner[2], kRed);
        EXPECT_NEAR(static_cast<double>(raster.count(kRed)), area, 0.5 * border + 1.0);
    }
}

TEST(Raster, TrianglesThatShareAnEdgeLeaveNoGap)
{
    Raster raster(200, 200);
    const Vec3 middle(77.3, 101.7, 0.0);
    const Vec3 corners[] = {{-1, -1, 0}, {201, -1, 0}, {201, 201, 0}, {-1, 201, 0}};
    for (int k = 0; k < 4; ++k) raster.draw_triangle(corners[k], corners[(k + 1) % 4], middle, kRed);
    EXPECT_EQ(raster.count(kRed), 40000U);
}

TEST(Raster, DrawsThePartInTheImageOfThingsOfAnySize)
{
    for (const double size : {1e3, 1e8, 1e15}) {
        Raster raster(60, 60);
        raster.draw_triangle({-size, -size, 0}, {size, -size, 0}, {30, size, 0}, kRed);
        EXPECT_EQ(raster.count(kRed), 3600U) << size;
        raster.draw_line({-size, 30, 1}, {size, 30, 1}, 2.5, 0.0, kBlue);
        EXPECT_NEAR(static_cast<double>(raster.count(kBlue)), 5.0 * 60.0, 10.0) << size;
    }
}

TEST(Raster, DrawsNothingOutsideTheImageAndNoFlatTriangle)
{
    Raster raster(60, 60);
    raster.draw_triangle({100, 100, 0}, {200, 100, 0}, {100, 200, 0}, kRed);
    raster.draw_triangle({1, 1, 0}, {20, 20, 0}, {40, 40, 0}, kRed);
    raster.draw_line({-100, -100, 0}, {-100, 200, 0}, 3.0, 0.0, kRed);
    EXPECT_EQ(raster.count(kRed), 0U);
}

TEST(Raster, WritesAPngWithTransparentBackgroundAndSmoothEdges)
{
    Raster raster(8, 4);
    raster.draw_triangle({-1, -1, 0}, {4.5, -1, 0}, {4.5, 90, 0}, kRed);
    raster.draw_triangle({-1, -1, 0}, {4.5, 90, 0}, {-1, 90, 0}, kRed);  // x = 0..4 in all
    const std::string pixels = pixels_of(raster.to_png(), 4, 2);
    for (std::size_t y = 0; y < 2; ++y) {
        const std::string row = pixels.substr(16 * y, 16);
        EXPECT_EQ(row.substr(0, 4), std::string("\xff\0\0\xff", 4));
        EXPECT_EQ(row.substr(8, 4), std::string("\xff\0\0\x7f", 4)) << "half covered";
        EXPECT_EQ(row.substr(12, 4), std::string(4, '\0'));
    }
}

}  // namespace
}  // namespace arris
