// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/model/constraint_cause.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "solver/eol/eol_coordinates.h"
#include "solver/mesh_change/conform.h"
#include "solver/sites/eol_decision.h"
#include "tests/solver/eol_cloth.h"

namespace arris {
namespace {

using testing::conform_cloth;
using testing::EolCloth;
using testing::kLyingCell;
using testing::kStep;
using testing::lying;
using testing::press_edges;

int count(const ConformOutcome& outcome, ConstraintCause cause)
{
    return static_cast<int>(
        std::count_if(outcome.refused.begin(), outcome.refused.end(),
                      [cause](const RefusedContact& refused) { return refused.cause == cause; }));
}

void take_without_rows(EolCloth& cloth)
{
    testing::take(cloth);
    cloth.state.active.clear();
}

/// Pins the vertices between these material coordinates u.
void hold(EolCloth& cloth, double from, double to)
{
    Pin pin;
    pin.material = {Vec2(from, 0.0), Vec2(to, 0.4)};
    cloth.scene.pins = {pin};
}

TEST(ConstraintCause, EachHasItsOwnName)
{
    std::set<std::string> names;
    for (std::size_t k = 0; k < kConstraintCauses; ++k)
        names.insert(to_string(static_cast<ConstraintCause>(k)));
    EXPECT_EQ(names.size(), kConstraintCauses);
    EXPECT_FALSE(names.contains(""));
}

TEST(ConstraintCause, WhatBecomesEolIsRefusedByNothing)
{
    EolCloth cloth = lying(17.0);
    press_edges(cloth);
    const ConformOutcome outcome = conform_cloth(cloth);
    ASSERT_TRUE(outcome.mesh);
    EXPECT_GE(outcome.mesh->report.inserted + count(outcome, ConstraintCause::BesideEol),
              static_cast<int>(cloth.state.active.size()));
    EXPECT_EQ(static_cast<int>(outcome.refused.size()), count(outcome, ConstraintCause::BesideEol))
        << "two edges that cross the feature at one vertex of the cloth";
}

TEST(ConstraintCause, EveryRowNearABorderIsCounted)
{
    EolCloth cloth = lying(0.0, 0.2 - 0.1 * kLyingCell);
    press_edges(cloth);
    const ConformOutcome outcome = conform_cloth(cloth);
    EXPECT_FALSE(outcome.mesh);
    EXPECT_EQ(count(outcome, ConstraintCause::NearBorder), static_cast<int>(cloth.state.active.size()));
    ASSERT_GT(cloth.state.active.size(), 6u);
    for (std::size_t k = 0; k < outcome.refused.size(); ++k) {
        EXPECT_EQ(outcome.refused[k].kind, ContactKind::Edge);
        EXPECT_EQ(outcome.refused[k].obstacle, 0);
    }
}

TEST(ConstraintCause, WhatComesFastToABorderIsNotNearItYet)
{
    // 34 mm of material are left; four steps use up 20 mm for each m/s. Negative speed moves the border away.
    for (const double speed : {1.5, 2.0, -2.0}) {
        EolCloth cloth = lying(0.0, 0.2 - 0.6 * kLyingCell);
        for (Vec3& v : cloth.state.velocity) v = Vec3(speed, 0, 0);
        press_edges(cloth);
        const ConformOutcome outcome = conform_cloth(cloth);
        EXPECT_EQ(count(outcome, ConstraintCause::BorderAhead),
                  speed > 1.7 ? static_cast<int>(cloth.state.active.size()) : 0);
        EXPECT_EQ(count(outcome, ConstraintCause::NearBorder), 0);
    }
}

TEST(ConstraintCause, WhereTheBorderRunsAlongTheFeatureItIsNotTried)
{
    for (const double turn : {8.0, 17.0, 23.0, 40.0}) {
        EolCloth cloth = lying(turn, 0.2);
        press_edges(cloth);
        std::erase_if(cloth.state.active, [&](const ActiveContact& row) {  // keeps only edges of the border
            const auto is_on_border = [&](std::uint32_t id) {
                return cloth.state.mesh.material[cloth.state.index_of(id)].x() < 1e-9;
            };
            return !is_on_border(row.vertex_ids[0]) || !is_on_border(row.vertex_ids[1]);
        });
        ASSERT_EQ(cloth.state.active.size(), 1u) << turn;
        const ConformOutcome outcome = conform_cloth(cloth);
        EXPECT_EQ(count(outcome, ConstraintCause::AlongBorder), turn < 20.0 ? 1 : 0) << turn;
        EXPECT_EQ(outcome.mesh.has_value(), turn > 20.0) << turn;
    }
}

TEST(ConstraintCause, WhatHasComeToTheBorderIsCountedAsNearIt)
{
    EolCloth cloth = lying(0.0, 0.2 - 0.6 * kLyingCell);
    press_edges(cloth);
    take_without_rows(cloth);
    ASSERT_GT(cloth.state.eol.size(), 4u);
    for (const EolVertex& e : cloth.state.eol)
        cloth.state.mesh.material[cloth.state.index_of(e.vertex_id)].x() = 0.1 * kLyingCell;
    const ConformOutcome outcome = conform_cloth(cloth);
    EXPECT_EQ(count(outcome, ConstraintCause::NearBorder), static_cast<int>(cloth.state.eol.size()));
    EXPECT_EQ(count(outcome, ConstraintCause::Released), 0);
}

TEST(ConstraintCause, AVertexThatIsGivenUpIsCountedAndWhatIsNotTriedAgain)
{
    EolCloth cloth = lying(17.0);
    press_edges(cloth);
    const std::vector<ActiveContact> rows = cloth.state.active;
    take_without_rows(cloth);
    const VertexId given_up = cloth.state.eol[2].vertex_id;
    const ConformOutcome alone = conform_cloth(cloth, {{}, {given_up}});
    ASSERT_TRUE(alone.mesh);
    ASSERT_EQ(alone.refused.size(), 1u);
    EXPECT_EQ(alone.refused[0].cause, ConstraintCause::GivenUp);
    EXPECT_EQ(alone.refused[0].vertex_ids[0], given_up);

    EolCloth fresh = lying(17.0);
    fresh.state.active = rows;
    const ConformOutcome none = conform_cloth(fresh, {{}, {given_up}});
    EXPECT_EQ(count(none, ConstraintCause::GivenUp), static_cast<int>(rows.size()));
}

TEST(ConstraintCause, WhatIsReleasedIsCountedWithItsReason)
{
    EolCloth cloth = lying(17.0);
    press_edges(cloth);
    take_without_rows(cloth);
    const auto last = std::max_element(
        cloth.state.eol.begin(), cloth.state.eol.end(), [&](const EolVertex& a, const EolVertex& b) {
            const auto y = [&](const EolVertex& e) {
                return cloth.state.mesh.world[cloth.state.index_of(e.vertex_id)].y();
            };
            return y(a) < y(b);
        });
    last->idle = kIdleSteps;  // an end of the trace: it is not between two firm vertices
    const ConformOutcome idle = conform_cloth(cloth);
    ASSERT_EQ(idle.refused.size(), 1u);
    EXPECT_EQ(idle.refused[0].cause, ConstraintCause::Released);
    EXPECT_EQ(idle.refused[0].vertex_ids[0], last->vertex_id);
    EXPECT_EQ(idle.refused[0].vertex_ids[1], ContactVertexIds::kNoVertex);
    EXPECT_EQ(idle.refused[0].kind, ContactKind::Vertex);
}

TEST(ConstraintCause, WhatLiesBetweenPressingContactsIsNoContact)
{
    // Two contacts press near the border, with other crossings between them. None becomes EOL, and only the
    // two contacts are counted.
    EolCloth cloth = lying(0.0, 0.2 - 0.1 * kLyingCell);
    press_edges(cloth);
    ASSERT_GT(cloth.state.active.size(), 6u);
    cloth.state.active = {cloth.state.active.front(), cloth.state.active.back()};
    EXPECT_EQ(conform_cloth(cloth).refused.size(), 2u);
}

TEST(ConstraintCause, WhatHasNoCoordinatesSaysWhy)
{
    // Upright cloth over the ridge: its plane contains the outward direction.
    EolCloth upright = lying(0.0);
    for (Vec3& x : upright.state.mesh.world) x = Vec3(0.0, x.y(), x.x() + 0.3);
    upright.add_eol(upright.vertex_at(0.2, 0.2), false, testing::tip_of(upright.scene.obstacles[0].shape()));
    EXPECT_EQ(count(conform_cloth(upright), ConstraintCause::EdgeOn), 1);

    // A border along the ridge, and a corner of the cloth.
    EolCloth along = lying(0.0, 0.2);
    along.add_eol(along.vertex_at(0.0, 0.2), false, testing::tip_of(along.scene.obstacles[0].shape()));
    EXPECT_EQ(count(conform_cloth(along), ConstraintCause::AlongBorder), 1);
    EolCloth corner = lying(0.0, 0.2);
    corner.add_eol(corner.vertex_at(0.0, 0.0), false, testing::tip_of(corner.scene.obstacles[0].shape()));
    EXPECT_EQ(count(conform_cloth(corner), ConstraintCause::ClothCorner), 1);

    for (const ConstraintCause cause :
         {ConstraintCause::NoDirection, ConstraintCause::AlongBorder, ConstraintCause::EdgeOn,
          ConstraintCause::ClothCorner, ConstraintCause::OtherObstacle, ConstraintCause::NearBorder,
          ConstraintCause::AtEol, ConstraintCause::FlatBehind})
        EXPECT_TRUE(is_excluded(cause)) << to_string(cause);
    for (const ConstraintCause cause :
         {ConstraintCause::New, ConstraintCause::NotCrossing, ConstraintCause::BesideEol,
          ConstraintCause::BorderAhead, ConstraintCause::Guard, ConstraintCause::Quality,
          ConstraintCause::OffPlane, ConstraintCause::Blocked, ConstraintCause::GivenUp,
          ConstraintCause::Released, ConstraintCause::OtherFeature})
        EXPECT_FALSE(is_excluded(cause)) << to_string(cause);
}

TEST(ConstraintCause, WhereHeldVerticesLeaveNoPlaceTheMeshIsTheReason)
{
    // The ridge is 2 % of a cell beside a row of pinned vertices.
    EolCloth cloth = lying(0.0, 0.2 - 3.02 * kLyingCell);
    hold(cloth, 3.0 * kLyingCell - 1e-6, 3.0 * kLyingCell + 1e-6);
    press_edges(cloth);
    const ConformOutcome outcome = conform_cloth(cloth);
    EXPECT_GT(count(outcome, ConstraintCause::Quality), 4);
    EXPECT_EQ(count(outcome, ConstraintCause::Guard), 0);
}

/// A trace flows towards a pinned row half a cell away. It would arrive within the four steps for which its
/// way is cleared.
EolCloth heading_for_held_row()
{
    EolCloth cloth = lying(0.0);
    press_edges(cloth);
    take_without_rows(cloth);
    hold(cloth, 4.0 * kLyingCell - 1e-6, 4.0 * kLyingCell + 1e-6);
    for (const EolVertex& e : cloth.state.eol)
        cloth.state.material_velocity[cloth.state.index_of(e.vertex_id)] =
            Vec2(0.25 * kLyingCell / kStep, 0.0);
    press_edges(cloth);
    return cloth;
}

TEST(ConstraintCause, AWayThatCannotBeClearedIsCounted)
{
    const ConformOutcome outcome = conform_cloth(heading_for_held_row());
    ASSERT_TRUE(outcome.mesh);
    EXPECT_GT(outcome.mesh->report.released, 2);
    EXPECT_EQ(count(outcome, ConstraintCause::Blocked), outcome.mesh->report.released);
    EXPECT_GE(outcome.lost, outcome.mesh->report.released) << "others may have been merged";
    EXPECT_EQ(count(outcome, ConstraintCause::GivenUp), 0);
}

TEST(ConstraintCause, AMeshThatLosesMoreVerticesThanItMayIsNotMade)
{
    const EolCloth cloth = heading_for_held_row();
    const ConformOutcome whole = conform_cloth(cloth);
    EXPECT_TRUE(conform_cloth(cloth, {}, {.lost = whole.lost}).mesh);
    const ConformOutcome unfinished = conform_cloth(cloth, {}, {.lost = whole.lost - 1});
    EXPECT_FALSE(unfinished.mesh);
    EXPECT_EQ(unfinished.lost, whole.lost);
}

TEST(ConstraintCause, WhatIsMadeAndFindsNoWayIsCountedAsTheContactItWas)
{
    for (const double side : {-1.0, 1.0}) {
        EolCloth cloth = lying(0.0);
        const double row = side > 0.0 ? 4.0 : 3.0;
        hold(cloth, row * kLyingCell - 1e-6, row * kLyingCell + 1e-6);
        for (Vec3& v : cloth.state.velocity) v = Vec3(-side * 0.25 * kLyingCell / kStep, 0.0, 0.0);
        press_edges(cloth);
        const ConformOutcome outcome = conform_cloth(cloth);
        ASSERT_TRUE(outcome.mesh);
        EXPECT_GT(outcome.mesh->report.released, 1);
        EXPECT_EQ(count(outcome, ConstraintCause::Blocked), outcome.mesh->report.released);
        for (const RefusedContact& refused : outcome.refused)
            EXPECT_EQ(refused.kind, ContactKind::Edge) << "none was EOL before";
    }
}

TEST(ConstraintCause, StiffClothThatWouldBeStrainedIsGuarded)
{
    // The cloth has a crease along the row of vertices beside the ridge. Moved onto the ridge, these vertices
    // would strain the cloth. If the row is nearer than 10 % of the target length, another row does not fit
    // between.
    for (const double cells : {0.04, 0.15}) {
        const double beside = cells * kLyingCell;
        EolCloth cloth = lying(0.0, 0.2 - 3.0 * kLyingCell + beside);
        cloth.scene.materials[0].youngs_modulus = 1e7;
        for (Vec3& x : cloth.state.mesh.world) {
            const double away = x.x() - beside;
            x = Vec3(beside + 0.8 * away, x.y(), x.z() + 0.6 * (beside / 0.8 - std::abs(away)));
        }
        press_edges(cloth);
        const ConformOutcome outcome = conform_cloth(cloth, {}, {.strain = StrainLimit::AsMade});
        const int guarded = count(outcome, ConstraintCause::Guard);
        if (cells < 0.1) {
            EXPECT_GT(guarded, 4);
        } else {
            EXPECT_EQ(guarded, 0);
            ASSERT_TRUE(outcome.mesh);
            EXPECT_GT(outcome.mesh->report.inserted, 4);
        }
    }
}

TEST(ConstraintCause, WhatSurgeryBesideItMovesOffThePlaneIsCounted)
{
    // Material lines are wavy across the ridge, and the cloth is so soft that strain prevents no mesh change.
    EolCloth cloth = lying(17.0);
    cloth.scene.materials[0].youngs_modulus = 1e-9;
    cloth.scene.gravity = Gravity{};
    for (Vec3& x : cloth.state.mesh.world) x.x() += 0.012 * std::sin(90.0 * x.y() + 40.0 * x.x());
    press_edges(cloth);
    const ConformOutcome outcome = conform_cloth(cloth);
    EXPECT_GT(count(outcome, ConstraintCause::OffPlane), 0);
}

}  // namespace
}  // namespace arris
