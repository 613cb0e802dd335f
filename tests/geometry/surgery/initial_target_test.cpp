// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surgery/initial_target.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "geometry/surgery/surgery_cleanup.h"
#include "tests/geometry/surgery_cloths.h"

namespace arris {
namespace {

// Cells that grow nearly threefold from left to right.
SurgeryCloth graded_cloth(int n)
{
    SurgeryCloth cloth = square_cloth(n);
    for (Vec2& X : cloth.mesh.material) X.x() = (std::exp(X.x()) - 1.0) / (std::exp(1.0) - 1.0);
    return cloth;
}

TEST(InitialTarget, IsTheMeanEdgeLengthOfARegularMesh)
{
    const SurgeryCloth cloth = square_cloth(10);
    const MeshTarget target = make_initial_target(cloth.mesh);
    const double inside = cloth.cell * (4.0 + 2.0 * std::sqrt(2.0)) / 6.0;
    EXPECT_NEAR(target.length({0.5, 0.5}), inside, 1e-15);
    EXPECT_NEAR(target.length({0.43, 0.57}), inside, 1e-15);
    EXPECT_EQ(target.least_angle({0.43, 0.57}), 15.0);
    EXPECT_NEAR(make_initial_target(cloth.mesh, 60.0).least_angle({0.43, 0.57}), 45.0, 1e-12);
}

TEST(InitialTarget, IsLinearBetweenVerticesAndFollowsTheMesh)
{
    const SurgeryCloth cloth = graded_cloth(20);
    const MeshTarget target = make_initial_target(cloth.mesh);
    EXPECT_GT(target.length({0.9, 0.5}), 1.3 * target.length({0.1, 0.5}));
    const Face& f = cloth.mesh.faces[100];
    const Vec2 a = cloth.mesh.material[f[0]], b = cloth.mesh.material[f[1]];
    EXPECT_NEAR(target.length(0.3 * a + 0.7 * b), 0.3 * target.length(a) + 0.7 * target.length(b), 1e-15);
}

TEST(InitialTarget, NothingIsBeyondItsBoundsAndTheyAreMet)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-0.3, 1.3);
    for (const SurgeryCloth& cloth : {square_cloth(12), graded_cloth(20), bay_cloth(9), holed_cloth(9)}) {
        const MeshTarget target = make_initial_target(cloth.mesh, 40.0);
        std::vector<Vec2> points = cloth.mesh.material;
        for (int k = 0; k < 1000; ++k) points.push_back({place(random), place(random)});
        double shortest = std::numeric_limits<double>::infinity(), longest = 0.0;
        for (const Vec2& X : points) {
            const double length = target.length(X);
            EXPECT_GE(length, target.shortest);
            EXPECT_LE(length, target.longest);
            EXPECT_LE(target.least_angle(X), target.most_angle);
            shortest = std::min(shortest, length);
            longest = std::max(longest, length);
        }
        EXPECT_NEAR(target.shortest, shortest, 1e-9 * shortest) << cloth.name;
        EXPECT_NEAR(target.longest, longest, 1e-9 * longest) << cloth.name;
        EXPECT_EQ(target.most_angle, 40.0);
    }
}

TEST(InitialTarget, BeyondTheMeshTheNearestFaceCounts)
{
    const MeshTarget target = make_initial_target(square_cloth(10).mesh);
    for (const Vec2& by : {Vec2(-1e-17, 0.0), Vec2(-1e-9, 0.0), Vec2(-3.0, 0.0), Vec2(-1e6, 1e6)})
        EXPECT_GT(target.length(Vec2(0.0, 0.55) + by), 0.09);
    EXPECT_NEAR(target.length({-1e-12, 0.55}), target.length({0.0, 0.55}), 1e-12);
}

TEST(InitialTarget, AsksNoWorkOfTheMeshItWasMadeOf)
{
    for (const SurgeryCloth& cloth : {square_cloth(12), graded_cloth(20), bay_cloth(9), holed_cloth(9)}) {
        ClothSurgery surgery = cloth.surgery();
        for (const VertexId v : cloth.ids()) surgery.touch(v);
        const MeshTarget target = make_initial_target(cloth.mesh);
        EXPECT_EQ(clean_up(surgery, target).operations(), 0) << cloth.name;
        for (const VertexId v : cloth.ids())
            for (const IdFace& face : surgery.faces_at(v)) {
                const PatchFace patch = surgery.patch_face(face);
                EXPECT_GE(least_angle(patch), target.least_angle(material_centre(patch))) << cloth.name;
            }
    }
}

TEST(InitialTarget, CleanUpBringsASizeToAMeshAndStaysThere)
{
    const SurgeryCloth cloth = square_cloth(30, 0.2);
    ClothSurgery surgery = cloth.surgery();
    const SurgeryCheck check(surgery);
    const MeshTarget target = make_initial_target(graded_cloth(12).mesh);
    int last = 0, count = 0;
    for (int pass = 0; pass < 12; ++pass) {
        for (const VertexId v : surgery.result().ids) surgery.touch(v);
        const CleanupReport report = clean_up(surgery, target);
        ASSERT_LE(report.operations(), report.most_operations);
        ASSERT_EQ(check.find_wrong(surgery), "");
        last = count;
        count = surgery.vertex_count();
    }
    EXPECT_LT(count, 500);
    EXPECT_GT(count, 100);
    EXPECT_NEAR(count, last, 0.02 * last);
}

}  // namespace
}  // namespace arris
