// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geometry/cloth/mesh_topology.h"
#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

constexpr double kIsometry = 1e-12;  // relative

ClothMesh fold_grid(const std::vector<FoldLine>& folds, GridPattern pattern = GridPattern::Cross,
                    double angle = 0.0, const Vec2& size = Vec2(1, 1))
{
    ClothGrid grid;
    grid.size = size;
    grid.resolution = {10, 10};
    grid.pattern = pattern;
    grid.pattern_angle = angle;
    grid.folds = folds;
    ClothMesh mesh = make_cloth_grid(grid);
    fold_cloth(folds, mesh);
    return mesh;
}

void expect_isometric(const ClothMesh& mesh)
{
    EXPECT_EQ(validate(mesh), "");
    for (const MeshEdge& edge : make_topology(mesh.vertex_count(), mesh.faces).edges) {
        const double material = (mesh.material[edge.a] - mesh.material[edge.b]).norm();
        EXPECT_NEAR((mesh.world[edge.a] - mesh.world[edge.b]).norm(), material, kIsometry * material);
    }
}

// World position of every vertex as a function of its material coordinates.
template <class Position>
void expect_shape(const ClothMesh& mesh, const Position& position)
{
    for (int v = 0; v < mesh.vertex_count(); ++v)
        EXPECT_LT((mesh.world[v] - position(mesh.material[v])).norm(), 1e-14) << mesh.material[v].transpose();
}

TEST(FoldCloth, TurnsTheRightSideDown)
{
    // The line runs along +v, so larger u is on its right.
    const ClothMesh mesh = fold_grid({{{Vec2(0.6, 0.0), Vec2(0.6, 1.0)}, 90.0}});
    expect_isometric(mesh);
    expect_shape(mesh, [](const Vec2& X) {
        return X.x() <= 0.6 ? Vec3(X.x(), X.y(), 0.0) : Vec3(0.6, X.y(), 0.6 - X.x());
    });
}

TEST(FoldCloth, TurnsTheOtherSideWhereTheLineRunsBackwards)
{
    const ClothMesh mesh = fold_grid({{{Vec2(0.6, 1.0), Vec2(0.6, 0.0)}, 90.0}});
    expect_isometric(mesh);
    expect_shape(mesh, [](const Vec2& X) {
        return X.x() >= 0.6 ? Vec3(X.x(), X.y(), 0.0) : Vec3(0.6, X.y(), X.x() - 0.6);
    });
}

TEST(FoldCloth, TurnsUpByNegativeDegrees)
{
    const ClothMesh mesh = fold_grid({{{Vec2(0.6, 0.0), Vec2(0.6, 1.0)}, -90.0}});
    expect_shape(mesh, [](const Vec2& X) {
        return X.x() <= 0.6 ? Vec3(X.x(), X.y(), 0.0) : Vec3(0.6, X.y(), X.x() - 0.6);
    });
}

TEST(FoldCloth, IsIsometricOnEveryPatternAndAngle)
{
    for (const GridPattern pattern :
         {GridPattern::Diagonal, GridPattern::Alternating, GridPattern::Cross, GridPattern::Unstructured})
        for (const double angle : {0.0, 17.0, 45.0})
            for (const double degrees : {1e-6, 30.0, 135.0, 180.0, -77.0})
                for (const double scale : {1e-3, 1.0, 1e3}) {
                    const Vec2 p = scale * Vec2(0.23, 0.0);
                    const Vec2 q = scale * Vec2(0.71, 1.0);
                    expect_isometric(fold_grid({{{p, q}, degrees}}, pattern, angle, {scale, scale}));
                }
}

TEST(FoldCloth, ParallelFoldsMakeAStaircase)
{
    const ClothMesh mesh =
        fold_grid({{{Vec2(0.25, 0), Vec2(0.25, 1)}, 90.0}, {{Vec2(0.65, 0), Vec2(0.65, 1)}, -90.0}});
    expect_isometric(mesh);
    expect_shape(mesh, [](const Vec2& X) {
        if (X.x() <= 0.25) return Vec3(X.x(), X.y(), 0.0);
        if (X.x() <= 0.65) return Vec3(0.25, X.y(), 0.25 - X.x());
        return Vec3(0.25 + X.x() - 0.65, X.y(), -0.4);
    });
}

TEST(FoldCloth, TheOrderOfParallelFoldsDoesNotMatter)
{
    const FoldLine first{{Vec2(0.25, 0), Vec2(0.25, 1)}, 50.0};
    const FoldLine second{{Vec2(0.65, 0), Vec2(0.65, 1)}, 70.0};
    const ClothMesh forth = fold_grid({first, second});
    const ClothMesh back = fold_grid({second, first});
    ASSERT_EQ(forth.vertex_count(), back.vertex_count());
    const auto world_at = [](const ClothMesh& mesh, const Vec2& X) {
        for (int v = 0; v < mesh.vertex_count(); ++v)
            if ((mesh.material[v] - X).norm() < 1e-12) return mesh.world[v];
        ADD_FAILURE() << X.transpose();
        return Vec3(0, 0, 0);
    };
    for (int v = 0; v < forth.vertex_count(); ++v)
        EXPECT_LT((forth.world[v] - world_at(back, forth.material[v])).norm(), 1e-14);
}

TEST(FoldCloth, RepeatedLineAddsItsAngles)
{
    const FoldLine half{{Vec2(0.5, 0), Vec2(0.5, 1)}, 45.0};
    const ClothMesh mesh = fold_grid({half, half});
    expect_shape(mesh, [](const Vec2& X) {
        return X.x() <= 0.5 ? Vec3(X.x(), X.y(), 0.0) : Vec3(0.5, X.y(), 0.5 - X.x());
    });
}

TEST(FoldCloth, CrossingFoldsMustNotStretch)
{
    const FoldLine along_v{{Vec2(0.5, 0), Vec2(0.5, 1)}, 90.0};
    const FoldLine along_u{{Vec2(0, 0.5), Vec2(1, 0.5)}, 90.0};
    EXPECT_THROW(fold_grid({along_v, along_u}), InputError);
    // Fold lines may cross if one has angle 0, or is folded flat onto itself, because the other line then
    // stays straight.
    expect_isometric(fold_grid({{along_v.line, 0.0}, along_u}));
    expect_isometric(fold_grid({{along_v.line, 180.0}, along_u}));
    EXPECT_THROW(fold_grid({{along_v.line, 1.0}, along_u}), InputError);
}

TEST(FoldCloth, FoldsThatMeetOnTheBorderCompose)
{
    const ClothMesh mesh = fold_grid(
        {{{Vec2(0.5, 0), Vec2(0.2, 1)}, 60.0}, {{Vec2(0.5, 0), Vec2(0.8, 1)}, 60.0}}, GridPattern::Diagonal);
    expect_isometric(mesh);
}

TEST(FoldCloth, NeedsItsLineInTheMesh)
{
    ClothMesh mesh = make_cloth_grid({});
    const auto refuses = [&](const Vec2& p, const Vec2& q) {
        EXPECT_THROW(fold_cloth({{{p, q}, 30.0}}, mesh), InputError);
    };
    refuses({0.4, 0}, {0.4, 1});
    refuses({2, 0}, {2, 1});
    refuses({-1, 1}, {1, -1});  // touches only a corner
    refuses({0.5, 0.5}, {0.5, 0.5});
    refuses({std::nan(""), 0}, {0.5, 0.5});
    EXPECT_THROW(fold_cloth({{{Vec2(0, 0), Vec2(1, 1)}, std::nan("")}}, mesh), InputError);
}

}  // namespace
}  // namespace arris
