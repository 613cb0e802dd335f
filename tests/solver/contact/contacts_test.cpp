// SPDX-License-Identifier: GPL-3.0-or-later
// Processing of contacts after the search: sharing of room, yielding stand-offs, flattening of history.
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

    SharedRoom share() { return share_room(steps, prediction, contacts); }
};

/// A vertex between a floor at z = 0 and a lid at z = `room`.
Setting make_gap(double room, double place)
{
    Setting gap({Vec3(3, 4, place)}, 2);
    gap.add(0, 0, Vec3::UnitZ(), Vec3::Zero());
    gap.add(1, 0, -Vec3::UnitZ(), Vec3(0, 0, room));
    return gap;
}

TEST(ShareRoom, LeavesPlanesThatHaveRoomForBothStandOffs)
{
    for (const double room : {2.1e-3, 0.1, 1e6}) {
        Setting gap = make_gap(room, 1e-3);
        EXPECT_FALSE(gap.share().is_changed) << room;
        for (const Contact& contact : gap.contacts) {
            EXPECT_EQ(contact.least_gap, kThickness);
            EXPECT_TRUE(contact.may_grow);
        }
    }
}

TEST(ShareRoom, DividesWhatThereIs)
{
    for (const double room : {2e-3, 1.5e-3, 1e-4, 1e-8})
        for (const double where : {0.1, 0.5, 0.9}) {
            Setting gap = make_gap(room, where * room);
            const SharedRoom shared = gap.share();
            EXPECT_TRUE(shared.is_changed);
            EXPECT_FALSE(shared.overconstrained) << room;
            double kept = 0.0;
            for (const Contact& contact : gap.contacts) {
                kept += contact.least_gap;
                EXPECT_GT(contact.least_gap, 0.49 * room);
                EXPECT_FALSE(contact.may_grow);
            }
            EXPECT_LT(kept, room) << "both can be kept at once";
            EXPECT_NEAR(gap.contacts[0].gap, where * room - gap.contacts[0].least_gap, kRoundOff);
            EXPECT_NEAR(gap.contacts[1].gap, (1.0 - where) * room - gap.contacts[1].least_gap, kRoundOff);
        }
}

TEST(ShareRoom, DividesInProportionToWhatEachWants)
{
    Setting gap({Vec3(0, 0, 5e-4)}, 2);
    gap.add(0, 0, Vec3::UnitZ(), Vec3::Zero(), 1e-3);
    gap.add(1, 0, -Vec3::UnitZ(), Vec3(0, 0, 1e-3), 5e-4);
    EXPECT_TRUE(gap.share().is_changed);
    EXPECT_NEAR(gap.contacts[0].least_gap / gap.contacts[1].least_gap, 2.0, 1e-12);
}

TEST(ShareRoom, NamesAVertexThatHasNone)
{
    for (const double room : {0.0, -1e-3, -10.0}) {
        Setting gap = make_gap(room, 0.5 * room);
        const SharedRoom shared = gap.share();
        ASSERT_TRUE(shared.overconstrained) << room;
        EXPECT_EQ(*shared.overconstrained, 0);
        for (const Contact& contact : gap.contacts) EXPECT_EQ(contact.least_gap, 0.0);
    }
}

TEST(ShareRoom, LetsAVertexSlipOutBetweenPlanesThatDoNotFaceEachOther)
{
    Setting wedge({Vec3::Zero()}, 2);
    wedge.add(0, 0, Vec3::UnitZ(), Vec3::Zero());
    wedge.add(1, 0, Vec3(0.3, 0, -1), Vec3::Zero());
    const SharedRoom shared = wedge.share();
    EXPECT_TRUE(shared.is_changed);
    EXPECT_FALSE(shared.overconstrained);
}

TEST(ShareRoom, IsOfOneVertexAndOfNormalsThatOppose)
{
    Setting two({Vec3(0, 0, 5e-4), Vec3(0, 0, 5e-4)}, 2);
    two.add(0, 0, Vec3::UnitZ(), Vec3::Zero());
    two.add(1, 1, -Vec3::UnitZ(), Vec3(0, 0, 1e-3));
    EXPECT_FALSE(two.share().is_changed) << "two vertices";
    Setting corner({Vec3(0, 0, 5e-4)}, 2);
    corner.add(0, 0, Vec3::UnitZ(), Vec3::Zero());
    corner.add(1, 0, Vec3::UnitX(), Vec3::Zero());
    EXPECT_FALSE(corner.share().is_changed) << "a corner";
    EXPECT_FALSE(Setting({}, 0).share().is_changed) << "nothing";
}

TEST(YieldStandOff, KeepsTheGapThereIsThenHalves)
{
    Setting near({Vec3(0, 0, 4e-4)}, 1);
    near.add(0, 0, Vec3::UnitZ(), Vec3::Zero());
    Contact& contact = near.contacts[0];
    EXPECT_TRUE(yield_stand_off(near.steps, near.prediction, contact));
    EXPECT_NEAR(contact.least_gap, 4e-4, kRoundOff);
    EXPECT_NEAR(contact.gap, 0.0, kRoundOff) << "riding on the obstacle keeps it";
    EXPECT_FALSE(contact.may_grow);
    EXPECT_TRUE(yield_stand_off(near.steps, near.prediction, contact));
    EXPECT_NEAR(contact.least_gap, 2e-4, kRoundOff);
    EXPECT_NEAR(contact.gap, 2e-4, kRoundOff);
}

TEST(YieldStandOff, EndsWithTheSurfaceKept)
{
    for (const double place : {0.5, 1e-3, 1e-5, 1e-7}) {
        Setting one({Vec3(0, 0, place)}, 1);
        one.add(0, 0, Vec3::UnitZ(), Vec3::Zero());
        int times = 0;
        while (yield_stand_off(one.steps, one.prediction, one.contacts[0])) ASSERT_LT(++times, 20);
        EXPECT_GT(times, 0);
        EXPECT_GT(one.contacts[0].least_gap, 0.0) << place;
        EXPECT_LE(one.contacts[0].least_gap, 1e-3 * kThickness);
    }
}

TEST(YieldStandOff, RefusesWhatKeepsNothing)
{
    for (const double least : {0.0, -1e-3, 1e-7, std::numeric_limits<double>::quiet_NaN()}) {
        Setting one({Vec3(0, 0, 0.1)}, 1);
        one.add(0, 0, Vec3::UnitZ(), Vec3::Zero(), least);
        EXPECT_FALSE(yield_stand_off(one.steps, one.prediction, one.contacts[0])) << least;
    }
}

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
        carrier.motion.begin = to_frame(carrier.begin, state.mesh.world);
        carrier.motion.end = to_frame(carrier.end, prediction.position);
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
