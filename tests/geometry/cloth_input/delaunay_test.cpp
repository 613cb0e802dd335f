// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/delaunay.h"

#include <gtest/gtest.h>

namespace arris {
namespace {

// A unit square crossed by two lines `gap` apart.
PlanarGraph square_with_lines(double gap)
{
    const double u = 0.5, w = 0.5 + gap;
    return {{{0, 0}, {u, 0}, {w, 0}, {1, 0}, {1, 1}, {w, 1}, {u, 1}, {0, 1}},
            {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}, {5, 6}, {6, 7}, {7, 0}, {1, 6}, {2, 5}},
            {}};
}

TEST(Refine, StopsAboveTheMostPointsAndSaysWhereTheyAreDensest)
{
    const RefinedTriangulation refined = refine(square_with_lines(1e-7), 0.1, {2000, 0.0});
    EXPECT_FALSE(refined.is_complete);
    EXPECT_TRUE(refined.faces.empty());
    EXPECT_NEAR(refined.crowded.x(), 0.5, 1e-6);
    EXPECT_GT(refined.shortest, 1e-8);
    EXPECT_LE(refined.shortest, 1e-7 * (1 + 1e-6));
}

TEST(Refine, IsCompleteWhereThePointsSuffice)
{
    const RefinedTriangulation refined = refine(square_with_lines(0.01), 0.1, {2000, 0.0});
    EXPECT_TRUE(refined.is_complete);
    EXPECT_LE(refined.points.size(), 2000u);
    // A limit equal to the number of vertices needed is enough.
    const RefinedTriangulation exact = refine(square_with_lines(0.01), 0.1, {refined.points.size(), 0.0});
    EXPECT_TRUE(exact.is_complete);
    EXPECT_EQ(exact.points, refined.points);
    EXPECT_EQ(exact.faces, refined.faces);
    EXPECT_FALSE(refine(square_with_lines(0.01), 0.1, {refined.points.size() - 1, 0.0}).is_complete);
}

}  // namespace
}  // namespace arris
