// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/sites/eol_decision.h"

#include <gtest/gtest.h>

#include "tests/solver/eol_cloth.h"

namespace arris {
namespace {

/// Whether a vertex at the offset `off` (m) from the tip of a ridge of 60 degrees may be EOL there.
bool may_be_at(const Vec3& off)
{
    testing::EolCloth cloth = testing::lying(0.0, 0.5 * testing::kLyingCell);
    const int v = cloth.vertex_at(0.2, 0.2);
    cloth.state.mesh.world[v] = Vec3(0.0, cloth.state.mesh.world[v].y(), 0.0) + off;
    const int entry = cloth.add_eol(v, false, testing::tip_of(cloth.scene.obstacles[0].shape()));
    const ClothStars stars = cloth.stars();
    const TraceMesh trace(cloth.scene, cloth.state, stars, {});
    return EolAdmission(cloth.scene, cloth.state, stars, trace, 0.02).is_in_plane(cloth.state.eol[entry]);
}

TEST(EolAdmission, OnAnEdgeOnlyInThePlaneInWhichAVertexMayMove)
{
    constexpr double kNear = 2.0 * testing::kThickness;
    EXPECT_TRUE(may_be_at(Vec3(0.0, 0.0, kNear)));
    EXPECT_FALSE(may_be_at(Vec3(kNear, 0.0, 0.0)));
    EXPECT_FALSE(may_be_at(Vec3(0.5 * kNear, 0.0, kNear)));
}

// A free fold is beyond both faces of its edge. A vertex beside one of the faces belongs to no fold. Held to
// the edge as an EOL vertex, it made a pleat at a table's corner snag.
TEST(EolAdmission, OfWhatHasLeftAnEdgeOnlyBeyondBothItsFaces)
{
    constexpr double kFar = 20.0 * testing::kThickness;
    for (const double side : {-1.0, 1.0}) {
        EXPECT_TRUE(may_be_at(Vec3(side * 0.3 * kFar, 0.0, kFar)));
        EXPECT_FALSE(may_be_at(Vec3(side * kFar, 0.0, 0.0)));
        EXPECT_FALSE(may_be_at(Vec3(side * kFar, 0.0, -kFar)));
    }
}

}  // namespace
}  // namespace arris
