// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/sites/eol_decision.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <tuple>

#include "geometry/obstacle/feature_path.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "solver/eol/eol_coordinates.h"
#include "solver/eol/eol_features.h"
#include "solver/model/hysteresis.h"
#include "solver/sites/feature_sites.h"
#include "tests/solver/eol_cloth.h"

namespace arris {
namespace {

using testing::Drape;
using testing::EolCloth;

constexpr double kSpeed = 1.5;  // m/s

/// Cloth flows over a ridge at uniform speed, with EOL vertices along its fold; `middle` is the one in the
/// middle.
struct FlowingCloth {
    EolCloth cloth;
    int middle, entry;

    explicit FlowingCloth(double fold_degrees, double speed = kSpeed)
        : cloth(testing::make_ridge(60.0), testing::make_draped({8, 0.0, fold_degrees})),
          middle(cloth.vertex_at(0.2, 0.2))
    {
        State& state = cloth.state;
        const Vec3 before =
            (state.mesh.world[middle] - state.mesh.world[cloth.vertex_at(0.1, 0.2)]).normalized();
        const Vec3 after =
            (state.mesh.world[cloth.vertex_at(0.3, 0.2)] - state.mesh.world[middle]).normalized();
        for (int v = 0; v < state.mesh.vertex_count(); ++v) {
            const double s = state.mesh.material[v].x() - 0.2;
            state.velocity[v] = s < 0.0 ? Vec3(speed * before) : Vec3(speed * after);
            if (std::abs(s) > 1e-9) continue;
            state.velocity[v].setZero();
            state.material_velocity[v] = Vec2(-speed, 0.0);
            cloth.add_eol(v, false, testing::tip_of(cloth.scene.obstacles[0].shape()));
        }
        entry = state.eol_entry(state.ids[middle]);
        set_idle(kIdleSteps);
    }

    void set_idle(int steps) { cloth.state.eol[entry].idle = steps; }

    EolRetention hold() const
    {
        const EolPlacing placing = cloth.place(middle);
        return decide_retention(cloth.scene, cloth.state, cloth.stars(), entry, *placing.coordinates,
                                cloth.state.mesh.world[middle]);
    }
    bool can_be_let_go() const { return hold() != EolRetention::Firm; }
};

TEST(EolRetention, OfAFoldWaitsWhetherMaterialFlowsOrNot)
{
    for (const double speed : {kSpeed, 0.0}) {
        for (const double fold : {60.0, 90.0, 120.0, 165.0, 173.0})
            EXPECT_FALSE(FlowingCloth(fold, speed).can_be_let_go()) << fold;
        for (const double fold : {175.0, 180.0})
            EXPECT_TRUE(FlowingCloth(fold, speed).can_be_let_go()) << fold;
    }
}

TEST(EolRetention, OfFlatClothWaitsForThreeStepsWithoutPressing)
{
    FlowingCloth flat(180.0);
    EXPECT_TRUE(flat.can_be_let_go());
    flat.set_idle(kIdleSteps - 1);
    EXPECT_FALSE(flat.can_be_let_go()) << "it may press again at once";
}

TEST(EolRetention, WhileItPressesNeverIs)
{
    FlowingCloth flat(180.0);
    flat.set_idle(0);
    EXPECT_FALSE(flat.can_be_let_go());
}

TEST(EolRetention, ComesAtTheLatestACellFromTheFeatureHoweverFastItFlows)
{
    for (const double speed : {kSpeed, 0.1, 0.0})
        for (const auto& [share, is_far] : {std::pair{0.95, false}, {1.05, true}}) {
            FlowingCloth lifted(90.0, speed);
            const double cell = lifted.cloth.scene.eol->length(Vec2(0.2, 0.2));
            for (Vec3& x : lifted.cloth.state.mesh.world) x.z() += share * cell;
            EXPECT_EQ(lifted.can_be_let_go(), is_far) << speed;
        }
}

// Cloth that flows fast over a flat fold arrives along neither face of the ridge.
TEST(EolRetention, ComesBeforeThatWhereAFastFoldIsLedOtherwiseThanItsClothComes)
{
    for (const auto& [fold, speed, is_astray] :
         {std::tuple{150.0, kSpeed, true}, {150.0, 0.1, false}, {90.0, kSpeed, false}})
        for (const double share : {0.9, 1.1}) {
            FlowingCloth lifted(fold, speed);
            const double cell = lifted.cloth.scene.eol->length(Vec2(0.2, 0.2));
            for (Vec3& x : lifted.cloth.state.mesh.world) x.z() += share * kAstrayCells * cell;
            EXPECT_EQ(lifted.can_be_let_go(), is_astray && share > 1.0) << fold << ", " << speed;
        }
}

TEST(EolRetention, OfATentThatIsOffItsNailComesWhereTheNailPressesOnAnotherFace)
{
    for (const double height : {2.0, 3.0})  // thicknesses
        for (const bool is_pressing : {false, true}) {
            EolCloth cloth(
                MovingObstacle("nails", make_points({{1.0, 0.0, 0.0}, Vec3::Zero()}), {}, {}, 30.0),
                testing::make_draped({8, 0.0, 180.0}));
            for (Vec3& x : cloth.state.mesh.world)
                x.z() = height * testing::kThickness - 0.5 * std::hypot(x.x(), x.y());
            const int v = cloth.vertex_at(0.2, 0.2);
            const int entry = cloth.add_eol(v, true, 1);
            cloth.state.eol[entry].idle = kIdleSteps;
            // A contact with another nail presses and, if `is_pressing`, one with the vertex's own nail.
            for (const int nail : {0, 1})
                if (nail == 0 || is_pressing)
                    cloth.state.active.push_back(
                        {{0, 1, 10}, ContactKind::Triangle, 0, nail, Vec3::UnitZ(), 1e-6});
            const EolPlacing placing = cloth.place(v);
            ASSERT_TRUE(placing.coordinates);
            const EolRetention hold = decide_retention(cloth.scene, cloth.state, cloth.stars(), entry,
                                                       *placing.coordinates, cloth.state.mesh.world[v]);
            EXPECT_EQ(hold, is_pressing && height > kOnFeature ? EolRetention::None : EolRetention::Firm)
                << height;
        }
}

TEST(EolRetention, OfATentThatIsOffACornerComesWhereThatPressesOnAnotherFace)
{
    for (const bool is_pressing : {false, true}) {
        EolCloth cloth(testing::make_ridge(60.0, 0.1), testing::make_draped({8, 0.0, 180.0}));
        for (Vec3& x : cloth.state.mesh.world)
            x.z() = 3.0 * testing::kThickness - 0.5 * std::hypot(x.x(), x.y() - 0.1);
        const Obstacle& ridge = cloth.scene.obstacles[0].shape();
        const int v = cloth.vertex_at(0.2, 0.3), corner = testing::end_of(ridge);
        const int entry = cloth.add_eol(v, true, corner);
        cloth.state.eol[entry].idle = kIdleSteps;
        if (is_pressing)
            cloth.state.active.push_back({{0, 1, 10},
                                          ContactKind::Triangle,
                                          0,
                                          ridge.features().corners[corner].point,
                                          Vec3::UnitZ(),
                                          1e-6});
        const EolPlacing placing = cloth.place(v);
        ASSERT_TRUE(placing.coordinates);
        const EolRetention hold = decide_retention(cloth.scene, cloth.state, cloth.stars(), entry,
                                                   *placing.coordinates, cloth.state.mesh.world[v]);
        EXPECT_EQ(hold, is_pressing ? EolRetention::None : EolRetention::Firm);
    }
}

/// Result of retain_between for a row of EOL vertices along the ridge: F (firm), L (loose) or N (none) for
/// each, in material order.
std::string retain_between_of(const std::string& along)
{
    const FlowingCloth flowing(90.0, 0.0);
    const State& state = flowing.cloth.state;
    EXPECT_EQ(along.size(), state.eol.size());
    std::vector<std::pair<double, int>> row;
    for (int e = 0; e < static_cast<int>(state.eol.size()); ++e)
        row.emplace_back(state.mesh.material[state.index_of(state.eol[e].vertex_id)].y(), e);
    std::sort(row.begin(), row.end());
    std::vector<EolRetention> holds(row.size());
    for (std::size_t k = 0; k < row.size(); ++k)
        holds[row[k].second] = along[k] == 'F'   ? EolRetention::Firm
                               : along[k] == 'L' ? EolRetention::Loose
                                                 : EolRetention::None;
    retain_between(flowing.cloth.scene, state, flowing.cloth.stars(), holds);
    std::string found;
    for (const auto& [y, e] : row)
        found += holds[e] == EolRetention::Firm ? 'F' : holds[e] == EolRetention::Loose ? 'L' : 'N';
    return found;
}

TEST(EolRetention, LeavesNoHolesInATrace)
{
    EXPECT_EQ(retain_between_of("FLFLLLFFF"), "FFFFFFFFF");
    EXPECT_EQ(retain_between_of("LLFLLFNLL"), "NNFFFFNNN");
    EXPECT_EQ(retain_between_of("FLNLFLLLL"), "FNNNFNNNN");
    EXPECT_EQ(retain_between_of("LLLLLLLLL"), "NNNNNNNNN");
}

TEST(EolRetention, HoldsNothingBetweenThatIsOffTheFeature)
{
    FlowingCloth still(180.0, 0.0);
    EXPECT_EQ(still.hold(), EolRetention::Loose);
    const double thickness = still.cloth.scene.materials.thickness();
    for (Vec3& x : still.cloth.state.mesh.world) x.z() += 3.0 * thickness;
    EXPECT_EQ(still.hold(), EolRetention::None);
}

// A vertex at a bend of a wire is fixed, and needs the room of one at a corner: with that of a sliding vertex
// it would stay where none is inserted, and be released and inserted in turn.
TEST(EolRetention, AtABendOfAWireNeedsTheRoomOfACorner)
{
    constexpr double kCell = 0.05;
    const auto is_kept = [&](bool is_bend, double cells) {
        EolCloth cloth(
            MovingObstacle("wire", make_wire({{-0.05, -1, 0}, {-0.15, 0, 0}, {-0.05, 1, 0}}, false), {}, {},
                           30.0),
            testing::make_draped({8, 0.0, 180.0}));
        const int v = cloth.vertex_at(kCell, 0.2);
        cloth.state.mesh.world[v] = Vec3(-0.15, 0.0, 0.0);
        cloth.state.mesh.material[v].x() = cells * kCell;
        const std::optional<FeatureBend> bend = find_bend(cloth.scene.obstacles[0].shape(), 1);
        EXPECT_TRUE(bend.has_value());
        EolVertex& eol = cloth.state.eol[cloth.add_eol(v, false, bend->feature)];
        eol.outward = Vec3::UnitZ();
        if (is_bend) eol.on = FeatureId::bend(0, bend->feature, bend->end);
        const std::vector<EolRelease> released = find_releases(cloth.scene, cloth.state, cloth.stars());
        for (const EolRelease& release : released) EXPECT_EQ(release.cause, ConstraintCause::NearBorder);
        return released.empty();
    };
    constexpr double kFixed = kStayRatio * kRoom.fixed, kSliding = kStayRatio * kRoom.sliding;
    EXPECT_TRUE(is_kept(true, kFixed + 0.05));
    EXPECT_FALSE(is_kept(true, kFixed - 0.05));
    EXPECT_TRUE(is_kept(false, kFixed - 0.05));
    EXPECT_FALSE(is_kept(false, kSliding - 0.05));
}

}  // namespace
}  // namespace arris
