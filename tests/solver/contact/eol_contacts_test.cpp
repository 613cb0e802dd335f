// SPDX-License-Identifier: GPL-3.0-or-later
// The bound of an EOL vertex replaces rows that would hold the vertex a second time. Contacts elsewhere keep
// their rows.
#include "solver/contact/eol_contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/contact/contact_plane.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "tests/solver/eol_cloth.h"

namespace arris {
namespace {

constexpr double kRoundOff = 1e-15;  // m: for values of about 1

TEST(EolContacts, WhatIsOnItsWayOutIsNotHeldToItsSpeed)
{
    // On a ridge of 60 degrees the stand-off is two thicknesses; the vertex is one thickness away.
    for (const double outward : {-0.1, 0.0, 0.1, 10.0}) {
        testing::EolCloth cloth = testing::lying(0.0, 0.5 * testing::kLyingCell);
        for (Vec3& v : cloth.state.velocity) v = Vec3(0.0, 0.0, outward);
        const auto& world = cloth.state.mesh.world;
        const auto on_tip = std::find_if(world.begin(), world.end(), [](const Vec3& x) {
            return std::abs(x.x()) < 1e-9 && std::abs(x.y()) < 0.1;
        });
        ASSERT_NE(on_tip, world.end());
        cloth.add_eol(static_cast<int>(on_tip - world.begin()), false,
                      testing::tip_of(cloth.scene.obstacles[0].shape()));
        const std::vector<MeshEdge> edges = testing::edges_of(cloth.state);
        const Prediction prediction = predict(cloth.state, Integrator::Bdf2, 0.005);
        Carriers steps = move_obstacles(cloth.scene, cloth.state, edges, prediction, {}, 0.005);
        std::vector<Contact> contacts =
            find_contacts_with_obstacles(cloth.scene, cloth.state, prediction, steps);
        ASSERT_EQ(add_eol_contacts(cloth.scene, cloth.state, cloth.stars(), prediction, prediction.gamma,
                                   steps, contacts)
                      .size(),
                  1u);
        const auto bound = std::find_if(contacts.begin(), contacts.end(),
                                        [](const Contact& contact) { return contact.eol == 0; });
        ASSERT_NE(bound, contacts.end());
        EXPECT_NEAR(bound->least_gap, testing::kThickness, kRoundOff) << outward;
        EXPECT_NEAR(bound->gap, 0.0, kRoundOff) << "it may stay where it is";
    }
}

TEST(EolContacts, GoAlongWithAVertexThatSlidesAlongItsFeature)
{
    // In the step the vertex slides four stand-offs along its feature. No row at the new place may hold the
    // vertex a second time.
    for (const bool is_wire : {false, true}) {
        testing::EolCloth cloth = testing::lying(0.0, 0.5 * testing::kLyingCell);
        if (is_wire) {
            cloth.scene.obstacles.clear();
            cloth.scene.obstacles.push_back(MovingObstacle(
                "wire", make_wire({{0, -0.5, 0}, {0, 0, 0}, {0, 0.5, 0}}, false), {}, {}, 30.0));
        }
        for (Vec3& v : cloth.state.velocity) v = Vec3(0.0, 0.8, 0.0);
        const auto& world = cloth.state.mesh.world;
        for (std::size_t v = 0; v < world.size(); ++v)
            if (std::abs(world[v].x()) < 1e-9 && std::abs(world[v].y()) < 0.1)
                cloth.add_eol(static_cast<int>(v), false,
                              is_wire ? (world[v].y() > 0.0 ? 1 : 0)
                                      : testing::tip_of(cloth.scene.obstacles[0].shape()));
        ASSERT_GT(cloth.state.eol.size(), 2u);
        const std::vector<MeshEdge> edges = testing::edges_of(cloth.state);
        const Prediction prediction = predict(cloth.state, Integrator::Bdf2, 0.005);
        Carriers steps = move_obstacles(cloth.scene, cloth.state, edges, prediction, {}, 0.005);
        std::vector<Contact> contacts =
            find_contacts_with_obstacles(cloth.scene, cloth.state, prediction, steps);
        add_eol_contacts(cloth.scene, cloth.state, cloth.stars(), prediction, prediction.gamma, steps,
                         contacts);
        for (const Contact& contact : contacts)
            EXPECT_TRUE(contact.eol >= 0 || !contact.is_vertex() ||
                        cloth.state.eol_entry(cloth.state.ids[contact.vertices[0]]) < 0)
                << (is_wire ? "wire" : "ridge") << ", at " << contact.local_point.y();
    }
}

TEST(EolContacts, OnAWiresEndCoverItsShaftOnlyNearby)
{
    // Cloth hangs from the wire's end and swings against the wire. A contact far below the end needs a row of
    // its own.
    for (const double below : {0.005, 0.1}) {
        testing::EolCloth cloth(
            MovingObstacle("needle", make_wire({Vec3::Zero(), {0.0, 0.0, -1.0}}, false), {}, {}, 30.0),
            testing::make_draped({8, 0.0, 20.0}));
        State& state = cloth.state;
        const int v = cloth.vertex_at(0.2, 0.2);
        state.mesh.world[v].z() = testing::kThickness;
        cloth.add_eol(v, true, 0);
        const Prediction prediction = predict(state, Integrator::Bdf2, 0.005);
        const std::vector<MeshEdge> edges = testing::edges_of(state);
        Carriers steps = move_obstacles(cloth.scene, state, edges, prediction, {}, 0.005);
        const int w = state.mesh.faces[cloth.stars().faces[v].front()][0] == v
                          ? state.mesh.faces[cloth.stars().faces[v].front()][1]
                          : state.mesh.faces[cloth.stars().faces[v].front()][0];
        const ObstacleContact at_shaft =
            make_contact(ContactKind::Edge, {{std::min(v, w), std::max(v, w), -1}, {0.5, 0.5, 0.0}}, 0,
                         Vec3::UnitX(), Vec3(0.0, 0.0, -below), testing::kThickness);
        std::vector<Contact> contacts = {place_contact(at_shaft, 0, testing::kThickness, steps, prediction)};
        ASSERT_EQ(
            add_eol_contacts(cloth.scene, state, cloth.stars(), prediction, 0.0, steps, contacts).size(), 1u);
        const auto is_row = [](const Contact& contact) { return !contact.is_vertex(); };
        EXPECT_EQ(std::any_of(contacts.begin(), contacts.end(), is_row), below > 0.01) << below;
    }
}

}  // namespace
}  // namespace arris
