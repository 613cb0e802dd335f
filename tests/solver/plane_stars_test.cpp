// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/plane_stars.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/rigid_motion.h"
#include "tests/validation/grid_patterns.h"

namespace arris {
namespace {

constexpr double kTolerance = 1e-9;

struct Sheet {
    ClothMesh mesh;
    VertexFaces stars;

    explicit Sheet(GridPattern pattern = GridPattern::Cross)
    {
        ClothGrid grid;
        grid.size = {1.0, 0.8};
        grid.resolution = {5, 4};
        grid.pattern = pattern;
        mesh = make_cloth_grid(grid);
        stars = VertexFaces(mesh.vertex_count(), mesh.faces);
    }

    PlaneStars plane() const
    {
        return PlaneStars(mesh.faces, stars, mesh.vertex_count(), [this](int v) {
            return find_plane_normal(v, mesh.faces, stars, mesh.world, kTolerance);
        });
    }
};

TEST(PlaneStars, HaveTheNormalOfTheirPlaneWhereverTheyAre)
{
    const Mat3 turn = rotation_about(Vec3(1, -2, 0.5), 71.0);
    for (const GridPattern pattern : kPatterns)
        for (const double scale : {1e-3, 1.0, 1e3})
            for (const double far : {0.0, 1e3}) {
                Sheet sheet(pattern);
                for (Vec3& x : sheet.mesh.world) x = turn * (scale * x) + Vec3(far, -far, far);
                PlaneStars plane = sheet.plane();
                for (int v = 0; v < sheet.mesh.vertex_count(); ++v) {
                    const std::optional<Vec3>& normal = plane.normal(v);
                    ASSERT_TRUE(normal.has_value()) << name_of(pattern) << " " << scale << " " << far;
                    EXPECT_LT((*normal - turn.col(2)).norm(), 1e-7);
                }
            }
}

TEST(PlaneStars, EndWhereOneVertexIsOffThePlane)
{
    Sheet sheet;
    const int off = 14;
    sheet.mesh.world[off].z() = 1e-6;
    PlaneStars plane = sheet.plane();
    for (int v = 0; v < sheet.mesh.vertex_count(); ++v) {
        bool is_near = false;
        for (const int f : sheet.stars[v])
            for (const int w : sheet.mesh.faces[f]) is_near |= w == off;
        EXPECT_EQ(plane.normal(v).has_value(), !is_near) << v;
        EXPECT_FALSE(is_near && plane.is_plane_around(v));
    }
}

TEST(PlaneStars, AreNoneWhereFacesAreFoldedOntoOneAnotherOrHaveNoArea)
{
    Sheet folded;
    for (Vec3& x : folded.mesh.world) x.x() = std::abs(x.x() - 0.4);
    PlaneStars plane = folded.plane();
    int on_fold = 0;
    for (int v = 0; v < folded.mesh.vertex_count(); ++v) {
        const Vec3& x = folded.mesh.world[v];
        if (x.x() > 1e-9 || x.y() < 1e-9 || x.y() > 0.8 - 1e-9) continue;
        ++on_fold;
        EXPECT_FALSE(plane.normal(v).has_value()) << v;
    }
    EXPECT_EQ(on_fold, 3);

    Sheet collapsed;
    for (Vec3& x : collapsed.mesh.world) x = Vec3::UnitX();
    PlaneStars none = collapsed.plane();
    for (int v = 0; v < collapsed.mesh.vertex_count(); ++v) EXPECT_FALSE(none.normal(v).has_value());
}

TEST(PlaneStars, OfACornerWithOneFaceSayNothingWithoutThoseAround)
{
    Sheet sheet(GridPattern::Diagonal);
    for (Vec3& x : sheet.mesh.world) x.z() = x.x() * x.x();
    PlaneStars plane = sheet.plane();
    int single = 0;
    for (int v = 0; v < sheet.mesh.vertex_count(); ++v) {
        if (sheet.stars[v].size() > 1) continue;
        ++single;
        EXPECT_TRUE(plane.normal(v).has_value());
        EXPECT_FALSE(plane.is_plane_around(v));
    }
    EXPECT_EQ(single, 2);
}

TEST(PlaneStars, FindANormalOnceAndOnlyWhereAsked)
{
    const Sheet sheet;
    std::vector<int> asked;
    PlaneStars plane(sheet.mesh.faces, sheet.stars, sheet.mesh.vertex_count(), [&](int v) {
        asked.push_back(v);
        return std::optional<Vec3>();
    });
    EXPECT_TRUE(asked.empty());
    for (int k = 0; k < 2; ++k) {
        EXPECT_FALSE(plane.normal(14).has_value());
        EXPECT_FALSE(plane.is_plane_around(3));
    }
    EXPECT_EQ(asked, (std::vector<int>{14, sheet.mesh.faces[sheet.stars[3][0]][0]}));
}

}  // namespace
}  // namespace arris
