// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/pattern/garment_code.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "geometry/cloth/euler_characteristic.h"
#include "geometry/cloth/mesh_quality.h"
#include "geometry/cloth/mesh_topology.h"
#include "geometry/cloth_input/pattern/pattern_cloth.h"
#include "tests/app/scene/pattern/tabard.h"

namespace arris {
namespace {

using ::testing::IsEmpty;
using ::testing::StartsWith;
using Json = nlohmann::json;

constexpr double kRounded = 1e-12;  // m

GarmentCodePattern parse(const std::string& text, const GarmentCodeOptions& options = {})
{
    return parse_garment_code("tabard.json", text, options);
}

const Panel& panel_of(const GarmentCodePattern& read, const std::string& name)
{
    return read.pattern.panels[find_panel(read.pattern, name)];
}

TEST(GarmentCode, LengthsBecomeMetres)
{
    const GarmentCodePattern read = parse(kTabard);
    ASSERT_EQ(read.pattern.panels.size(), 3U);
    const Panel& front = panel_of(read, "front");
    EXPECT_NEAR((front.edges[2].begin - Vec2(0.2, 0.1)).norm(), 0.0, kRounded);
    EXPECT_NEAR(std::get<CircularArc>(front.edges[6].shape).radius, 0.1, kRounded);
    const GarmentCodePattern inches = parse(with("/properties/units_in_meter", 39.37));
    EXPECT_NEAR(panel_of(inches, "front").edges[4].begin.x(), 40.0 / 39.37, kRounded);
}

TEST(GarmentCode, CurvaturesAreRelativeToTheirEdge)
{
    const GarmentCodePattern read = parse(kTabard);
    const Panel& front = panel_of(read, "front");
    // Up the right side: its left is -u, so -0.05 of 0.6 m bulges to +u.
    const auto& quadratic = std::get<BezierCurve>(front.edges[4].shape).control;
    ASSERT_EQ(quadratic.size(), 1U);
    EXPECT_NEAR((quadratic[0] - Vec2(0.43, 0.3)).norm(), 0.0, kRounded);
    const auto& cubic = std::get<BezierCurve>(front.edges[8].shape).control;
    ASSERT_EQ(cubic.size(), 2U);
    EXPECT_NEAR((cubic[0] - Vec2(-0.03, 0.45)).norm(), 0.0, kRounded);
    EXPECT_NEAR((cubic[1] - Vec2(-0.03, 0.15)).norm(), 0.0, kRounded);
    const auto& plain = std::get<BezierCurve>(panel_of(read, "back").edges[0].shape).control;
    ASSERT_EQ(plain.size(), 1U);
    EXPECT_NEAR((plain[0] - Vec2(-0.03, 0.3)).norm(), 0.0, kRounded);
    EXPECT_THAT(std::get<BezierCurve>(panel_of(read, "back").edges[2].shape).control, IsEmpty());
}

TEST(GarmentCode, NecklinesAreCutOutOfTheirPanel)
{
    const std::vector<EdgeCurve> curves = curves_of(panel_of(parse(kTabard), "front"));
    // Radius 0.1 over a chord of 0.16 m: a depth of 0.1 - 0.06.
    EXPECT_NEAR((curves[6].at(0.5) - Vec2(0.2, 0.56)).norm(), 0.0, kRounded);
    const GarmentCodePattern other = parse(with("/pattern/panels/front/edges/6/curvature/params/2", 1));
    EXPECT_NEAR((curves_of(panel_of(other, "front"))[6].at(0.5) - Vec2(0.2, 0.64)).norm(), 0.0, kRounded);
    const GarmentCodePattern large =
        parse(with("/pattern/panels/front/edges/6/curvature/params", {10, true, true}));
    EXPECT_NEAR((curves_of(panel_of(large, "front"))[6].at(0.5) - Vec2(0.2, 0.76)).norm(), 0.0, kRounded);
}

TEST(GarmentCode, PanelsStandUpright)
{
    const Placement upright = panel_of(parse(kTabard), "front").placement;
    // x, y up and z towards the viewer become x, z up and -y.
    EXPECT_NEAR((upright(Vec3(0.1, 0.2, 0.0)) - Vec3(-0.1, -0.15, 1.2)).norm(), 0.0, kRounded);
    GarmentCodeOptions options;
    options.up = 'z';
    const Placement flat = panel_of(parse(kTabard, options), "front").placement;
    EXPECT_NEAR((flat(Vec3(0.1, 0.2, 0.0)) - Vec3(-0.1, 1.2, 0.15)).norm(), 0.0, kRounded);
}

TEST(GarmentCode, OrderOfRotationsIsTheCallersChoice)
{
    GarmentCodeOptions options;
    options.up = 'z';
    const GarmentCodePattern simulated = parse(kTabard, options);
    // About x by 90 degrees u stays and v becomes z; then about y by 45 degrees.
    const double half = std::sqrt(0.5);
    const Mat3 turned = panel_of(simulated, "pocket").placement.rotation;
    EXPECT_NEAR((turned.col(0) - Vec3(half, 0.0, -half)).norm(), 0.0, kRounded);
    EXPECT_NEAR((turned.col(1) - Vec3(half, 0.0, half)).norm(), 0.0, kRounded);
    options.order = RotationOrder::ZThenYThenX;
    const GarmentCodePattern written = parse(kTabard, options);
    // About y by 45 degrees v stays; then about x by 90 degrees it becomes z.
    const Mat3 other = panel_of(written, "pocket").placement.rotation;
    EXPECT_NEAR((other.col(0) - Vec3(half, half, 0.0)).norm(), 0.0, kRounded);
    EXPECT_NEAR((other.col(1) - Vec3(0.0, 0.0, 1.0)).norm(), 0.0, kRounded);
    for (const GarmentCodePattern* read : {&simulated, &written}) {
        ASSERT_EQ(read->notes.size(), 1U);
        EXPECT_THAT(read->notes[0], StartsWith("pattern.panels.pocket: is turned about more than one axis"));
    }
    EXPECT_THAT(parse(with("/pattern/panels/pocket/rotation", {0, 45, 0})).notes, IsEmpty());
}

TEST(GarmentCode, StitchesJoinEndsToBeginnings)
{
    const GarmentCodePattern read = parse(kTabard);
    ASSERT_EQ(read.pattern.seams.size(), 5U);
    const Seam& side = read.pattern.seams[1];
    EXPECT_EQ(read.pattern.panels[side.sides[0].panel].name, "front");
    EXPECT_EQ(side.sides[0].edge, 4);
    EXPECT_FALSE(side.sides[0].is_backward);
    EXPECT_EQ(read.pattern.panels[side.sides[1].panel].name, "back");
    EXPECT_TRUE(side.sides[1].is_backward);
}

TEST(GarmentCode, PanelStitchedRightToWrongIsTurnedOver)
{
    const GarmentCodePattern read = parse(kTabard);
    const Seam& hem = read.pattern.seams[4];
    EXPECT_FALSE(hem.is_tie);
    EXPECT_FALSE(hem.sides[1].is_backward);
    EXPECT_TRUE(panel_of(read, "pocket").is_turned_over);
    EXPECT_FALSE(panel_of(read, "front").is_turned_over);
    // A second stitch of the usual kind cannot agree with it.
    Json json = Json::parse(kTabard);
    json["pattern"]["stitches"].push_back(
        {{{"panel", "pocket"}, {"edge", 2}}, {{"panel", "back"}, {"edge", 2}}});
    const GarmentCodePattern tied = parse(json.dump());
    EXPECT_TRUE(tied.pattern.seams[5].is_tie);
    EXPECT_THAT(tied.notes.back(), StartsWith("pattern.stitches[5]: joins the right side"));
}

TEST(GarmentCode, LabelsAreKept)
{
    const GarmentCodePattern read = parse(kTabard);
    EXPECT_EQ(panel_of(read, "front").edges[3].label, "hem");
    EXPECT_EQ(panel_of(read, "front").edges[4].label, "");
}

TEST(GarmentCode, PatternIsMeshedAndSewn)
{
    const SewingPattern pattern = parse(kTabard).pattern;
    const PatternMesh meshes = mesh_pattern(pattern, 0.02);
    const PatternCloth cloth = join_panels(pattern, meshes, 0.02, SewnSeams::All);
    EXPECT_EQ(validate(cloth.mesh), "");
    // Two lines of seams make a ring of front and back; closing the dart and adding the pocket change
    // nothing.
    EXPECT_EQ(euler_characteristic(cloth.mesh), 0);
    const double neck = 0.01 * (std::asin(0.8) - 0.48);
    const double sides = 2.0 / 3.0 * 0.5 * 0.6 * 0.03 + 9.0 * 0.03 * 0.6 * (1.0 / 40.0 + 1.0 / 30.0);
    const double front = 0.24 - 0.5 * 0.04 * 0.1 - neck + sides;
    const double back = 0.24 + 2.0 / 3.0 * 0.5 * 0.6 * 0.03, pocket = 0.01;
    EXPECT_NEAR(material_area(cloth.mesh), front + back + pocket, 1e-3);
    EXPECT_GT(least_material_angle(cloth.mesh), 25.0);
}

}  // namespace
}  // namespace arris
