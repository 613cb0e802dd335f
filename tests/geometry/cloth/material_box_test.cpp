// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth/material_box.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "geometry/cloth/material_locator.h"
#include "geometry/cloth_input/cloth_grid.h"

namespace arris {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kSumTolerance = 1e-14;

ClothMesh make_cloth(const Vec2& size, std::array<int, 2> resolution, GridPattern pattern, double angle = 0.0)
{
    ClothGrid grid;
    grid.size = size;
    grid.resolution = resolution;
    grid.pattern = pattern;
    grid.pattern_angle = angle;
    return make_cloth_grid(grid);
}

std::vector<ClothMesh> cloths()
{
    return {make_cloth({1, 1}, {1, 1}, GridPattern::Diagonal),
            make_cloth({1, 1}, {10, 10}, GridPattern::Alternating),
            make_cloth({1, 1}, {7, 5}, GridPattern::Cross),
            make_cloth({1, 1}, {9, 9}, GridPattern::Diagonal, 33.0),
            make_cloth({1, 1}, {12, 12}, GridPattern::Unstructured)};
}

double sum_of(const std::vector<LoadShare>& shares)
{
    return std::accumulate(shares.begin(), shares.end(), 0.0,
                           [](double sum, const LoadShare& share) { return sum + share.weight; });
}

Vec2 moment_of(const ClothMesh& mesh, const std::vector<LoadShare>& shares)
{
    Vec2 moment = Vec2::Zero();
    for (const LoadShare& share : shares) moment += share.weight * mesh.material[share.vertex];
    return moment;
}

void expect_spread(const ClothMesh& mesh, const MaterialBox& box, const Vec2& centroid)
{
    const std::vector<LoadShare> shares = spread_over_box(mesh, box);
    EXPECT_NEAR(sum_of(shares), 1.0, kSumTolerance);
    EXPECT_LT((moment_of(mesh, shares) - centroid).norm(), 1e-14);
    for (std::size_t k = 0; k < shares.size(); ++k) {
        EXPECT_GT(shares[k].weight, 0.0);
        if (k == 0) continue;
        EXPECT_LT(shares[k - 1].vertex, shares[k].vertex);
    }
}

TEST(SpreadOverBox, HasSumOneAndTheMomentOfTheClippedRegion)
{
    for (const ClothMesh& mesh : cloths()) {
        expect_spread(mesh, {{0, 0}, {1, 1}}, {0.5, 0.5});
        expect_spread(mesh, {{0.2, 0.3}, {0.7, 0.4}}, {0.45, 0.35});
        expect_spread(mesh, {{0.31, 0.0123}, {0.3101, 0.98}}, {0.31005, 0.49615});
        expect_spread(mesh, {{-3, -3}, {7, 7}}, {0.5, 0.5});       // cloth inside the box
        expect_spread(mesh, {{0.5, -1}, {2, 0.5}}, {0.75, 0.25});  // box partly beside the cloth
    }
}

TEST(SpreadOverFaces, IsTheSameLoadByFaces)
{
    const MaterialBox boxes[] = {
        {{0, 0}, {1, 1}},         {{0.2, 0.3}, {0.7, 0.4}}, {{-3, -3}, {7, 7}},
        {{0.3, 0.2}, {0.3, 0.9}}, {{0.5, 0.5}, {0.5, 0.5}}, {{0.21, 0.4}, {0.21, 0.4}},
        {{-1, 0.2}, {0, 0.7}},    {{1, 1}, {2, 2}}};  // the last two boxes touch the cloth from outside
    for (const ClothMesh& mesh : cloths())
        for (const MaterialBox& box : boxes) {
            std::vector<double> by_vertex(mesh.material.size(), 0.0);
            for (const FaceShare& share : spread_over_faces(mesh, box)) {
                EXPECT_GE(share.weights.minCoeff(), 0.0);
                EXPECT_GT(share.weights.maxCoeff(), 0.0);
                for (int k = 0; k < 3; ++k) by_vertex[mesh.faces[share.face][k]] += share.weights[k];
            }
            const std::vector<LoadShare> shares = spread_over_box(mesh, box);
            EXPECT_FALSE(shares.empty());
            for (const LoadShare& share : shares) by_vertex[share.vertex] -= share.weight;
            for (const double left : by_vertex) EXPECT_NEAR(left, 0.0, 1e-13);
        }
    EXPECT_TRUE(spread_over_faces(cloths()[0], {{5, 5}, {6, 6}}).empty());
}

TEST(SpreadOverBox, AlongALineCountsNoStretchTwice)
{
    for (const ClothMesh& mesh : cloths()) {
        expect_spread(mesh, {{1, 0}, {1, 1}}, {1, 0.5});  // the border
        expect_spread(mesh, {{0, 0.2}, {0, 0.9}}, {0, 0.55});
        expect_spread(mesh, {{0.5, 0}, {0.5, 1}}, {0.5, 0.5});  // along mesh edges in some cloths
        expect_spread(mesh, {{0.25, 0.3}, {2.0, 0.3}}, {0.625, 0.3});
        expect_spread(mesh, {{-1, 0.77}, {0.4, 0.77}}, {0.2, 0.77});
    }
}

TEST(SpreadOverBox, AlongALineThatFollowsMeshEdgesOnlyInPartIsEven)
{
    // v = 1/2 is an edge between faces for u < 1 and runs through the inside of one face for u > 1.
    ClothMesh mesh;
    mesh.material = {{0, 0}, {1, 0}, {2, 0}, {0, 0.5}, {1, 0.5}, {0, 1}, {1, 1}, {2, 1}};
    mesh.faces = {{0, 1, 4}, {0, 4, 3}, {3, 4, 6}, {3, 6, 5}, {1, 2, 4}, {2, 7, 4}, {7, 6, 4}};
    for (const Vec2& X : mesh.material) mesh.world.emplace_back(X.x(), X.y(), 0.0);
    expect_spread(mesh, {{0, 0.5}, {2, 0.5}}, {1, 0.5});
    expect_spread(mesh, {{0.5, 0.5}, {2, 0.5}}, {1.25, 0.5});
}

TEST(SpreadOverBox, AlongALineIsExactForLinearElements)
{
    // Half a cell at either end, whole cells between: trapezoids of the hat functions.
    const ClothMesh mesh = make_cloth({1, 1}, {4, 1}, GridPattern::Diagonal);
    const std::vector<LoadShare> shares = spread_over_box(mesh, {{0.125, 0}, {0.625, 0}});
    ASSERT_EQ(shares.size(), 4u);
    EXPECT_NEAR(shares[0].weight, 0.0625, kSumTolerance);  // vertex 0: falls from 1/2 to 0 over 1/8, over 1/2
    EXPECT_NEAR(shares[1].weight, 0.4375, kSumTolerance);
    EXPECT_NEAR(shares[2].weight, 0.4375, kSumTolerance);
    EXPECT_NEAR(shares[3].weight, 0.0625, kSumTolerance);
}

TEST(SpreadOverBox, AlongALineIsNotUpsetByRoundingWhereFacesMeet)
{
    const ClothMesh mesh = make_cloth({0.3, 0.7}, {13, 17}, GridPattern::Alternating);
    for (int j = 0; j <= 17; ++j) {
        const double v = 0.7 * (j / 17.0);
        expect_spread(mesh, {{0, v}, {0.3, v}}, {0.15, v});
        expect_spread(mesh, {{0, std::nextafter(v, 1.0)}, {0.3, std::nextafter(v, 1.0)}}, {0.15, v});
    }
}

TEST(SpreadOverBox, AtAPointTakesTheNearestVertex)
{
    const ClothMesh mesh = make_cloth({1, 1}, {2, 2}, GridPattern::Diagonal);
    const auto at = [&](double u, double v) { return spread_over_box(mesh, {{u, v}, {u, v}}); };
    ASSERT_EQ(at(0.3, 0.1).size(), 1u);
    EXPECT_EQ(at(0.3, 0.1)[0].vertex, 1);
    EXPECT_EQ(at(0.25, 0.0)[0].vertex, 0);  // equally near vertices
    EXPECT_EQ(at(1.0, 1.0)[0].vertex, 8);
    EXPECT_EQ(at(1.0 + 1e-10, 1.0)[0].vertex, 8);  // within the tolerance
    EXPECT_THAT(at(1.01, 1.0), IsEmpty());
}

TEST(SpreadOverBox, ThatOnlyTouchesTheClothIsALineOrAPoint)
{
    const ClothMesh mesh = make_cloth({1, 1}, {4, 4}, GridPattern::Cross);
    expect_spread(mesh, {{1, 0}, {2, 0.5}}, {1, 0.25});
    expect_spread(mesh, {{1 + 1e-10, 0}, {2, 0.5}}, {1, 0.25});
    expect_spread(mesh, {{1, 1}, {2, 2}}, {1, 1});
}

TEST(SpreadOverBox, TouchingASlantOrAHoleFromOutside)
{
    // An L-shaped cloth: the box fills its notch and touches the cloth along two of the box's sides only.
    ClothMesh mesh;
    mesh.material = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}, {0, 1}};
    mesh.faces = {{0, 1, 4}, {0, 4, 7}, {1, 2, 3}, {1, 3, 4}, {7, 4, 5}, {7, 5, 6}};
    for (const Vec2& X : mesh.material) mesh.world.emplace_back(X.x(), X.y(), 0.0);
    expect_spread(mesh, {{1, 1}, {2, 2}}, {1.25, 1.25});
    EXPECT_THAT(spread_over_box(mesh, {{1.1, 1.1}, {2, 2}}), IsEmpty());
}

TEST(SpreadOverBox, MissingTheClothIsEmpty)
{
    for (const ClothMesh& mesh : cloths()) {
        EXPECT_THAT(spread_over_box(mesh, {{1.1, 0}, {2, 1}}), IsEmpty());
        EXPECT_THAT(spread_over_box(mesh, {{-1, -1}, {-0.5, 3}}), IsEmpty());
        EXPECT_THAT(spread_over_box(mesh, {{0.5, 1.5}, {0.5, 2}}), IsEmpty());
    }
}

TEST(SpreadOverBox, HoldsAtExtremeScales)
{
    for (const double scale : {1e-3, 1e3}) {
        const ClothMesh mesh = make_cloth({scale, scale}, {8, 8}, GridPattern::Cross);
        const auto shares = spread_over_box(mesh, {Vec2(0.1, 0.2) * scale, Vec2(0.35, 0.4) * scale});
        EXPECT_NEAR(sum_of(shares), 1.0, kSumTolerance);
        EXPECT_LT((moment_of(mesh, shares) / scale - Vec2(0.225, 0.3)).norm(), 1e-14);
    }
}

TEST(SpreadOverBox, OfAMillionSharesStillSumsToOne)
{
    const ClothMesh mesh = make_cloth({1, 1}, {300, 300}, GridPattern::Cross);
    long double sum = 0.0L;
    for (const LoadShare& share : spread_over_box(mesh, {{0, 0}, {1, 1}})) sum += share.weight;
    EXPECT_NEAR(static_cast<double>(sum), 1.0, kSumTolerance);
}

TEST(Locate, ReproducesThePointFromItsWeights)
{
    for (const ClothMesh& mesh : cloths()) {
        for (int k = 0; k < 300; ++k) {
            const Vec2 point(std::fmod(0.618034 * k, 1.0), std::fmod(0.414214 * k, 1.0));
            const MaterialLocation at = locate(mesh, point);
            ASSERT_GE(at.face, 0);
            Vec2 back = Vec2::Zero();
            for (int i = 0; i < 3; ++i) back += at.weights[i] * mesh.material[mesh.faces[at.face][i]];
            EXPECT_LT((back - point).norm(), 1e-15 * 4);
            EXPECT_GE(at.weights.minCoeff(), 0.0);
            EXPECT_NEAR(at.weights.sum(), 1.0, kSumTolerance);
        }
    }
}

TEST(Locate, TakesTheLowestFaceAtAVertex)
{
    for (const ClothMesh& mesh : cloths()) {
        for (int v = 0; v < mesh.vertex_count(); ++v) {
            int lowest = 0;
            while (std::find(mesh.faces[lowest].begin(), mesh.faces[lowest].end(), v) ==
                   mesh.faces[lowest].end())
                ++lowest;
            EXPECT_EQ(locate(mesh, mesh.material[v]).face, lowest);
        }
    }
}

TEST(Locate, AcceptsPointsOffTheClothWithinItsTolerance)
{
    const ClothMesh mesh = make_cloth({1, 1}, {3, 3}, GridPattern::Cross);
    const MaterialLocation at = locate(mesh, {1.0 + 5e-10, 0.5});
    ASSERT_GE(at.face, 0);
    Vec2 back = Vec2::Zero();
    for (int i = 0; i < 3; ++i) back += at.weights[i] * mesh.material[mesh.faces[at.face][i]];
    EXPECT_LT((back - Vec2(1.0, 0.5)).norm(), 1e-15 * 4);
    EXPECT_EQ(locate(mesh, {1.0 + 2e-9, 0.5}).face, -1);
    EXPECT_EQ(locate(mesh, {0.5, -1.0}).face, -1);
    EXPECT_EQ(locate(mesh, {std::nan(""), 0.5}).face, -1);
}

}  // namespace
}  // namespace arris
