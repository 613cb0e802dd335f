// SPDX-License-Identifier: GPL-3.0-or-later
// Corrections of a proposal outside the velocity solve: pushing out to the stand-off, and rewinding.
#include "solver/contact/proposal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/check/penetration.h"
#include "geometry/cloth/mesh_topology.h"
#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "solver/step.h"

namespace arris {
namespace {

constexpr double kStep = 0.005, kThickness = 1e-3;

/// A sheet 0.4 m wide, 5 mm over a plate of 0.2 m and 1 mm whose upper side is z = 0, before a step.
struct Above {
    Scene scene;
    State state;
    std::vector<MeshEdge> edges;
    Prediction prediction;
    std::vector<PinTarget> held;
    Carriers steps;
    Proposal proposal;

    explicit Above(const RigidMotion& motion = {}, const Placement& place = {})
    {
        scene.materials[0] = {0.05, 50.0, 0.3, 1e-5, 0.0, kThickness};
        const Placement plate = place * Placement{Mat3::Identity(), Vec3(0, 0, -0.5e-3)};
        scene.obstacles.push_back(MovingObstacle("plate", make_box({0.2, 0.2, 1e-3}), plate, motion, 30.0));
        ClothGrid grid;
        grid.size = {0.4, 0.4};
        grid.resolution = {8, 8};
        ClothMesh mesh = make_cloth_grid(grid);
        for (Vec3& x : mesh.world) x = place(x + Vec3(-0.2, -0.2, 0.005));
        state = make_state(scene, std::move(mesh), Vec3::Zero());
        edges = make_topology(state.mesh.vertex_count(), state.mesh.faces).edges;
        prediction = predict(state, Integrator::ImplicitEuler, kStep);
        steps = move_obstacles(scene, state, edges, prediction, held, kStep);
        proposal.world = state.mesh.world;
        proposal.velocity = state.velocity;
    }

    void propose(const Vec3& change)
    {
        for (std::size_t v = 0; v < proposal.world.size(); ++v) {
            proposal.world[v] = state.mesh.world[v] + change;
            proposal.velocity[v] = change / kStep;
        }
    }

    std::optional<int> put_back()
    {
        return rewind(scene, state, {}, held, prediction, kStep, steps, proposal);
    }

    bool is_clean() { return check_proposal(scene, state, {}, proposal, prediction, steps).is_clean(); }

    void expect_free() const
    {
        const std::vector<Vec3> end = to_local(scene.obstacles[0].at(kStep).placement, proposal.world);
        EXPECT_FALSE(find_penetration(scene.obstacles[0].shape(), end, state.mesh.faces).is_any());
    }
};

TEST(Rewind, LeavesACleanProposal)
{
    Above above;
    above.propose(Vec3(0.1, 0, 0.2));
    const Proposal before = above.proposal;
    EXPECT_EQ(above.put_back(), 0);
    EXPECT_EQ(above.proposal.world, before.world);
    EXPECT_EQ(above.proposal.velocity, before.velocity);
}

TEST(Rewind, PutsBackWhatPassedAPlate)
{
    const Placement far{rotation_about(Vec3(1, 2, 3), 40.0), Vec3(1e3, -2e3, 5e2)};
    for (const Placement& place : {Placement(), far})
        for (const double down : {0.006, 0.05, 3.0}) {  // into the plate, through it, far beyond it
            Above above({}, place);
            above.propose(place.rotation * Vec3(0, 0, -down));
            ASSERT_FALSE(above.is_clean());
            const std::optional<int> rewound = above.put_back();
            ASSERT_TRUE(rewound) << down;
            EXPECT_GT(*rewound, 0);
            EXPECT_TRUE(above.is_clean());
            above.expect_free();
            int moved = 0;
            for (std::size_t v = 0; v < above.proposal.world.size(); ++v) {
                const Vec3 way = above.proposal.world[v] - above.state.mesh.world[v];
                const double share = way.norm() / down;
                constexpr double kRoundOff = 1e-12;  // positions are about 1e3 m
                EXPECT_LT((way / kStep - above.proposal.velocity[v]).norm(), kRoundOff / kStep);
                moved += std::abs(share - 1.0) > 1e-6;
                const Vec3 local = place.inverse(above.state.mesh.world[v]);
                if (local.head<2>().cwiseAbs().maxCoeff() < 0.09) {
                    EXPECT_LT(share * down, 0.005);
                }
            }
            EXPECT_EQ(moved, *rewound);
        }
}

TEST(Rewind, LeavesClothThatIsNowhereNear)
{
    Above above;
    above.propose(Vec3(0, 0, -0.006));
    ASSERT_TRUE(above.put_back());
    for (std::size_t v = 0; v < above.proposal.world.size(); ++v)
        if (above.state.mesh.world[v].head<2>().cwiseAbs().maxCoeff() > 0.19) {
            EXPECT_NEAR(above.proposal.world[v].z(), -0.001, 1e-15) << "beyond the patch it goes on";
        }
}

TEST(Rewind, RidesOnAPlateThatComesUp)
{
    RigidMotion up;
    up.velocity = Vec3(0, 0, 10.0);  // 5 cm in the step, through the sheet at rest
    Above above(up);
    ASSERT_FALSE(above.is_clean());
    ASSERT_TRUE(above.put_back());
    EXPECT_TRUE(above.is_clean());
    above.expect_free();
    double highest = 0.0;
    for (const Vec3& x : above.proposal.world) highest = std::max(highest, x.z());
    EXPECT_GT(highest, 0.05) << "the plate's upper side";
    EXPECT_LT(highest, 0.055 + 1e-12) << "where it was, in the plate's frame";
}

TEST(Rewind, CannotMoveWhatIsPinned)
{
    Above above;
    above.propose(Vec3(0, 0, -0.05));
    for (int v = 0; v < above.state.mesh.vertex_count(); ++v)
        above.held.push_back({v, {true, true, true}, above.proposal.world[static_cast<std::size_t>(v)]});
    const Proposal before = above.proposal;
    EXPECT_EQ(above.put_back(), std::nullopt);
    EXPECT_EQ(above.proposal.world, before.world);
}

TEST(CheckProposal, NamesWhatWouldHavePreventedIt)
{
    Above above;
    above.propose(Vec3(0, 0, -0.05));
    const Violations violations =
        check_proposal(above.scene, above.state, {}, above.proposal, above.prediction, above.steps);
    EXPECT_GT(violations.crossings, 0);
    ASSERT_FALSE(violations.contacts.empty());
    for (const Contact& contact : violations.contacts) {
        EXPECT_EQ(contact.obstacle, 0);
        const double end =
            contact.normal.dot(contact.at(above.proposal.world) - above.steps[0].end(contact.local_point));
        EXPECT_LT(end, contact.least_gap) << "the end violates it";
    }
}

/// One vertex `gap` above the plane z = 0, and its contact.
struct OverPlane {
    Carriers steps{{Carrier()}, {}};
    std::vector<Contact> contacts;
    Proposal proposal;

    OverPlane(double gap, double least_gap)
    {
        Prediction prediction;
        prediction.position = proposal.world = {Vec3(0.3, 0.4, gap)};
        proposal.velocity = {Vec3(0, 0, -1)};
        ObstacleContact contact;
        contact.vertices = {0, -1, -1};
        contact.weights = {1.0, 0.0, 0.0};
        contact.kind = ContactKind::Vertex;
        contact.element = 0;
        contact.normal = Vec3::UnitZ();
        contact.point = Vec3::Zero();
        contact.least_gap = least_gap;
        contacts = {place_contact(contact, 0, kThickness, steps, prediction)};
    }

    double restore(double growth, const std::vector<PinTarget>& held = {})
    {
        restore_stand_off(contacts, steps, {1.0}, growth, proposal.world);
        hold_in_place(held, proposal.world);
        EXPECT_EQ(proposal.velocity[0], Vec3(0, 0, -1)) << "never through the velocity";
        return proposal.world[0].z();
    }
};

TEST(RestoreStandOff, MendsWhatIsMissingAndGrowsNoFurtherThanTheThickness)
{
    constexpr double kRoundOff = 1e-18;  // m
    EXPECT_NEAR(OverPlane(5e-4 - 1e-12, 5e-4).restore(0.0), 5e-4, kRoundOff);
    EXPECT_NEAR(OverPlane(5e-4, 5e-4).restore(1e-4), 6e-4, kRoundOff);
    EXPECT_NEAR(OverPlane(9.5e-4, 9.5e-4).restore(1e-4), kThickness, kRoundOff);
    EXPECT_EQ(OverPlane(0.7, 5e-4).restore(1e-4), 0.7) << "never pulled in";
}

TEST(RestoreStandOff, LeavesWhatMayNotGrowOrIsPinned)
{
    OverPlane kept(5e-4, 5e-4);
    kept.contacts[0].may_grow = false;
    EXPECT_EQ(kept.restore(1e-4), 5e-4);
    const Vec3 target(0, 0, 5e-4);
    EXPECT_EQ(OverPlane(5e-4, 5e-4).restore(1e-4, {{0, {false, false, true}, target}}), 5e-4);
    EXPECT_GT(OverPlane(5e-4, 5e-4).restore(1e-4, {{0, {true, true, false}, target}}), 5e-4);
}

}  // namespace
}  // namespace arris
