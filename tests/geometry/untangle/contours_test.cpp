// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/untangle/contours.h"

#include <gtest/gtest.h>

#include "tests/geometry/untangle/tangled_cloth.h"

namespace arris {
namespace {

using samples::TangledCloth;

std::vector<Contour> contours_of(const TangledCloth& cloth)
{
    const CollisionMesh mesh(cloth.mesh, samples::self_request());
    return find_contours(mesh, find_crossings(mesh, mesh.positions).to_untangle);
}

TEST(Contours, SheetsThatCrossOnceMakeOne)
{
    const TangledCloth cloth = samples::crossed_borders();
    const std::vector<Contour> contours = contours_of(cloth);
    ASSERT_EQ(contours.size(), 1u);
    EXPECT_TRUE(contours.front().is_pierced());
    EXPECT_NEAR(contours.front().length, 0.058, 1e-12);  // from border to border, 0.031 + 0.027
    for (const auto& [first, second] : contours.front().pairs) {
        EXPECT_LT(first, cloth.first_face[1]);
        EXPECT_GE(second, cloth.first_face[1]);
    }
}

TEST(Contours, AFoldMakesOneOnEachOfItsSides)
{
    TangledCloth cloth = samples::fold_through_sheet();
    // Both sides of a crest only 1 cm above the sheet cross the same faces of the sheet.
    for (const Face& f : cloth.piece(1))
        for (const int v : f) cloth.mesh.world[v].z() = -0.0503;
    const std::vector<Contour> contours = contours_of(cloth);
    ASSERT_EQ(contours.size(), 2u);
    for (const Contour& contour : contours) EXPECT_NEAR(contour.length, 0.2, 1e-12);  // the fold's width
}

TEST(Contours, PanelsInOnePlanePierceNothing)
{
    for (const Contour& contour : contours_of(samples::coplanar_sliver())) EXPECT_FALSE(contour.is_pierced());
}

TEST(Contours, PullIsTheDerivativeOfTheLength)
{
    constexpr double kStep = 1e-6;       // m
    constexpr double kTolerance = 1e-6;  // the length is linear in the move but for rounding
    for (const auto& make : {samples::corner_through_sheet, samples::crossed_borders}) {
        const TangledCloth cloth = make();
        const std::vector<Contour> contours = contours_of(cloth);
        ASSERT_EQ(contours.size(), 1u);
        for (int axis = 0; axis < 3; ++axis) {
            std::array<double, 2> lengths;
            for (const int end : {0, 1}) {
                TangledCloth moved = cloth;
                std::vector<char> is_moved(cloth.mesh.world.size(), 0);
                for (const Face& f : cloth.piece(0))
                    for (const int v : f) is_moved[v] = 1;
                for (std::size_t v = 0; v < is_moved.size(); ++v)
                    if (is_moved[v]) moved.mesh.world[v][axis] += (end - 0.5) * kStep;
                lengths[end] = contours_of(moved).front().length;
            }
            EXPECT_NEAR(contours.front().pull[axis], (lengths[1] - lengths[0]) / kStep, kTolerance);
        }
    }
}

}  // namespace
}  // namespace arris
