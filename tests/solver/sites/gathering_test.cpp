// SPDX-License-Identifier: GPL-3.0-or-later
// Pleats that grow along a trace: which compression makes vertices gather.
#include "solver/sites/gathering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/solver/eol_cloth.h"

namespace arris {
namespace {

using testing::EolCloth;

/// A draped cloth with EOL vertices at the material heights `on_tip`, m, whose world is `squeezed` along the
/// tip about its middle. `is_cut`: no face joins the cloth below v = .15 m and above .2 m.
EolCloth squeeze(double squeezed, const std::vector<double>& on_tip, bool is_cut = false)
{
    testing::Drape shape;
    ClothMesh mesh = testing::make_draped(shape);
    for (Vec3& x : mesh.world) x.y() *= squeezed;
    if (is_cut) {
        std::erase_if(mesh.faces, [&](const Face& face) {
            const auto v_of = [&](int k) { return mesh.material[face[k]].y(); };
            const auto [least, most] = std::minmax({v_of(0), v_of(1), v_of(2)});
            return least < 0.175 && most > 0.175;
        });
    }
    EolCloth cloth(testing::make_ridge(90.0), std::move(mesh));
    const int tip = testing::tip_of(cloth.scene.obstacles.front().shape());
    for (const double v : on_tip) cloth.add_eol(cloth.vertex_at(0.2, v), false, tip);
    return cloth;
}

double greatest_gathering(EolCloth cloth)
{
    grow_gathering(cloth.scene, cloth.stars(), 1e-3, cloth.state);
    double greatest = 0.0;
    for (const EolVertex& vertex : cloth.state.eol) greatest = std::max(greatest, vertex.gathering);
    return greatest;
}

const std::vector<double> kNeighbours = {0.1, 0.15, 0.2, 0.25, 0.3}, kEverySecond = {0.1, 0.2, 0.3};

TEST(Gathering, GrowsWhereTheClothOnATraceIsCompressed)
{
    EXPECT_EQ(greatest_gathering(squeeze(1.0, kNeighbours)), 0.0);
    EXPECT_EQ(greatest_gathering(squeeze(1.1, kNeighbours)), 0.0);
    EXPECT_GT(greatest_gathering(squeeze(0.9, kNeighbours)), 0.0);
}

TEST(Gathering, CountsPleatsBetweenEolVertices)
{
    EXPECT_EQ(greatest_gathering(squeeze(1.0, kEverySecond)), 0.0);
    EXPECT_GT(greatest_gathering(squeeze(0.4, kEverySecond)), 0.0);
}

TEST(Gathering, CountsAPleatByThreePercent)
{
    const double on_trace = greatest_gathering(squeeze(0.982, kNeighbours));
    const double in_pleats = greatest_gathering(squeeze(0.4, kEverySecond));
    EXPECT_LT(on_trace, 2.9);  // less than its greatest value
    EXPECT_NEAR(in_pleats, on_trace, 1e-9 * on_trace);
}

TEST(Gathering, PassesOverOtherPiecesOfCloth)
{
    EXPECT_GT(greatest_gathering(squeeze(0.4, {0.1, 0.2})), 0.0);
    EXPECT_EQ(greatest_gathering(squeeze(0.4, {0.1, 0.2}, true)), 0.0);
}

TEST(Gathering, ReachesThreeCellsAlongTheFeature)
{
    EXPECT_GT(greatest_gathering(squeeze(0.45, {0.05, 0.35})), 0.0);  // .135 m, of cells of .05 m
    EXPECT_EQ(greatest_gathering(squeeze(0.55, {0.05, 0.35})), 0.0);  // .165 m
}

TEST(Gathering, IsNotMeasuredAtACorner)
{
    EolCloth cloth = squeeze(0.4, {0.1, 0.2});
    const int end = testing::end_of(cloth.scene.obstacles.front().shape());
    for (EolVertex& vertex : cloth.state.eol) vertex.on = {0, FeatureId::Kind::Corner, end};
    EXPECT_EQ(greatest_gathering(cloth), 0.0);
}

}  // namespace
}  // namespace arris
