// SPDX-License-Identifier: GPL-3.0-or-later
// A NaN in each stage of a step: the step says so, names what has it, and leaves the state as it was.
#include "solver/not_finite.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "geometry/cloth_input/cloth_grid.h"
#include "solver/advance.h"
#include "solver/step.h"
#include "tests/solver/floor.h"

namespace arris {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr int kVertex = 12;  // in the middle of the sheet

/// A sheet that lies on a floor, with a history of two steps.
class NotFiniteStep : public testing::Test {
  protected:
    NotFiniteStep()
    {
        scene.materials[0] = {0.05, 50.0, 0.3, 1e-5, 0.0, 1e-3};
        scene.gravity = Gravity{};
        scene.obstacles.push_back(make_floor());
        ClothGrid grid;
        grid.resolution = {4, 4};
        grid.pattern = GridPattern::Diagonal;
        ClothMesh mesh = make_cloth_grid(grid);
        for (Vec3& x : mesh.world) x.z() = scene.materials.thickness();
        state = make_state(scene, mesh, Vec3::Zero());
        for (const double end : {0.005, 0.01})
            EXPECT_EQ(step(scene, Settings(), end, state, work).status, StepStatus::Done);
    }

    NotFinite find(const Settings& settings = {})
    {
        const State before = state;
        const StepReport report = step(scene, settings, 0.015, state, work);
        EXPECT_EQ(report.status, StepStatus::NotFinite);
        EXPECT_EQ(state.step, before.step);
        EXPECT_EQ(state.time, before.time);
        return report.not_finite;
    }

    /// What a step finds where `spoil` is called at the start of its first solve (`question` 0) or within it.
    NotFinite find_after(int question, const std::function<void(Workspace&)>& spoil)
    {
        spoiler = [this, question, spoil, asked = 0]() mutable {
            if (asked++ == question) spoil(work);
        };
        Settings settings;
        settings.is_interrupted = [] {
            spoiler();
            return false;
        };
        return find(settings);
    }

    static void expect(const NotFinite& found, const char* what, int vertex)
    {
        EXPECT_STREQ(found.what, what);
        EXPECT_EQ(found.vertex, vertex);
    }

    static std::function<void()> spoiler;
    Scene scene;
    State state;
    Workspace work;
};

std::function<void()> NotFiniteStep::spoiler;

TEST_F(NotFiniteStep, NamesTheVertexOfTheState)
{
    state.mesh.world[kVertex].y() = kNan;
    expect(find(), "position", kVertex);
}

TEST_F(NotFiniteStep, NamesTheVertexOfTheMaterial)
{
    state.mesh.material[kVertex].x() = kNan;
    expect(find(), "material position", kVertex);
}

TEST_F(NotFiniteStep, NamesTheVertexWhoseHistoryPredictsNothing)
{
    state.previous_world[kVertex].z() = kNan;
    expect(find(), "predicted position", kVertex);
}

TEST_F(NotFiniteStep, NamesTheVertexAndPinWithoutATarget)
{
    Pin still, lost;
    still.material = {Vec2(0, 0), Vec2(0, 0)};
    lost.material = {Vec2(0.5, 0.5), Vec2(0.5, 0.5)};
    scene.pins = {still, lost};
    attach_pins(scene, state);
    scene.pins[1].motion.velocity.x() = kNan;
    const NotFinite found = find();
    expect(found, "pin's target", kVertex);
    EXPECT_EQ(found.pin, 1);
}

// No finite input is known to give such a contact, so the contact of a sound step is spoilt.
TEST_F(NotFiniteStep, NamesTheVertexAndObstacleOfAContact)
{
    ASSERT_FALSE(work.contacts.empty());
    EXPECT_EQ(find_not_finite(CheckedStage::Contacts, state, work).what, nullptr);
    work.contacts.back().gap = kNan;
    const NotFinite found = find_not_finite(CheckedStage::Contacts, state, work);
    expect(found, "contact", work.contacts.back().vertices[0]);
    EXPECT_EQ(found.obstacle, 0);
}

TEST_F(NotFiniteStep, NamesTheVertexOfAForce)
{
    Pull pull;
    pull.material = {Vec2(0.5, 0.5), Vec2(0.5, 0.5)};
    pull.force = Vec3(0.0, kNan, 0.0);
    scene.pulls = {pull};
    work = Workspace();
    expect(find(), "force", kVertex);
}

TEST_F(NotFiniteStep, NamesTheVertexWhereForcesAreLinearised)
{
    const NotFinite found = find_after(0, [](Workspace& w) { w.expansion.world[kVertex].z() = kNan; });
    EXPECT_THAT(found.what, testing::AnyOf(testing::StrEq("force"), testing::StrEq("stiffness")));
    EXPECT_GE(found.vertex, 0);
}

// As above, of a sound step.
TEST_F(NotFiniteStep, NamesTheVertexAndObstacleOfAConstraint)
{
    ConstraintRow row;
    row.coordinate[0] = 3 * kVertex;
    row.coefficient[0] = 1.0;
    row.count = 1;
    Contact& contact = work.contacts.back();
    contact.row = static_cast<int>(work.problem.rows.size());
    work.problem.rows.push_back(row);
    expect(find_not_finite(CheckedStage::Solve, state, work), "velocity", -1);
    work.problem.rows.back().coefficient[0] = kNan;
    const NotFinite found = find_not_finite(CheckedStage::Solve, state, work);
    expect(found, "contact's constraint", contact.vertices[0]);
    EXPECT_EQ(found.obstacle, 0);
}

TEST_F(NotFiniteStep, NamesTheVertexAndObstacleOfFriction)
{
    scene.friction = Friction{{0.3}};
    const auto active = std::find_if(state.active.begin(), state.active.end(),
                                     [](const ActiveContact& a) { return a.vertex_ids[0] == kVertex; });
    ASSERT_NE(active, state.active.end());
    active->friction.force.x() = kNan;
    const NotFinite found = find();
    expect(found, "friction", kVertex);
    EXPECT_EQ(found.obstacle, 0);
}

TEST_F(NotFiniteStep, NamesTheVertexOfTheProposal)
{
    const NotFinite found = find_after(1, [](Workspace& w) { w.linearization.drift[kVertex].x() = kNan; });
    expect(found, "new position", kVertex);
}

TEST_F(NotFiniteStep, EveryAttemptEndsAndTheStateIsKept)
{
    state.mesh.world[kVertex].y() = kNan;
    const auto accept = [](const StepReport&, bool) { return true; };
    const std::optional<StepReport> failed = advance(scene, Settings(), 0.015, state, work, accept);
    ASSERT_TRUE(failed);
    EXPECT_EQ(failed->status, StepStatus::NotFinite);
    expect(failed->not_finite, "position", kVertex);
}

}  // namespace
}  // namespace arris
