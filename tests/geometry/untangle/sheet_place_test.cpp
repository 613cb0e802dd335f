// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/untangle/sheet_place.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/geometry/untangle/tangled_cloth.h"

namespace arris {
namespace {

constexpr double kRounding = 1e-15;  // m, of places of some tenths of a metre

TEST(SheetPlace, StaysOnItsSheetWhereAnotherOneIsNearer)
{
    samples::TangledCloth cloth;
    for (const double z : {0.0, 0.01})
        cloth.add({0.4, 0.4}, [&](const Vec2& X) { return Vec3(X.x(), X.y(), z); });
    const CollisionMesh mesh(cloth.mesh, samples::self_request());
    const Vec3 place(0.333, 0.277, 0.011);
    for (const int sheet : {0, 1}) {
        const SheetPlace found = walk_to_nearest(mesh, place, cloth.first_face[sheet]);
        EXPECT_NEAR(found.distance, sheet == 0 ? 0.011 : 0.001, kRounding);
        EXPECT_NEAR((found.point - Vec3(0.333, 0.277, 0.01 * sheet)).norm(), 0.0, kRounding);
        EXPECT_NEAR(found.normal.z(), 1.0, kRounding);
        EXPECT_FALSE(found.is_on_border);
    }
}

TEST(SheetPlace, TellsWhatIsBeyondABorder)
{
    samples::TangledCloth cloth;
    cloth.add({0.4, 0.4}, [&](const Vec2& X) { return Vec3(X.x(), X.y(), 0.0); });
    const CollisionMesh mesh(cloth.mesh, samples::self_request());
    EXPECT_TRUE(walk_to_nearest(mesh, {0.41, 0.277, 0.01}, 0).is_on_border);
    EXPECT_TRUE(walk_to_nearest(mesh, {-0.01, -0.01, 0.01}, 700).is_on_border);  // at a corner
    EXPECT_FALSE(walk_to_nearest(mesh, {0.39, 0.277, 0.01}, 0).is_on_border);
}

TEST(SheetPlace, OfASolidIsOnItsNearestWall)
{
    UntangleRequest request = samples::self_request();
    request.obstacles = {samples::cube_of_20_cm()};
    request.obstacles.front().pose.placement = {rotation_about({1.0, 2.0, 3.0}, 40.0), {0.3, 0.2, 0.1}};
    const samples::TangledCloth cloth = samples::dipped_sheet(0.1, 0.01);
    const CollisionMesh mesh(cloth.mesh, request);
    const Placement& placement = request.obstacles.front().pose.placement;
    for (int f = 0; f < 12; ++f) {
        const Vec3 below_top = placement({0.02, 0.03, 0.07});
        const SheetPlace found = walk_to_nearest(mesh, below_top, cloth.mesh.face_count() + f);
        EXPECT_NEAR(found.distance, 0.03, kRounding);
        EXPECT_NEAR((found.point - placement({0.02, 0.03, 0.1})).norm(), 0.0, kRounding);
    }
}

}  // namespace
}  // namespace arris
