// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/sites/feature_flow.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "tests/solver/eol_cloth.h"

namespace arris {
namespace {

using testing::EolCloth;
using testing::make_draped;
using testing::make_ridge;

constexpr double kRoundOff = 1e-12;  // m/s, for speeds of 1 m/s

enum class On { Edge, EdgeAtBorder, Corner };

/// The flow at the cloth's vertex nearest to (u, v), taken as a site on the ridge.
Vec2 flow_at(const EolCloth& cloth, double u, double v, On on)
{
    const int near = cloth.vertex_at(u, v);
    const int tip = testing::tip_of(cloth.scene.obstacles[0].shape());
    const FeatureSite site{on == On::Corner ? FeatureId::corner(0, tip) : FeatureId::edge(0, tip),
                           cloth.state.mesh.material[near],
                           cloth.state.ids[near],
                           Vec3::UnitZ(),
                           on == On::EdgeAtBorder,
                           {near, near}};
    return find_feature_flow(cloth.scene, cloth.state, cloth.stars(), site);
}

/// The flow in both directions, as at a corner.
Vec2 flow_at_middle(const EolCloth& cloth)
{
    return flow_at(cloth, 0.2, 0.2, On::Corner);
}

/// Cloth that slides over the ridge at `speed` towards x > 0, each side along its own plane.
EolCloth sliding(double turn, double fold, double speed)
{
    EolCloth cloth(make_ridge(60.0), make_draped({8, turn, fold}));
    const double half = 0.5 * fold * std::numbers::pi / 180.0;
    for (std::size_t v = 0; v < cloth.state.ids.size(); ++v) {
        const double side = cloth.state.mesh.world[v].x() > 0.0 ? -1.0 : 1.0;
        cloth.state.velocity[v] = speed * Vec3(std::sin(half), 0.0, side * std::cos(half));
    }
    return cloth;
}

TEST(FeatureFlow, IsAgainstTheMotionOfFlatCloth)
{
    for (const double turn : {0.0, 17.0, 45.0, -100.0}) {
        const EolCloth cloth = sliding(turn, 180.0, 0.7);
        const double angle = turn * std::numbers::pi / 180.0;
        EXPECT_LT((flow_at_middle(cloth) + 0.7 * Vec2(std::cos(angle), -std::sin(angle))).norm(), kRoundOff);
    }
}

TEST(FeatureFlow, OverAnEdgeIsThatOfEitherSide)
{
    for (const double turn : {0.0, 30.0}) {
        const double angle = turn * std::numbers::pi / 180.0;
        const Vec2 across(std::cos(angle), -std::sin(angle));
        const Vec2 flow = flow_at_middle(sliding(turn, 90.0, 0.7));
        // On the mesh that is not turned, each vertex in the fold has the velocity of one side.
        EXPECT_LT(flow.dot(across), -0.4);
        EXPECT_LT(std::abs(across.x() * flow.y() - across.y() * flow.x()), 0.1);
    }
}

TEST(FeatureFlow, IsRelativeToTheObstacleAndCountsWhatFlowsAlready)
{
    EolCloth cloth(make_ridge(60.0), make_draped({8, 0.0, 180.0}));
    RigidMotion motion;
    motion.velocity = Vec3(0.3, 0.2, 0.1);
    const MovingObstacle still = make_ridge(60.0);
    cloth.scene.obstacles[0] = MovingObstacle("ridge", still.shape().mesh(), {}, motion, 30.0);
    EXPECT_LT((flow_at_middle(cloth) - Vec2(0.3, 0.2)).norm(), kRoundOff);
    for (Vec3& v : cloth.state.velocity) v = motion.velocity;
    EXPECT_LT(flow_at_middle(cloth).norm(), kRoundOff);
    // Vertices move with the obstacle while material flows through them.
    for (Vec2& V : cloth.state.material_velocity) V = Vec2(-0.4, 0.5);
    EXPECT_LT((flow_at_middle(cloth) - Vec2(-0.4, 0.5)).norm(), kRoundOff);
}

TEST(FeatureFlow, OfWhatSlidesAlongItsFeatureIsAcrossTheTraceOrAlongTheBorderAsMuch)
{
    for (const double turn : {0.0, 17.0, -40.0}) {
        EolCloth cloth(make_ridge(60.0), make_draped({8, turn, 180.0}));
        for (Vec3& v : cloth.state.velocity) v = Vec3(0.7, 0.4, 0.0);
        const double angle = turn * std::numbers::pi / 180.0;
        const Vec2 across(std::cos(angle), -std::sin(angle)), along(std::sin(angle), std::cos(angle));
        EXPECT_LT((flow_at(cloth, 0.2, 0.2, On::Edge) + 0.7 * across).norm(), kRoundOff) << turn;
        EXPECT_LT((flow_at(cloth, 0.2, 0.2, On::Corner) + 0.7 * across + 0.4 * along).norm(), kRoundOff)
            << turn;
        const Vec2 at_border = flow_at(cloth, 0.2, 0.0, On::EdgeAtBorder);
        EXPECT_LT(std::abs(at_border.y()), kRoundOff) << turn;
        EXPECT_NEAR(at_border.dot(across), -0.7, kRoundOff) << turn;
    }
}

TEST(FeatureFlow, OfCollapsedClothIsNone)
{
    EolCloth cloth = sliding(0.0, 180.0, 1.0);
    for (Vec3& x : cloth.state.mesh.world) x.setZero();
    for (const On on : {On::Edge, On::Corner}) EXPECT_EQ(flow_at(cloth, 0.2, 0.2, on), Vec2(0.0, 0.0));
}

}  // namespace
}  // namespace arris
