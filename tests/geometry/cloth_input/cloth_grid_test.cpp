// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/cloth_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "geometry/cloth/mesh_topology.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

constexpr double kAreaTolerance = 1e-12;  // relative

// Least angle measured over sizes 1x1 to 100x3 cells and angles 0, 7, ..., 90 and 0.5, 1, ..., 90: 29.8
// degrees.
constexpr double kTurnedFloor = 29.0;
// Least angle measured over 1600 random lines at least 1.5 cells from corners: 28.0 for one line, 27.4 for
// two crossing lines.
constexpr double kFoldedFloor = 25.0;
// For cells of aspect 2 and 1/3, angles are measured in a scale in which cells are squares. The rectangle's
// own corners have 37 degrees there.
constexpr double kLongCellFloor = 20.0;
// Least angle guaranteed by CGAL.
constexpr double kRefinedFloor = 20.7;

constexpr std::array kRegular = {GridPattern::Diagonal, GridPattern::Alternating, GridPattern::Cross};
constexpr std::array kAll = {GridPattern::Diagonal, GridPattern::Alternating, GridPattern::Cross,
                             GridPattern::Unstructured};

ClothGrid make_grid(const Vec2& size, std::array<int, 2> resolution, GridPattern pattern, double angle = 0.0)
{
    ClothGrid grid;
    grid.size = size;
    grid.resolution = resolution;
    grid.pattern = pattern;
    grid.pattern_angle = angle;
    return grid;
}

double area_of(const ClothMesh& mesh)
{
    double area = 0.0;
    for (const auto& [a, b, c] : mesh.faces)
        area += 0.5 * twice_area(mesh.material[a], mesh.material[b], mesh.material[c]);
    return area;
}

// Least angle in degrees, after a linear map of material space.
double least_angle(const ClothMesh& mesh, const Mat2& map = Mat2::Identity())
{
    double least = 180.0;
    for (const Face& face : mesh.faces) {
        for (int k = 0; k < 3; ++k) {
            const Vec2 p = map * (mesh.material[face[(k + 1) % 3]] - mesh.material[face[k]]);
            const Vec2 q = map * (mesh.material[face[(k + 2) % 3]] - mesh.material[face[k]]);
            const double angle = std::atan2(p.x() * q.y() - p.y() * q.x(), p.dot(q));
            least = std::min(least, angle * 180.0 / std::numbers::pi);
        }
    }
    return least;
}

double mean_edge(const ClothMesh& mesh)
{
    double sum = 0.0;
    const MeshTopology topology = make_topology(mesh.vertex_count(), mesh.faces);
    for (const MeshEdge& edge : topology.edges) sum += (mesh.material[edge.a] - mesh.material[edge.b]).norm();
    return sum / static_cast<double>(topology.edges.size());
}

// Border vertices are exactly on the rectangle, and the border is one closed loop around it.
void expect_border(const ClothMesh& mesh, const Vec2& size)
{
    const MeshTopology topology = make_topology(mesh.vertex_count(), mesh.faces);
    double length = 0.0;
    int corners = 0;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Vec2& X = mesh.material[v];
        const bool is_on_u = X.x() == 0.0 || X.x() == size.x();
        const bool is_on_v = X.y() == 0.0 || X.y() == size.y();
        EXPECT_EQ(topology.is_border[v] != 0, is_on_u || is_on_v) << v << ": " << X.transpose();
        corners += is_on_u && is_on_v ? 1 : 0;
        EXPECT_EQ(mesh.world[v], Vec3(X.x(), X.y(), 0.0));
    }
    for (const MeshEdge& edge : topology.edges)
        if (edge.face_right < 0) length += (mesh.material[edge.a] - mesh.material[edge.b]).norm();
    EXPECT_EQ(corners, 4);
    EXPECT_NEAR(length, 2.0 * size.sum(), 1e-12 * size.sum());
}

void expect_sound(const ClothMesh& mesh, const Vec2& size)
{
    EXPECT_EQ(validate(mesh), "");
    EXPECT_NEAR(area_of(mesh), size.prod(), kAreaTolerance * size.prod());
    expect_border(mesh, size);
}

// Edges of the mesh with both ends within `tolerance` of the line cover its part inside the cloth.
void expect_covered(const ClothMesh& mesh, const FoldLine& fold, double length)
{
    const Vec2 along = (fold.line[1] - fold.line[0]).normalized();
    const auto off = [&](int v) {
        const Vec2 from = mesh.material[v] - fold.line[0];
        return std::abs(along.x() * from.y() - along.y() * from.x());
    };
    const double tolerance = 1e-14 * std::max(1.0, length);
    double covered = 0.0;
    for (const MeshEdge& edge : make_topology(mesh.vertex_count(), mesh.faces).edges)
        if (off(edge.a) <= tolerance && off(edge.b) <= tolerance)
            covered += (mesh.material[edge.a] - mesh.material[edge.b]).norm();
    EXPECT_NEAR(covered, length, 1e-12 * length);
}

bool are_equal(const ClothMesh& a, const ClothMesh& b)
{
    return a.faces == b.faces && a.material == b.material && a.world == b.world;
}

// --- regular patterns

TEST(ClothGrid, RegularPatternsAreWhatTheirNamesSay)
{
    const ClothMesh diagonal = make_cloth_grid(make_grid({2, 1}, {2, 1}, GridPattern::Diagonal));
    EXPECT_EQ(diagonal.faces, (std::vector<Face>{{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}}));
    const ClothMesh alternating = make_cloth_grid(make_grid({2, 1}, {2, 1}, GridPattern::Alternating));
    EXPECT_EQ(alternating.faces, (std::vector<Face>{{0, 1, 4}, {0, 4, 3}, {1, 2, 4}, {2, 5, 4}}));
    const ClothMesh cross = make_cloth_grid(make_grid({2, 1}, {2, 1}, GridPattern::Cross));
    EXPECT_EQ(cross.vertex_count(), 8);
    EXPECT_EQ(cross.face_count(), 8);
    EXPECT_EQ(cross.material[6], Vec2(0.5, 0.5));
}

TEST(ClothGrid, RegularPatternsFillTheirRectangle)
{
    for (const GridPattern pattern : kRegular)
        for (const Vec2& size : {Vec2(1, 1), Vec2(1e-3, 7e-3), Vec2(1e3, 0.3), Vec2(1.0, 0.02)})
            for (const std::array<int, 2> resolution : {std::array{1, 1}, {1, 7}, {64, 1}, {13, 9}}) {
                const ClothMesh mesh = make_cloth_grid(make_grid(size, resolution, pattern));
                expect_sound(mesh, size);
                const int cells = resolution[0] * resolution[1];
                EXPECT_EQ(mesh.face_count(), cells * (pattern == GridPattern::Cross ? 4 : 2));
            }
}

TEST(ClothGrid, OfAMillionCellsIsMade)
{
    for (const GridPattern pattern : kRegular) {
        const ClothMesh mesh = make_cloth_grid(make_grid({1, 1}, {1000, 1000}, pattern));
        EXPECT_EQ(mesh.vertex_count(), pattern == GridPattern::Cross ? 2002001 : 1002001);
    }
}

// --- turned patterns

TEST(TurnedPattern, KeepsTheRectangleAndHasNoSlivers)
{
    for (const GridPattern pattern : kRegular)
        for (const std::array<int, 2> resolution :
             {std::array{1, 1}, {2, 3}, {10, 10}, {31, 30}, {64, 1}, {40, 3}})
            for (double angle = 0.0; angle <= 91.0; angle += 7.0) {
                const Vec2 size(0.1 * resolution[0], 0.1 * resolution[1]);
                const ClothMesh mesh = make_cloth_grid(make_grid(size, resolution, pattern, angle));
                SCOPED_TRACE(::testing::Message() << "pattern " << int(pattern) << " " << resolution[0]
                                                  << " x " << resolution[1] << " by " << angle);
                expect_sound(mesh, size);
                EXPECT_GE(least_angle(mesh), kTurnedFloor);
            }
}

TEST(TurnedPattern, HasNoSliversAtAnyAngle)
{
    for (const GridPattern pattern : kRegular)
        for (double angle = -90.0; angle <= 90.0; angle += 0.5)
            EXPECT_GE(least_angle(make_cloth_grid(make_grid({1, 1}, {12, 12}, pattern, angle))), kTurnedFloor)
                << angle;
}

TEST(TurnedPattern, IsMostlyThePatternItself)
{
    // Number of faces of a 60 x 60 cloth with the angles of half a square.
    for (const GridPattern pattern : kRegular) {
        const ClothMesh mesh = make_cloth_grid(make_grid({6, 6}, {60, 60}, pattern, 23.0));
        int count = 0;
        for (const auto& [a, b, c] : mesh.faces) {
            std::array<double, 3> side = {(mesh.material[b] - mesh.material[a]).norm(),
                                          (mesh.material[c] - mesh.material[b]).norm(),
                                          (mesh.material[a] - mesh.material[c]).norm()};
            std::sort(side.begin(), side.end());
            count +=
                std::abs(side[0] - side[1]) < 1e-12 && std::abs(side[2] / side[0] - std::sqrt(2.0)) < 1e-12;
        }
        EXPECT_GT(count, 0.88 * mesh.face_count());
    }
}

TEST(TurnedPattern, ByAQuarterIsTheSamePatternOnASquare)
{
    for (const GridPattern pattern : {GridPattern::Cross, GridPattern::Diagonal}) {
        const ClothMesh mesh = make_cloth_grid(make_grid({1, 1}, {8, 8}, pattern, 90.0));
        EXPECT_EQ(mesh.vertex_count(), pattern == GridPattern::Cross ? 145 : 81);
        EXPECT_NEAR(least_angle(mesh), 45.0, 1e-10);
    }
    // After a turn by 360 degrees the mesh is identical.
    EXPECT_TRUE(are_equal(make_cloth_grid(make_grid({1, 2}, {3, 4}, GridPattern::Diagonal, 720.0)),
                          make_cloth_grid(make_grid({1, 2}, {3, 4}, GridPattern::Diagonal))));
}

TEST(TurnedPattern, OfLongCellsIsSound)
{
    for (const GridPattern pattern : kRegular)
        for (const double angle : {3.0, 17.0, 45.0, 90.0})
            for (const std::array<int, 2> resolution : {std::array{64, 1}, {4, 1}, {1, 64}, {20, 3}}) {
                expect_sound(make_cloth_grid(make_grid({1, 0.02}, resolution, pattern, angle)), {1, 0.02});
                expect_sound(make_cloth_grid(make_grid({1e3, 1e3}, resolution, pattern, angle)), {1e3, 1e3});
            }
}

TEST(TurnedPattern, OfModeratelyLongCellsKeepsItsAnglesMeasuredInCells)
{
    double least = 180.0;
    for (const GridPattern pattern : kRegular)
        for (double angle = 0.0; angle <= 90.0; angle += 7.0)
            for (const ClothGrid& grid :
                 {make_grid({2, 1}, {10, 10}, pattern, angle), make_grid({1, 3}, {12, 12}, pattern, angle)}) {
                const Vec2 cell(grid.size.x() / grid.resolution[0], grid.size.y() / grid.resolution[1]);
                const Eigen::Rotation2Dd back(-angle * std::numbers::pi / 180.0);
                const Mat2 to_cells = cell.cwiseInverse().asDiagonal() * back.toRotationMatrix();
                least = std::min(least, least_angle(make_cloth_grid(grid), to_cells));
            }
    EXPECT_GE(least, kLongCellFloor);
}

// --- unstructured

TEST(Unstructured, HasTheCellsEdgeLengthAndCgalsAngle)
{
    for (const std::array<int, 2> resolution : {std::array{10, 10}, {30, 30}, {40, 10}, {64, 64}}) {
        const Vec2 size(0.1 * resolution[0], 0.1 * resolution[1]);
        const ClothMesh mesh = make_cloth_grid(make_grid(size, resolution, GridPattern::Unstructured));
        expect_sound(mesh, size);
        EXPECT_GE(least_angle(mesh), kRefinedFloor);
        EXPECT_NEAR(mean_edge(mesh) / 0.1, 1.0, 0.1) << resolution[0];
    }
}

TEST(Unstructured, HoldsItsAngleOnAnyRectangle)
{
    for (const Vec2& size : {Vec2(1e-3, 1e-3), Vec2(1e3, 700), Vec2(1.0, 0.02), Vec2(0.01, 1.0)})
        for (const std::array<int, 2> resolution : {std::array{1, 1}, {64, 1}, {1, 9}, {20, 20}}) {
            const ClothMesh mesh = make_cloth_grid(make_grid(size, resolution, GridPattern::Unstructured));
            expect_sound(mesh, size);
            EXPECT_GE(least_angle(mesh), kRefinedFloor) << size.transpose() << " " << resolution[0];
        }
}

// --- folds

FoldLine fold_along(const Vec2& p, const Vec2& q)
{
    return {{p, q}, 90.0};
}

TEST(MeshLines, AlongThePatternsOwnEdgesLeaveItAsItIs)
{
    for (const GridPattern pattern : kRegular) {
        ClothGrid grid = make_grid({1, 1}, {10, 10}, pattern);
        const ClothMesh plain = make_cloth_grid(grid);
        grid.folds = {fold_along({0.6, 0.0}, {0.6, 1.0}), fold_along({1.0, 0.3}, {0.0, 0.3})};
        const ClothMesh folded = make_cloth_grid(grid);
        expect_sound(folded, grid.size);
        EXPECT_EQ(folded.vertex_count(), plain.vertex_count());
        EXPECT_EQ(folded.face_count(), plain.face_count());
        EXPECT_NEAR(least_angle(folded), 45.0, 1e-10);
        for (const Vec2& X : plain.material) {
            const auto is_near = [&](const Vec2& Y) { return (X - Y).norm() < 1e-15; };
            EXPECT_TRUE(std::any_of(folded.material.begin(), folded.material.end(), is_near))
                << X.transpose();
        }
        expect_covered(folded, grid.folds[0], 1.0);
        expect_covered(folded, grid.folds[1], 1.0);
    }
}

TEST(MeshLines, BetweenThePatternsEdgesAreCutIn)
{
    for (const GridPattern pattern : kAll) {
        for (double u = 0.501; u < 0.6; u += 0.0077) {
            ClothGrid grid = make_grid({1, 1}, {10, 10}, pattern);
            // A fold is the whole line, not only the given segment.
            grid.folds = {fold_along({u, -3.0}, {u, 0.2})};
            const ClothMesh mesh = make_cloth_grid(grid);
            expect_sound(mesh, grid.size);
            expect_covered(mesh, grid.folds[0], 1.0);
            EXPECT_GE(least_angle(mesh), pattern == GridPattern::Unstructured ? kRefinedFloor : kFoldedFloor)
                << u;
        }
    }
}

TEST(MeshLines, SlantedAndCrossingKeepTheirAngles)
{
    std::mt19937 random(7);
    const auto place = [&] { return std::uniform_real_distribution<>(0.15, 0.85)(random); };
    for (int k = 0; k < 300; ++k) {
        ClothGrid grid = make_grid({1, 1}, {10, 10}, kAll[k % 4], k % 3 == 0 ? 0.0 : 90.0 * place());
        grid.folds = {fold_along({place(), 0.0}, {place(), 1.0})};
        if (k % 2 == 0) grid.folds.push_back(fold_along({0.0, place()}, {1.0, place()}));
        const ClothMesh mesh = make_cloth_grid(grid);
        SCOPED_TRACE(k);
        expect_sound(mesh, grid.size);
        for (const FoldLine& fold : grid.folds)
            expect_covered(mesh, fold, (fold.line[1] - fold.line[0]).norm());
        const bool is_refined = grid.pattern == GridPattern::Unstructured;
        EXPECT_GE(least_angle(mesh), is_refined ? kRefinedFloor : kFoldedFloor);
    }
}

TEST(MeshLines, ThroughCornersAlongDiagonalsAndAlongTheBorderAreSound)
{
    for (const GridPattern pattern : kAll) {
        for (const double angle : {0.0, 30.0}) {
            ClothGrid grid = make_grid({1, 1}, {8, 8}, pattern, angle);
            grid.folds = {fold_along({0, 0}, {1, 1}),     fold_along({1, 0}, {0, 1}),
                          fold_along({0, 0}, {1, 0}),     fold_along({0, 0}, {0.5, 1}),
                          fold_along({0.5, 1}, {0.7, 0}), fold_along({1, 1}, {0, 0})};
            const ClothMesh mesh = make_cloth_grid(grid);
            expect_sound(mesh, grid.size);
            for (const FoldLine& fold : grid.folds)
                expect_covered(mesh, fold, (fold.line[1] - fold.line[0]).norm());
        }
    }
}

TEST(MeshLines, CloseTogetherOrConcurrentAreSound)
{
    for (const GridPattern pattern : kAll) {
        ClothGrid grid = make_grid({1, 1}, {8, 8}, pattern, 10.0);
        grid.folds = {fold_along({0.5, 0}, {0.5, 1}), fold_along({0.501, 0}, {0.501, 1}),
                      fold_along({0.3, 0.2}, {0.7, 0.8}), fold_along({0.3, 0.8}, {0.7, 0.2}),
                      fold_along({0.0, 0.5}, {1.0, 0.5})};
        const ClothMesh mesh = make_cloth_grid(grid);
        expect_sound(mesh, grid.size);
        for (const FoldLine& fold : {grid.folds[0], grid.folds[1], grid.folds[4]})
            expect_covered(mesh, fold, 1.0);
    }
}

TEST(MeshLines, NastyOnesAreSoundAtEveryScale)
{
    std::mt19937 random(3);
    const auto uniform = [&] { return std::uniform_real_distribution<>(0, 1)(random); };
    for (int k = 0; k < 400; ++k) {
        const double scale = std::pow(10.0, -3.0 + 6.0 * uniform());
        ClothGrid grid =
            make_grid({scale, scale * (0.1 + uniform())}, {1 + int(20 * uniform()), 1 + int(20 * uniform())},
                      kAll[k % 4], k % 3 == 0 ? 0.0 : 90.0 * uniform());
        // A quarter of the coordinates are multiples of a quarter of the cloth: corners, coincident lines,
        // crossings.
        const auto coordinate = [&] {
            const double c = uniform();
            return uniform() < 0.25 ? std::round(4.0 * c) / 4.0 : c;
        };
        for (int f = 0; f < 1 + k % 4; ++f) {
            const FoldLine fold = fold_along(grid.size.cwiseProduct(Vec2(coordinate(), coordinate())),
                                             grid.size.cwiseProduct(Vec2(coordinate(), coordinate())));
            if ((fold.line[1] - fold.line[0]).norm() > 1e-3 * scale) grid.folds.push_back(fold);
        }
        const ClothMesh mesh = make_cloth_grid(grid);
        SCOPED_TRACE(k);
        EXPECT_EQ(validate(mesh), "");
        EXPECT_NEAR(area_of(mesh), grid.size.prod(), kAreaTolerance * grid.size.prod());
    }
}

// --- the function as a whole

TEST(ClothGrid, IsAFunctionOfItsArguments)
{
    for (const GridPattern pattern : kAll) {
        ClothGrid grid = make_grid({1, 0.7}, {20, 14}, pattern, 31.0);
        EXPECT_TRUE(are_equal(make_cloth_grid(grid), make_cloth_grid(grid)));
        grid.folds = {fold_along({0.2, 0}, {0.8, 0.7})};
        EXPECT_TRUE(are_equal(make_cloth_grid(grid), make_cloth_grid(grid)));
    }
}

// --- counts

std::string refusal_of(const ClothGrid& grid)
{
    try {
        make_cloth_grid(grid);
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(GridEstimate, IsExactForRegularPatterns)
{
    for (const GridPattern pattern : kRegular) {
        for (const auto& resolution : {std::array{1, 1}, std::array{7, 3}, std::array{2, 20}}) {
            const ClothGrid grid = make_grid({1, 2}, resolution, pattern);
            const ClothMesh mesh = make_cloth_grid(grid);
            EXPECT_EQ(estimate_cloth_grid(grid).vertices, mesh.vertex_count());
            EXPECT_EQ(estimate_cloth_grid(grid).faces, mesh.face_count());
        }
    }
    const int many = std::numeric_limits<int>::max();
    EXPECT_GT(estimate_cloth_grid(make_grid({1, 1}, {many, many}, GridPattern::Cross)).vertices, 9e18);
}

TEST(GridEstimate, IsNearForWhatIsCutOrUnstructured)
{
    const auto expect_near = [&](const ClothGrid& grid, double share = 0.2) {
        const ClothMesh mesh = make_cloth_grid(grid);
        const GridCount count = estimate_cloth_grid(grid);
        SCOPED_TRACE(::testing::Message()
                     << static_cast<int>(grid.pattern) << " " << grid.size.transpose() << ", "
                     << grid.resolution[0] << " x " << grid.resolution[1] << ", " << grid.pattern_angle
                     << " degrees, " << grid.folds.size() << " folds");
        EXPECT_NEAR(count.vertices, mesh.vertex_count(), share * mesh.vertex_count());
        EXPECT_NEAR(count.faces, mesh.face_count(), share * mesh.face_count());
    };
    for (const GridPattern pattern : kAll) {
        for (const double angle : {0.0, 10.0, 30.0, 45.0, 90.0}) {
            for (const auto& resolution : {std::array{12, 12}, std::array{30, 20}, std::array{40, 10}}) {
                ClothGrid grid = make_grid({1.5, 1.0}, resolution, pattern, angle);
                expect_near(grid);
                grid.folds = {fold_along({0.2, 0.1}, {1.3, 0.9}), fold_along({0.1, 0.55}, {1.0, 0.6})};
                expect_near(grid);
            }
        }
    }
    // For such long cells the border has more vertices than the pattern.
    for (const GridPattern pattern : kRegular) expect_near(make_grid({25, 0.01}, {2, 20}, pattern, 30.0));
    // The cloth is narrower than a cell's mean side. Sides are halved repeatedly, so their length is within a
    // factor of sqrt(2).
    for (const auto& resolution : {std::array{2, 20}, std::array{30, 20}, std::array{100, 100}})
        expect_near(make_grid({25, 0.01}, resolution, GridPattern::Unstructured), 0.4);
}

TEST(GridEstimate, RefusesATurnedPatternWhoseBorderIsTooLong)
{
    // Cells of 125 m by 0.1 mm.
    ClothGrid grid = make_grid({250, 0.01}, {2, 100}, GridPattern::Cross, 30.0);
    EXPECT_GT(estimate_cloth_grid(grid).vertices, 2e6);
    grid.resolution = {2, 300};
    EXPECT_THAT(refusal_of(grid), ::testing::HasSubstr("would have about 7.5e+06 vertices; at most 5e+06"));
}

TEST(ClothGrid, RefusesWhatHasNoMesh)
{
    const auto refused = [](const ClothGrid& grid) { EXPECT_THROW(make_cloth_grid(grid), InputError); };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    refused(make_grid({0, 1}, {1, 1}, GridPattern::Cross));
    refused(make_grid({1, -1}, {1, 1}, GridPattern::Cross));
    refused(make_grid({nan, 1}, {1, 1}, GridPattern::Cross));
    refused(make_grid({1, 1}, {0, 1}, GridPattern::Cross));
    refused(make_grid({1, 1}, {1, 1}, GridPattern::Cross, nan));
    refused(make_grid({1, 1}, {100000, 100000}, GridPattern::Cross));
    refused(make_grid({1e6, 1e-3}, {1000, 1}, GridPattern::Cross, 45.0));
    refused(make_grid({1e6, 1e-3}, {1, 1}, GridPattern::Unstructured));
    ClothGrid grid = make_grid({1, 1}, {4, 4}, GridPattern::Diagonal);
    for (const FoldLine& fold : {fold_along({2, 0}, {2, 1}), fold_along({0.5, 0.5}, {0.5, 0.5}),
                                 fold_along({nan, 0}, {1, 1}), fold_along({-1, 1}, {1, -1})}) {
        grid.folds = {fold};
        refused(grid);
    }
}

}  // namespace
}  // namespace arris
