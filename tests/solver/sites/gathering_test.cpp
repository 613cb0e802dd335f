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
/// tip about its middle.
EolCloth squeeze(double squeezed, const std::vector<double>& on_tip)
{
    testing::Drape shape;
    ClothMesh mesh = testing::make_draped(shape);
    for (Vec3& x : mesh.world) x.y() *= squeezed;
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

const std::vector<double> kNeighbours = {0.1, 0.15, 0.2, 0.25, 0.3};

TEST(Gathering, GrowsWhereTheClothOnATraceIsCompressed)
{
    EXPECT_EQ(greatest_gathering(squeeze(1.0, kNeighbours)), 0.0);
    EXPECT_EQ(greatest_gathering(squeeze(1.1, kNeighbours)), 0.0);
    EXPECT_GT(greatest_gathering(squeeze(0.9, kNeighbours)), 0.0);
}

TEST(Gathering, IsNotMeasuredAtACorner)
{
    EolCloth cloth = squeeze(0.4, {0.1, 0.15});
    ASSERT_GT(greatest_gathering(cloth), 0.0);
    const int end = testing::end_of(cloth.scene.obstacles.front().shape());
    for (EolVertex& vertex : cloth.state.eol) vertex.on = {0, FeatureId::Kind::Corner, end};
    EXPECT_EQ(greatest_gathering(cloth), 0.0);
}

}  // namespace
}  // namespace arris
