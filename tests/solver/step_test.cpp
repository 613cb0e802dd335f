// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/step.h"
#include "solver/advance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/cloth_input/cloth_grid.h"
#include "physics/forces/inertia.h"
#include "tests/solver/floor.h"

namespace arris {
namespace {

ClothMesh make_sheet(Vec2 size, std::array<int, 2> resolution, GridPattern pattern = GridPattern::Cross)
{
    ClothGrid grid;
    grid.size = size;
    grid.resolution = resolution;
    grid.pattern = pattern;
    return make_cloth_grid(grid);
}

Material soft_cloth()
{
    return {0.05, 50.0, 0.3, 1e-5, 0.0, 1e-3};
}

/// Steps of equal length until `end`.
void advance(const Scene& scene, const Settings& settings, double end, State& state, Workspace& work)
{
    const double begin = state.time;
    const int steps = static_cast<int>(std::ceil((end - begin) / settings.step - 1e-9));
    for (int k = 1; k <= steps; ++k) {
        const StepReport report = step(scene, settings, begin + (end - begin) * k / steps, state, work);
        ASSERT_EQ(report.status, StepStatus::Done);
        ASSERT_LE(report.kkt_residual, settings.tolerance);
    }
}

TEST(Step, FreeFallIsTheParabola)
{
    Scene scene;
    scene.materials[0] = soft_cloth();
    scene.gravity = Gravity{};
    for (const Integrator integrator : {Integrator::ImplicitEuler, Integrator::Bdf2}) {
        Settings settings;
        settings.integrator = integrator;
        State state = make_state(scene, make_sheet(Vec2(1, 1), {4, 4}), Vec3(1.0, 0.0, 2.0));
        Workspace work;
        const Vec3 start = state.mesh.world[7];
        advance(scene, settings, 0.5, state, work);
        const Vec3 exact = start + Vec3(0.5, 0.0, 1.0 - 0.5 * 9.81 * 0.25);
        // Implicit Euler falls g h t / 2 too far. BDF2 falls h^2 g / 2 too far, all in its first step.
        const double h = settings.step;
        const double lag = integrator == Integrator::Bdf2 ? 9.81 * h * h : 0.5 * 9.81 * h * 0.5;
        EXPECT_LT((state.mesh.world[7] - exact).norm(), 1.01 * lag);
        const Vec3 momentum = linear_momentum(Material{0.05}, work.mesh.elements, state.velocity);
        EXPECT_LT((momentum - 0.05 * Vec3(1.0, 0.0, 2.0 - 9.81 * 0.5)).norm(), 1e-13);
    }
}

/// A sheet held along one edge that falls onto a floor: pins, contacts, history.
Scene make_draped_scene()
{
    Scene scene;
    scene.materials[0] = soft_cloth();
    scene.gravity = Gravity{};
    scene.obstacles.push_back(make_floor());
    Pin pin;
    pin.material = {Vec2(0, 0), Vec2(0, 1)};
    scene.pins = {pin};
    return scene;
}

ClothMesh make_raised_sheet()
{
    ClothMesh mesh = make_sheet(Vec2(1, 1), {8, 8});
    for (Vec3& x : mesh.world) x.z() = 0.05 + 0.01 * std::sin(9.0 * x.x() + 4.0 * x.y());
    return mesh;
}

void expect_same(const State& a, const State& b)
{
    EXPECT_TRUE(a.mesh.world == b.mesh.world);
    EXPECT_TRUE(a.velocity == b.velocity);
    EXPECT_TRUE(a.previous_world == b.previous_world);
    ASSERT_EQ(a.active.size(), b.active.size());
    for (std::size_t k = 0; k < a.active.size(); ++k) {
        EXPECT_EQ(a.active[k].vertex_ids, b.active[k].vertex_ids);
        EXPECT_EQ(a.active[k].multiplier, b.active[k].multiplier);
    }
}

TEST(Step, ClearingTheWorkspaceChangesNothing)
{
    const Scene scene = make_draped_scene();
    const Settings settings;
    State kept = make_state(scene, make_raised_sheet(), Vec3::Zero()), cleared = kept;
    Workspace work;
    for (int k = 1; k <= 60; ++k) {
        step(scene, settings, 0.005 * k, kept, work);
        Workspace fresh;
        step(scene, settings, 0.005 * k, cleared, fresh);
        ASSERT_NO_FATAL_FAILURE(expect_same(kept, cleared));
    }
    EXPECT_GT(kept.active.size(), 10u) << "the sheet lies on the floor";
}

TEST(Step, AFailedStepLeavesTheStateAsItWas)
{
    const Scene scene = make_draped_scene();
    State state = make_state(scene, make_raised_sheet(), Vec3::Zero());
    Workspace work;
    advance(scene, Settings(), 0.1, state, work);
    Scene broken = make_draped_scene();
    broken.gravity->acceleration.z() = std::numeric_limits<double>::quiet_NaN();
    Workspace broken_work;
    const State before = state;
    EXPECT_EQ(step(broken, Settings(), 0.105, state, broken_work).status, StepStatus::NotFinite);
    EXPECT_EQ(state.time, before.time);
    EXPECT_EQ(state.step, before.step);
    expect_same(state, before);
}

int calls_left = 0;  // of an interrupt that comes after so many questions

TEST(Step, InterruptedAnywhereLeavesTheStateAsItWas)
{
    Scene scene;
    scene.materials[0] = soft_cloth();
    scene.gravity = Gravity{};
    Settings settings;
    settings.is_interrupted = [] { return calls_left-- <= 0; };
    State state = make_state(scene, make_sheet(Vec2(1, 1), {4, 4}), Vec3::Zero());
    Workspace work;
    const std::vector<Vec3> before = state.mesh.world;
    bool is_done = false;
    int questions = 0;
    for (; !is_done && questions < 100; ++questions) {
        calls_left = questions;
        try {
            EXPECT_EQ(step(scene, settings, 0.005, state, work).status, StepStatus::Done);
            is_done = true;
        } catch (const Interrupted&) {
            EXPECT_EQ(state.mesh.world, before);
            EXPECT_EQ(state.time, 0.0);
        }
    }
    EXPECT_TRUE(is_done);
    EXPECT_GT(questions, 2) << "a step asks before each solve and before each factorisation";
}

TEST(Step, PinsAreExactlyWhereTheirMotionSays)
{
    Scene scene;
    scene.materials[0] = soft_cloth();
    scene.gravity = Gravity{};
    Pin turning;
    turning.material = {Vec2(0, 0), Vec2(0, 1)};
    turning.motion.angular_velocity = Vec3(0, 0, 2);
    turning.motion.velocity = Vec3(0.1, 0, 0);
    turning.motion.pivot = Vec3(0, 0.5, 0);
    Pin sliding;  // holds z only
    sliding.material = {Vec2(1, 0), Vec2(1, 0)};
    sliding.held = {false, false, true};
    sliding.motion.velocity = Vec3(5, 5, 0.3);
    scene.pins = {turning, sliding};
    for (const Integrator integrator : {Integrator::ImplicitEuler, Integrator::Bdf2}) {
        Settings settings;
        settings.integrator = integrator;
        const ClothMesh mesh = make_sheet(Vec2(1, 1), {6, 6});
        State state = make_state(scene, mesh, Vec3::Zero());
        Workspace work;
        for (int k = 1; k <= 100; ++k) {
            ASSERT_EQ(step(scene, settings, 0.005 * k, state, work).status, StepStatus::Done);
            const Placement place = turning.motion.at(state.time);
            for (const int v : vertices_inside(mesh, turning.material))
                ASSERT_LT((state.mesh.world[v] - place(mesh.world[v])).norm(), 1e-13);
            const int corner = vertices_inside(mesh, sliding.material)[0];
            ASSERT_NEAR(state.mesh.world[corner].z(), 0.3 * state.time, 1e-14);
        }
        const int corner = vertices_inside(mesh, sliding.material)[0];
        EXPECT_GT((state.mesh.world[corner] - mesh.world[corner]).head<2>().norm(), 0.01)
            << "free in x and y";
    }
}

TEST(Step, APartlyHeldVertexFollowsItsPlaceAtTimeZero)
{
    // For held components x(t) = R x(0), independent of the free ones. After 90 degrees about z a point from
    // (1, 0) has x = 0, although y is free.
    Scene scene;
    scene.materials[0] = soft_cloth();
    scene.gravity = Gravity{Vec3(0, -3, -9.81)};
    Pin pin;
    pin.material = {Vec2(1, 0), Vec2(1, 0)};
    pin.held = {true, false, true};
    pin.motion.keyframes = {
        Keyframe{0.0, Vec3::Zero(), Eigen::Quaterniond::Identity()},
        Keyframe{1.0, Vec3::Zero(), Eigen::Quaterniond(rotation_about(Vec3::UnitZ(), 90.0))}};
    scene.pins = {pin};
    for (const double h : {0.005, 0.02}) {
        State state = make_state(scene, make_sheet(Vec2(1, 1), {4, 4}), Vec3::Zero());
        Workspace work;
        const int steps = static_cast<int>(std::lround(1.0 / h));
        for (int k = 1; k <= steps; ++k)
            ASSERT_EQ(step(scene, Settings(), static_cast<double>(k) / steps, state, work).status,
                      StepStatus::Done);
        const Vec3& x = state.mesh.world[vertices_inside(state.mesh, pin.material)[0]];
        EXPECT_NEAR(x.x(), 0.0, 1e-13);
        EXPECT_NEAR(x.z(), 0.0, 1e-13);
        EXPECT_GT(std::abs(x.y() - 1.0), 0.1) << "free";
    }
}

TEST(Step, KeyframesAtTimeZeroPlaceWhatTheyHold)
{
    Scene scene;
    scene.materials[0] = soft_cloth();
    Pin pin;
    pin.material = {Vec2(0, 0), Vec2(0, 1)};
    pin.motion.keyframes = {Keyframe{0.0, Vec3(0.5, 0, 0), Eigen::Quaterniond::Identity()},
                            Keyframe{1.0, Vec3(1.5, 0, 0), Eigen::Quaterniond::Identity()}};
    Pin over;  // is released at its start
    over.material = {Vec2(1, 0), Vec2(1, 1)};
    over.motion.velocity = Vec3(5, 0, 0);
    over.release = 0.0;
    scene.pins = {pin, over};
    const State state = make_state(scene, make_sheet(Vec2(1, 1), {2, 2}), Vec3::Zero());
    for (const int v : vertices_inside(state.mesh, pin.material)) {
        EXPECT_EQ(state.mesh.world[v].x(), 0.5);
        EXPECT_EQ(state.velocity[v], Vec3(1, 0, 0));
    }
    for (const int v : vertices_inside(state.mesh, over.material))
        EXPECT_EQ(state.velocity[v], Vec3(Vec3::Zero()));
}

TEST(Step, APinThatDrivesClothIntoTheFloorIsInfeasibleAndNamed)
{
    Scene scene = make_draped_scene();
    scene.pins[0].motion.velocity = Vec3(0, 0, -1);
    ClothMesh mesh = make_raised_sheet();
    State state = make_state(scene, mesh, Vec3::Zero());
    Workspace work;
    StepReport report;
    int k = 0;
    while (report.status == StepStatus::Done && k < 100)
        report = step(scene, Settings(), 0.005 * ++k, state, work);
    ASSERT_EQ(report.status, StepStatus::Infeasible);
    const std::vector<int> held = vertices_inside(mesh, scene.pins[0].material);
    EXPECT_TRUE(std::find(held.begin(), held.end(), report.infeasible.vertex) != held.end());
    EXPECT_EQ(report.infeasible.pin, 0);
    EXPECT_EQ(report.infeasible.obstacles, (std::array{0, -1}));
    // Held cloth may yield the stand-off, but not the surface.
    EXPECT_GE(state.mesh.world[report.infeasible.vertex].z(), 0.0);
    EXPECT_LT(state.mesh.world[report.infeasible.vertex].z(), 0.005);
}

TEST(Step, AVertexHeldSidewaysStillRestsOnATiltedFloor)
{
    // A vertex held in x meets a plane tilted about y. The component of the normal that is not held carries
    // the contact.
    Scene scene = make_draped_scene();
    const Vec3 normal(0.5, 0.0, std::sqrt(0.75));
    scene.obstacles = {make_floor(normal, -0.2)};
    scene.pins[0].held = {true, false, false};
    State state = make_state(scene, make_raised_sheet(), Vec3::Zero());
    Workspace work;
    for (int k = 1; k <= 200; ++k) {
        ASSERT_EQ(step(scene, Settings(), 0.005 * k, state, work).status, StepStatus::Done);
        for (const Vec3& x : state.mesh.world)
            ASSERT_GT(normal.dot(x) + 0.2 - scene.materials.thickness(), -1e-13);
    }
    bool is_held_vertex_in_contact = false;
    for (const int v : vertices_inside(state.mesh, scene.pins[0].material)) {
        EXPECT_NEAR(state.mesh.world[v].x(), 0.0, 1e-14);
        for (const ActiveContact& contact : state.active)
            is_held_vertex_in_contact = is_held_vertex_in_contact || contact.vertex_ids[0] == state.ids[v];
    }
    EXPECT_TRUE(is_held_vertex_in_contact);
}

TEST(Step, AStepMuchLongerThanTheLastOneIsImplicitEuler)
{
    const Scene scene = make_draped_scene();
    State state = make_state(scene, make_raised_sheet(), Vec3::Zero());
    state.previous_dt = 1e-3;
    EXPECT_TRUE(predict(state, Integrator::Bdf2, 2.4e-3).has_history);
    EXPECT_FALSE(predict(state, Integrator::Bdf2, 2.5e-3).has_history);
    EXPECT_FALSE(predict(state, Integrator::ImplicitEuler, 1e-3).has_history);
    restart(state);
    EXPECT_FALSE(predict(state, Integrator::Bdf2, 1e-3).has_history);
}

TEST(Advance, StartsWithAThirdOfAStepWhereBdf2HasNoPast)
{
    const Scene scene = make_draped_scene();
    for (const Integrator integrator : {Integrator::ImplicitEuler, Integrator::Bdf2}) {
        Settings settings;
        settings.integrator = integrator;
        State state = make_state(scene, make_raised_sheet(), Vec3::Zero());
        Workspace work;
        std::vector<double> parts;  // lengths of a step's parts
        const auto accept = [&](const StepReport& report, bool is_halved) {
            EXPECT_FALSE(is_halved);
            EXPECT_EQ(report.part == StepPart::Opening, report.dt < 0.5 * 0.005);
            parts.push_back(report.dt / 0.005);
            return true;
        };
        for (int k = 1; k <= 4; ++k) {
            if (k == 3) restart(state);
            ASSERT_FALSE(advance(scene, settings, 0.005 * k, state, work, accept));
            EXPECT_EQ(state.time, 0.005 * k);
        }
        const std::vector<double> expected = integrator == Integrator::Bdf2
                                                 ? std::vector{1.0 / 3, 2.0 / 3, 1.0, 1.0 / 3, 2.0 / 3, 1.0}
                                                 : std::vector(4, 1.0);
        ASSERT_EQ(parts.size(), expected.size());
        for (std::size_t k = 0; k < parts.size(); ++k) EXPECT_NEAR(parts[k], expected[k], 1e-9) << k;
    }
}

TEST(InputJumps, AreTheTimesAtWhichTheSceneChanges)
{
    Scene scene;
    Pin pin;
    pin.motion.velocity = Vec3(1, 0, 0);
    pin.motion.start = 0.5;
    pin.motion.stop = 0.75;
    pin.release = 1.5;
    Pin keyed;
    keyed.motion.keyframes = {Keyframe{0.0, Vec3::Zero(), Eigen::Quaterniond::Identity()},
                              Keyframe{0.5, Vec3::UnitX(), Eigen::Quaterniond::Identity()},
                              Keyframe{2.0, Vec3::Zero(), Eigen::Quaterniond::Identity()}};
    scene.pins = {pin, keyed};
    Pull pull;
    pull.start = 0.0;
    pull.stop = 1.0;
    scene.pulls = {pull};
    EXPECT_EQ(input_jumps(scene), (std::vector<double>{0.5, 0.75, 1.0, 1.5, 2.0}));
}

}  // namespace
}  // namespace arris
