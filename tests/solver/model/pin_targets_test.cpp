// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/model/pin_targets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "solver/advance.h"
#include "solver/eol/stop_flow.h"
#include "solver/step.h"
#include "tests/solver/eol_cloth.h"

namespace arris {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kStart = 0.1;      // s
constexpr double kStepSize = 0.01;  // s
constexpr double kRounding = 1e-14;

/// A square of 1 m that falls freely, and a pin at its left side.
struct Falling {
    Scene scene;
    State state;
    Workspace work;

    explicit Falling(const std::vector<Pin>& pins)
    {
        scene.materials[0] = {0.05, 50.0, 0.3, 1e-5, 0.0, 1e-3};
        scene.gravity = Gravity{};
        scene.pins = pins;
        ClothGrid grid;
        grid.size = {1, 1};
        grid.resolution = {4, 4};
        state = make_state(scene, make_cloth_grid(grid), Vec3(0.3, 0.0, 0.0));
    }

    /// Steps until `end` as a run does: jumps of the input drop the history.
    void advance(double end)
    {
        while (state.time < end - 1e-9) {
            const double next = kStepSize * std::round(state.time / kStepSize + 1.0);
            for (const double jump : input_jumps(scene))
                if (std::abs(state.time - jump) < 1e-9) restart(state);
            const auto accept = [](const StepReport&, bool) { return true; };
            ASSERT_FALSE(arris::advance(scene, Settings(), next, state, work, accept)) << state.time;
        }
    }

    std::vector<int> left() const { return vertices_inside(state.mesh, {Vec2(0, 0), Vec2(0, 1)}); }
};

Pin late_pin()
{
    Pin pin;
    pin.material = {Vec2(0, 0), Vec2(0, 1)};
    pin.start = kStart;
    return pin;
}

TEST(PinStart, LeavesTheClothFreeBefore)
{
    Falling free({}), pinned({late_pin()});
    free.advance(kStart);
    pinned.advance(kStart);
    EXPECT_EQ(free.state.mesh.world, pinned.state.mesh.world);
    EXPECT_EQ(free.state.velocity, pinned.state.velocity) << "the pin stops the cloth in the next step";
}

TEST(PinStart, IsAJumpOfTheInput)
{
    Pin pin = late_pin();
    pin.release = 0.5;
    EXPECT_THAT(input_jumps(Falling({pin}).scene), ElementsAre(kStart, 0.5));
}

TEST(PinStart, HoldsVerticesWhereTheyAreThen)
{
    Falling run({late_pin()});
    run.advance(kStart);
    const std::vector<Vec3> then = run.state.mesh.world;
    EXPECT_LT(then[0].z(), -0.03) << "the cloth has fallen";
    run.advance(0.3);
    for (const int v : run.left()) EXPECT_LT((run.state.mesh.world[v] - then[v]).norm(), kRounding);
    for (int v = 0; v < run.state.mesh.vertex_count(); ++v) {
        if (then[v] == run.state.mesh.world[v]) continue;
        EXPECT_GT(run.state.mesh.material[v].x(), 0.0);
    }
}

TEST(PinStart, MovesThemFromThereByItsVelocities)
{
    Pin pin = late_pin();
    pin.motion.start = kStart;
    pin.motion.velocity = Vec3(0, 0, 1);
    pin.motion.angular_velocity = Vec3(0, 0, 2);
    pin.motion.pivot = Vec3(0.5, 0.5, 0);
    Falling run({pin});
    run.advance(kStart);
    const std::vector<Vec3> then = run.state.mesh.world;
    run.advance(0.3);
    const Mat3 turn = rotation_about(Vec3::UnitZ(), 0.4 * 180.0 / M_PI);
    for (const int v : run.left()) {
        const Vec3 exact = pin.motion.pivot + Vec3(0, 0, 0.2) + turn * (then[v] - pin.motion.pivot);
        EXPECT_LT((run.state.mesh.world[v] - exact).norm(), kRounding);
    }
}

TEST(PinStart, MovesThemFromThereByKeyframesAtAbsoluteTimes)
{
    Pin pin = late_pin();
    pin.motion.keyframes = {{0.0, Vec3(7, 0, 0), Eigen::Quaterniond::Identity()},
                            {0.2, Vec3(8, 0, 0), Eigen::Quaterniond(rotation_about(Vec3::UnitZ(), 90.0))}};
    Falling run({pin});
    run.advance(kStart);
    const std::vector<Vec3> then = run.state.mesh.world;
    run.advance(0.3);
    // From half of the way on: x(t) = P(t) P(start)^-1 x(start).
    const Placement halfway{rotation_about(Vec3::UnitZ(), 45.0), Vec3(7.5, 0, 0)};
    for (const int v : run.left()) {
        const Vec3 exact = Vec3(8, 0, 0) + rotation_about(Vec3::UnitZ(), 90.0) * halfway.inverse(then[v]);
        EXPECT_LT((run.state.mesh.world[v] - exact).norm(), 10 * kRounding);
    }
}

TEST(PinStart, RidesOnAnObstacleFromThere)
{
    Pin pin = late_pin();
    pin.follows = 0;
    Falling run({});
    RigidMotion motion;
    motion.velocity = Vec3(0, 1, 0);
    motion.angular_velocity = Vec3(1, 0, 0);
    run.scene.obstacles = {
        MovingObstacle("far", make_box({1, 1, 1}), {Mat3::Identity(), Vec3(0, 0, 9)}, motion, 30)};
    run.scene.pins = {pin};
    run.advance(kStart);
    const std::vector<Vec3> then = run.state.mesh.world;
    run.advance(0.2);
    const Placement way = motion.at(0.2) * motion.at(kStart).inverse();
    for (const int v : run.left()) EXPECT_LT((run.state.mesh.world[v] - way(then[v])).norm(), 10 * kRounding);
}

TEST(PinStart, TakesTheNearestVertexWhereTheBoxHasNone)
{
    Pin pin = late_pin();
    pin.material = {Vec2(0.76, 0.99), Vec2(0.8, 0.995)};
    Falling run({pin});
    run.advance(kStart);
    ASSERT_EQ(run.state.anchors.size(), 1u);
    const int v = run.state.index_of(run.state.anchors[0].vertex_id);
    EXPECT_EQ(run.state.mesh.material[v], Vec2(0.75, 1.0));
    const Vec3 then = run.state.mesh.world[v];
    run.advance(0.2);
    EXPECT_LT((run.state.mesh.world[v] - then).norm(), kRounding);
}

TEST(PinStart, HasNoAnchorsBeforeAndAfter)
{
    Pin pin = late_pin();
    pin.release = 0.2;
    Falling run({pin});
    EXPECT_THAT(run.state.anchors, IsEmpty());
    run.advance(0.15);
    EXPECT_EQ(run.state.anchors.size(), run.left().size());
    run.advance(0.2);
    EXPECT_THAT(run.state.anchors, IsEmpty());
}

TEST(PinRelease, LeavesVerticesToTheOtherPinWhereTheyAre)
{
    // The second pin carries the left side away from the place where the first one has held it.
    Pin first = late_pin(), second = late_pin();
    first.start = 0.0;
    second.release = 0.3;
    second.motion.start = kStart;
    second.motion.velocity = Vec3(2, 0, 0);
    Falling run({first, second});
    run.advance(0.3);
    const std::vector<Vec3> then = run.state.mesh.world;
    for (const int v : run.left()) EXPECT_NEAR(then[v].x(), 0.4, kRounding);
    run.advance(0.4);
    for (const int v : run.left()) EXPECT_LT((run.state.mesh.world[v] - then[v]).norm(), kRounding);
}

// ---- EOL vertices

using namespace arris::testing;

/// Cloth over a ridge, with two EOL vertices on it through which material flows; a pin over one of them.
struct Ridden {
    EolCloth cloth{make_ridge(60.0), make_draped({})};
    int held, other;

    Ridden() : held(cloth.vertex_at(0.2, 0.2)), other(cloth.vertex_at(0.2, 0.3))
    {
        for (const int v : {held, other}) {
            cloth.add_eol(v, false, tip_of(cloth.scene.obstacles[0].shape()));
            cloth.state.material_velocity[v] = Vec2(0.5, 0.0);
        }
        Pin pin;
        const Vec2& X = cloth.state.mesh.material[held];
        pin.material = {X, X};
        cloth.scene.pins = {pin};
    }
};

TEST(ReleasePinned, MakesEolVerticesThatAPinHoldsOrdinary)
{
    Ridden on;
    State& state = on.cloth.state;
    state.previous_dt = 0.01;
    release_pinned(on.cloth.scene, on.cloth.stars(), state);
    EXPECT_LT(state.eol_entry(state.ids[on.held]), 0);
    EXPECT_GE(state.eol_entry(state.ids[on.other]), 0);
    EXPECT_TRUE(state.material_velocity[on.held].isZero());
    EXPECT_FALSE(state.material_velocity[on.other].isZero());
    // The material beside the fold moves against the flow, down on one side and up on the other.
    EXPECT_NEAR(state.velocity[on.held].x(), -0.5 * std::sin(M_PI / 4.0), 1e-12);
    EXPECT_NEAR(state.velocity[on.held].z(), 0.0, 1e-12);
    EXPECT_EQ(state.previous_world[on.held],
              Vec3(state.mesh.world[on.held] - 0.01 * state.velocity[on.held]));
}

TEST(ReleasePinned, WaitsForThePinsStart)
{
    Ridden on;
    on.cloth.scene.pins[0].start = 1.0;
    release_pinned(on.cloth.scene, on.cloth.stars(), on.cloth.state);
    EXPECT_EQ(on.cloth.state.eol.size(), 2u);
}

TEST(PinnedCloth, GetsNoEolVertices)
{
    EolCloth free = lying(0.0, 0.003);
    press_edges(free);
    EolCloth pinned = free;
    pinned.scene.pins = {Pin{.material = {Vec2(0.0, 0.0), Vec2(0.4, 0.2)}, .motion = {}}};
    const ConformedMesh of_free = take(free), of_pinned = take(pinned);
    const auto in_box = [&](const EolCloth& cloth) {
        int count = 0;
        for (const EolVertex& e : cloth.state.eol)
            count += cloth.state.mesh.material[cloth.state.index_of(e.vertex_id)].y() <= 0.2 ? 1 : 0;
        return count;
    };
    EXPECT_GT(in_box(free), 2);
    EXPECT_EQ(in_box(pinned), 0);
    EXPECT_GT(pinned.state.eol.size(), 2u) << "beside the box";
}

}  // namespace
}  // namespace arris
