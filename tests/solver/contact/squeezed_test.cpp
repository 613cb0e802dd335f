// SPDX-License-Identifier: GPL-3.0-or-later
// Cloth squeezed between planes: which contacts press as springs, with which stiffness, and down to where.
// Planes and points are placed by hand, and the expected results are written out.
#include "solver/contact/squeezed.h"

#include <gtest/gtest.h>

namespace arris {
namespace {

constexpr double kThickness = 1e-3, kModulus = 2e4, kArea = 3e-4;

/// Vertices near obstacles at rest, at the start of a step.
struct Setting {
    Prediction prediction;
    Carriers steps;
    std::vector<Contact> contacts;
    Cushion cushion;

    Setting(const std::vector<Vec3>& at, int obstacles)
    {
        prediction.gamma = 0.005;
        prediction.position = at;
        prediction.velocity.assign(at.size(), Vec3::Zero());
        Carrier carrier;
        carrier.motion.begin = carrier.motion.end = carrier.reference = at;
        steps.obstacles.assign(static_cast<std::size_t>(obstacles), carrier);
        cushion = {std::vector<double>(at.size(), kModulus), std::vector<double>(at.size(), kArea)};
    }

    void add(int obstacle, const std::array<int, 3>& vertices, const Vec3& normal, const Vec3& point)
    {
        ObstacleContact contact;
        contact.vertices = vertices;
        contact.weights = vertices[1] < 0 ? std::array{1.0, 0.0, 0.0} : std::array{0.5, 0.5, 0.0};
        contact.kind = vertices[1] < 0 ? ContactKind::Vertex : ContactKind::Edge;
        contact.element = 0;
        contact.normal = normal.normalized();
        contact.point = point;
        contact.least_gap = kThickness;
        contacts.push_back(place_contact(contact, obstacle, kThickness, steps, prediction));
    }

    Squeezed squeeze() { return squeeze_contacts(cushion, steps, prediction, contacts); }
};

/// A vertex between a floor at z = 0 and a lid at z = `room`.
Setting make_gap(double room, double place)
{
    Setting gap({Vec3(3, 4, place)}, 2);
    gap.add(0, {0, -1, -1}, Vec3::UnitZ(), Vec3::Zero());
    gap.add(1, {0, -1, -1}, -Vec3::UnitZ(), Vec3(0, 0, room));
    return gap;
}

TEST(Squeezed, PressesWithTheModulusTimesTheAreaWhereTwoStandOffsHaveNoRoom)
{
    for (const double room : {1.9e-3, 1e-3, 3e-4}) {
        Setting gap = make_gap(room, 0.4 * room);
        const Squeezed squeezed = gap.squeeze();
        EXPECT_TRUE(squeezed.is_changed);
        EXPECT_FALSE(squeezed.overconstrained);
        for (const Contact& contact : gap.contacts) {
            EXPECT_NEAR(contact.stiffness * kThickness, kModulus * kArea, 1e-12 * kModulus * kArea);
            EXPECT_EQ(contact.least_gap, kThickness) << "no force there";
        }
        EXPECT_NEAR(gap.contacts[0].gap, 0.4 * room - kThickness, 1e-15);
        EXPECT_FALSE(gap.squeeze().is_changed) << "squeezed already";
    }
}

TEST(Squeezed, LeavesContactsWithRoomAsTheyAre)
{
    Setting gap = make_gap(2.1e-3, 1e-3);
    EXPECT_FALSE(gap.squeeze().is_changed);
    EXPECT_FALSE(gap.contacts[0].is_squeezed());
    Setting two({Vec3(0, 0, 5e-4), Vec3(0, 0, 5e-4)}, 2);
    two.add(0, {0, -1, -1}, Vec3::UnitZ(), Vec3::Zero());
    two.add(1, {1, -1, -1}, -Vec3::UnitZ(), Vec3(0, 0, 1e-3));
    EXPECT_FALSE(two.squeeze().is_changed) << "two vertices";
    Setting corner({Vec3(0, 0, 5e-4)}, 2);
    corner.add(0, {0, -1, -1}, Vec3::UnitZ(), Vec3::Zero());
    corner.add(1, {0, -1, -1}, Vec3::UnitX(), Vec3::Zero());
    EXPECT_FALSE(corner.squeeze().is_changed) << "a corner";
}

TEST(Squeezed, AnEdgeStaysSqueezedWhereItWasButAVertexNeedsItsOppositeContact)
{
    Setting one({Vec3(0, 0, 8e-4), Vec3(0.02, 0, 8e-4)}, 1);
    one.add(0, {0, 1, -1}, Vec3::UnitZ(), Vec3::Zero());
    EXPECT_FALSE(one.squeeze().is_changed);
    one.contacts[0].was_squeezed = true;
    EXPECT_TRUE(one.squeeze().is_changed);
    EXPECT_TRUE(one.contacts[0].is_squeezed());
    Setting left({Vec3(0, 0, 8e-4)}, 1);
    left.add(0, {0, -1, -1}, Vec3::UnitZ(), Vec3::Zero());
    left.contacts[0].was_squeezed = true;
    EXPECT_FALSE(left.squeeze().is_changed);
}

TEST(Squeezed, AVertexTakesThePlaneOfItsSqueezedEdgeAtTheRim)
{
    Setting rim({Vec3(0, 0, 8e-4), Vec3(0.02, 0, 5e-4)}, 1);
    rim.add(0, {0, -1, -1}, Vec3(-0.8, 0, 0.6), Vec3::Zero());
    rim.add(0, {0, 1, -1}, Vec3::UnitZ(), Vec3(1e-3, 0, 0));
    EXPECT_FALSE(rim.squeeze().is_changed);
    rim.contacts[1].was_squeezed = true;
    EXPECT_TRUE(rim.squeeze().is_changed);
    EXPECT_TRUE(rim.contacts[0].is_squeezed());
    EXPECT_EQ(rim.contacts[0].normal, Vec3::UnitZ());
    // Far from the vertex its plane says nothing about the room there.
    const std::vector<Vec3> below = {Vec3(0, 0, 1e-5), Vec3(0.02, 0, 5e-4)};
    const std::vector<Contact> floors = find_floors(rim.steps, rim.prediction, rim.contacts, below);
    for (const Contact& floor : floors) EXPECT_FALSE(floor.is_vertex());
}

TEST(Squeezed, AVertexTakesThePlaneOfTheEdgeThatPressesNearest)
{
    Setting rim({Vec3(0, 0, 8e-4), Vec3(0.02, 0, 5e-4), Vec3(0, 0.02, 5e-4)}, 1);
    rim.add(0, {0, -1, -1}, Vec3(-0.8, 0, 0.6), Vec3::Zero());
    rim.add(0, {0, 1, -1}, Vec3(0.1, 0, 1), Vec3(1e-2, 0, 0));
    rim.add(0, {0, 2, -1}, Vec3(0, 0.1, 1), Vec3(0, 1e-2, 0));
    rim.contacts[2].weights = {0.7, 0.3, 0.0, 0.0};
    rim.contacts[1].was_squeezed = rim.contacts[2].was_squeezed = true;
    rim.squeeze();
    EXPECT_EQ(rim.contacts[0].normal, rim.contacts[2].normal);
}

TEST(Squeezed, AnEdgePressesOnAStripAsWideAsTheClothIsThick)
{
    Setting gap({Vec3(0, 0, 5e-4), Vec3(0.02, 0, 5e-4)}, 2);
    gap.add(0, {0, 1, -1}, Vec3::UnitZ(), Vec3::Zero());
    gap.add(1, {0, 1, -1}, -Vec3::UnitZ(), Vec3(0, 0, 1e-3));
    EXPECT_TRUE(gap.squeeze().is_changed);
    EXPECT_NEAR(gap.contacts[0].stiffness, kModulus * std::sqrt(kArea), 1e-9);
}

TEST(Squeezed, NamesAVertexWithLessRoomThanTheLeastThickness)
{
    for (const double room : {3.9e-5, 0.0, -1e-3}) {
        const Squeezed squeezed = make_gap(room, 0.5 * room).squeeze();
        ASSERT_TRUE(squeezed.overconstrained) << room;
        EXPECT_EQ(*squeezed.overconstrained, 0);
    }
    Setting wedge({Vec3::Zero()}, 2);
    wedge.add(0, {0, -1, -1}, Vec3::UnitZ(), Vec3::Zero());
    wedge.add(1, {0, -1, -1}, Vec3(0.1, 0, -1), Vec3::Zero());
    const Squeezed squeezed = wedge.squeeze();
    EXPECT_TRUE(squeezed.is_changed);
    EXPECT_FALSE(squeezed.overconstrained) << "the vertex may slip out sideways";
}

TEST(Squeezed, KeepsTheLeastThicknessOnce)
{
    Setting gap = make_gap(1e-3, 5e-4);
    gap.squeeze();
    const std::vector<Vec3> thick = {Vec3(3, 4, 2.1e-5)}, thin = {Vec3(3, 4, 1.9e-5)};
    EXPECT_TRUE(find_floors(gap.steps, gap.prediction, gap.contacts, thick).empty());
    EXPECT_TRUE(list_too_thin(gap.steps, gap.contacts, thick).empty());
    gap.contacts[0].row = 7;
    EXPECT_EQ(list_too_thin(gap.steps, gap.contacts, thin), std::vector<int>{7});
    const std::vector<Contact> floors = find_floors(gap.steps, gap.prediction, gap.contacts, thin);
    ASSERT_EQ(floors.size(), 1u);
    EXPECT_FALSE(floors[0].is_squeezed());
    EXPECT_NEAR(floors[0].least_gap, 2e-5, 1e-18);
    EXPECT_NEAR(floors[0].gap, 4.8e-4, 1e-15);
    gap.contacts.push_back(floors[0]);
    EXPECT_TRUE(find_floors(gap.steps, gap.prediction, gap.contacts, thin).empty());
    EXPECT_FALSE(gap.squeeze().is_changed) << "the floor stays a constraint";
}

TEST(Squeezed, ExpectsAFloorWhereTheStepBeginsNearIt)
{
    for (const double place : {3.9e-5, 4.1e-5}) {
        Setting gap = make_gap(1e-3, place);
        gap.squeeze();
        EXPECT_EQ(expect_floors(gap.steps, gap.prediction, gap.contacts).size(), place < 4e-5 ? 1u : 0u);
    }
}

TEST(Squeezed, WhatPressesAgainstSqueezedClothIsSqueezed)
{
    // The lid's contact with the edge has half a thickness of room against the vertex's with the floor.
    Setting gap({Vec3(0, 0, 5e-4), Vec3(0.02, 0, 5e-4)}, 2);
    gap.add(0, {0, -1, -1}, Vec3::UnitZ(), Vec3::Zero());
    gap.add(1, {0, -1, -1}, -Vec3::UnitZ(), Vec3(0, 0, 1e-3));
    gap.add(1, {0, 1, -1}, Vec3(0.01, 0, -1), Vec3(0.01, 0, 1e-3));
    gap.add(0, {1, -1, -1}, Vec3(0.01, 0, 1), Vec3(0.02, 0, -1e-3));
    gap.squeeze();
    EXPECT_TRUE(gap.contacts[2].is_squeezed());
    EXPECT_FALSE(gap.contacts[3].is_squeezed()) << "the other vertex has room";
}

TEST(Squeezed, StoresTheEnergyOfItsSprings)
{
    Setting gap = make_gap(1e-3, 5e-4);
    gap.squeeze();
    // 1/2 E A / t of (6e-4)^2 + (4e-4)^2 less twice (5e-4)^2
    const double stored = energy_stored(gap.steps, gap.contacts, {Vec3(3, 4, 4e-4)});
    EXPECT_NEAR(stored, 0.5 * kModulus * kArea / kThickness * 2e-8, 1e-12 * stored);
}

}  // namespace
}  // namespace arris
