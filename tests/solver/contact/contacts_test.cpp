// SPDX-License-Identifier: GPL-3.0-or-later
// Processing of contacts after the search: flattening of history.
// Planes and points are placed by hand, and the expected results are written out.
#include "solver/contact/contacts.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "solver/contact/contact_history.h"
#include "tests/solver/floor.h"

namespace arris {
namespace {

constexpr double kThickness = 1e-3;
constexpr double kRoundOff = 1e-15;  // m, m/s: for values of about 1

/// Vertices near obstacles at rest (unless a motion is given), at the start of a step.
struct Setting {
    Prediction prediction;
    Carriers steps;
    std::vector<Contact> contacts;

    Setting(const std::vector<Vec3>& at, int obstacles)
    {
        prediction.gamma = 0.005;
        prediction.position = at;
        prediction.velocity.assign(at.size(), Vec3::Zero());
        Carrier carrier;
        carrier.motion.begin = carrier.motion.end = carrier.reference = at;
        steps.obstacles.assign(static_cast<std::size_t>(obstacles), carrier);
    }

    void add(int obstacle, int vertex, const Vec3& normal, const Vec3& point, double least_gap = kThickness)
    {
        ObstacleContact contact;
        contact.vertices = {vertex, -1, -1};
        contact.weights = {1.0, 0.0, 0.0};
        contact.kind = ContactKind::Vertex;
        contact.element = 0;
        contact.normal = normal.normalized();
        contact.point = point;
        contact.least_gap = least_gap;
        contacts.push_back(place_contact(contact, obstacle, kThickness, steps, prediction));
    }
};

/// A vertex that met a floor in the last step. It came down at 2 m/s while moving along at 3 m/s. Now it is
/// at its stand-off and still moves along. The floor's upper side is z = 0 at the step's start.
struct Landed {
    static constexpr double kStep = 0.005, kDown = 2.0, kAlong = 3.0;
    Scene scene;
    State state;
    Prediction prediction;
    Carriers steps;
    std::vector<Contact> contacts;

    Landed(const Landed&) = delete;  // the carrier refers to the obstacle
    explicit Landed(double rising = 0.0, Integrator integrator = Integrator::Bdf2)
    {
        RigidMotion motion;
        motion.velocity = Vec3(0, 0, rising);
        const Vec3 at(0, 0, -rising * kStep);  // the floor is at z = 0 at the state's time
        scene.obstacles.push_back(
            MovingObstacle("floor", make_floor().shape().mesh(), {Mat3::Identity(), at}, motion, 30));
        const Vec3 now(0.2, 0, kThickness);
        state.time = state.previous_dt = kStep;
        state.mesh.world = {now, now};
        state.velocity = {Vec3(kAlong, 0, rising), Vec3(kAlong, 0, rising)};
        const Vec3 before = now + kStep * Vec3(-kAlong, 0, kDown);
        state.previous_world = {before, before};
        state.previous_velocity = {Vec3(kAlong, 0, -kDown), Vec3(kAlong, 0, -kDown)};
        prediction = predict(state, integrator, kStep);
        Carrier carrier;
        carrier.obstacle = scene.obstacles[0].at(2.0 * kStep).shape;
        carrier.moving = &scene.obstacles[0];
        carrier.time = kStep;
        carrier.before = scene.obstacles[0].at(0.0).placement;
        carrier.begin = scene.obstacles[0].at(kStep).placement;
        carrier.end = scene.obstacles[0].at(2.0 * kStep).placement;
        carrier.motion.begin = to_local(carrier.begin, state.mesh.world);
        carrier.motion.end = to_local(carrier.end, prediction.position);
        steps.obstacles = {carrier};
    }

    void touch(const std::array<double, 2>& weights, bool was_active)
    {
        ObstacleContact contact;
        contact.kind = weights[1] > 0.0 ? ContactKind::Edge : ContactKind::Vertex;
        contact.vertices = {0, weights[1] > 0.0 ? 1 : -1, -1};
        contact.weights = {weights[0], weights[1], 0.0};
        contact.element = 0;
        contact.normal = Vec3::UnitZ();
        contact.point = Vec3(0, 0, 0);
        contact.least_gap = kThickness;
        contacts.push_back(place_contact(contact, 0, kThickness, steps, prediction));
        contacts.back().last_multiplier = was_active ? 1.0 : 0.0;
    }

    bool flatten(std::size_t first = 0)
    {
        const std::vector<double> mobility(state.mesh.world.size(), 1.0);
        if (!flatten_history(state, steps, {}, mobility, first, contacts, prediction)) return false;
        update_gaps(steps, prediction, contacts);
        return true;
    }
};

TEST(FlattenHistory, StopsWhatWouldBeExtrapolatedThroughAndLeavesTheRest)
{
    for (const bool was_active : {false, true}) {
        Landed landed;
        landed.touch({1.0, 0.0}, was_active);
        const Vec3 q = landed.prediction.position[0], v = landed.prediction.velocity[0];
        ASSERT_LT(landed.contacts[0].gap, -1e-3) << "a third of the last step's way, into the floor";
        EXPECT_TRUE(landed.flatten());
        EXPECT_NEAR(landed.prediction.position[0].z(), kThickness, kRoundOff);
        EXPECT_NEAR(landed.prediction.velocity[0].z(), 0.0, kRoundOff);
        EXPECT_NEAR(landed.contacts[0].gap, 0.0, kRoundOff);
        EXPECT_EQ(landed.prediction.position[0].head<2>(), q.head<2>()) << "tangential history stays";
        EXPECT_EQ(landed.prediction.velocity[0].head<2>(), v.head<2>());
        EXPECT_LT(landed.prediction.position[1].z(), 0.0) << "the other vertex has no contact";
    }
}

TEST(FlattenHistory, IsRelativeToAnObstacleThatMoves)
{
    for (const double rising : {1.5, -0.5}) {
        Landed landed(rising);
        landed.touch({1.0, 0.0}, true);
        EXPECT_TRUE(landed.flatten());
        // The result is that of riding on the floor for two steps: x + (x - x_before) / 3, with both
        // positions on the floor.
        EXPECT_NEAR(landed.prediction.position[0].z(), kThickness + rising * Landed::kStep / 3.0, kRoundOff);
        EXPECT_NEAR(landed.prediction.velocity[0].z(), rising, kRoundOff);
    }
}

TEST(FlattenHistory, LeavesWhatStaysOutOrIsOnItsWayOut)
{
    Landed high;
    for (Vec3& x : high.steps.obstacles[0].motion.begin) x.z() += 1.0;
    high.touch({1.0, 0.0}, false);
    Landed leaving;
    for (Vec3& x : leaving.steps.obstacles[0].motion.end) x.z() = 0.1;
    leaving.touch({1.0, 0.0}, false);
    Landed euler(0.0, Integrator::ImplicitEuler);
    euler.touch({1.0, 0.0}, true);
    for (Landed* landed : {&high, &leaving, &euler}) {
        const std::vector<Vec3> q = landed->prediction.position, v = landed->prediction.velocity;
        EXPECT_FALSE(landed->flatten());
        EXPECT_EQ(landed->prediction.position, q);
        EXPECT_EQ(landed->prediction.velocity, v);
    }
}

TEST(FlattenHistory, OfARowIsTheLeastChangeOfItsVertices)
{
    Landed landed;
    landed.touch({0.25, 0.75}, true);
    const std::vector<Vec3> q = landed.prediction.position;
    EXPECT_TRUE(landed.flatten());
    const double moved[2] = {landed.prediction.position[0].z() - q[0].z(),
                             landed.prediction.position[1].z() - q[1].z()};
    EXPECT_NEAR(0.25 * landed.prediction.position[0].z() + 0.75 * landed.prediction.position[1].z(),
                kThickness, kRoundOff);
    EXPECT_NEAR(moved[1] / moved[0], 3.0, 1e-12);
}

TEST(FlattenHistory, OnlyOfContactsFromTheFirstOn)
{
    Landed landed;
    landed.touch({1.0, 0.0}, true);
    landed.touch({1.0, 0.0}, true);
    ASSERT_TRUE(landed.flatten(1));
    for (const Contact& contact : landed.contacts) EXPECT_NEAR(contact.gap, 0.0, kRoundOff);
    EXPECT_FALSE(landed.flatten(2));
}

}  // namespace
}  // namespace arris
