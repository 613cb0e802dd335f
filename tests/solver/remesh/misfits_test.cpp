// SPDX-License-Identifier: GPL-3.0-or-later
// Edges that miss their cells: which are tried, and how refused ones wait.
#include "solver/remesh/misfits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "geometry/cloth_input/cloth_grid.h"
#include "solver/advance.h"
#include "solver/model/settings.h"
#include "solver/remesh/sizing_field.h"
#include "solver/step.h"
#include "solver/workspace.h"

namespace arris {
namespace {

struct Sheet {
    Scene scene;
    State state;

    std::vector<std::array<VertexId, 2>> misfits() const
    {
        return find_misfits(scene, state, make_topology(state.mesh.vertex_count(), state.mesh.faces));
    }

    /// Ends a step that began with `misfits` and changed nothing.
    void refuse(const std::vector<std::array<VertexId, 2>>& misfits)
    {
        note_refused_edges(misfits, make_stars(state.mesh), state);
        state.step += kRemeshPeriod;
    }
};

/// A sheet of 1 m x 1 m whose material is mapped by `shape`, with cells of `length` (m) asked for.
Sheet make_sheet(int cells, float length, const std::function<Vec3(const Vec2&)>& shape)
{
    Sheet sheet;
    ClothGrid grid;
    grid.size = {1.0, 1.0};
    grid.resolution = {cells, cells};
    grid.pattern = GridPattern::Cross;
    ClothMesh mesh = make_cloth_grid(grid);
    for (std::size_t v = 0; v < mesh.world.size(); ++v) mesh.world[v] = shape(mesh.material[v]);
    sheet.scene.materials[0] = {0.15, 500.0, 0.3, 1e-4, 0.0, 1e-3};
    Remeshing remesh;
    remesh.shortest = 0.01;
    remesh.longest = 0.5;
    measure_first_mesh(mesh, remesh);
    sheet.scene.remesh = remesh;
    sheet.state = make_state(sheet.scene, std::move(mesh), Vec3::Zero());
    std::fill(sheet.state.sizing_field.begin(), sheet.state.sizing_field.end(), length);
    return sheet;
}

Vec3 flat(const Vec2& X)
{
    return {X.x(), X.y(), 0.0};
}

TEST(Misfits, AreNoMoreLongEdgesThanTheBudgetHasRoomFor)
{
    Sheet sheet = make_sheet(10, 0.01f, flat);
    const auto count = [&](int room) {
        sheet.scene.remesh->most_vertices = sheet.state.mesh.vertex_count() + room;
        return sheet.misfits().size();
    };
    EXPECT_EQ(count(5), 5u);
    EXPECT_EQ(count(0), 0u);
    EXPECT_EQ(count(-5), 0u);
    std::fill(sheet.state.sizing_field.begin(), sheet.state.sizing_field.end(), 0.35f);
    EXPECT_GT(count(-5), 0u) << "short edges give room";
}

TEST(Misfits, WaitLongerAfterEachRefusal)
{
    Sheet sheet = make_sheet(2, 0.01f, flat);
    const auto all = sheet.misfits();
    std::vector<std::int64_t> tried;
    for (int k = 0; k < 200; ++k) {
        const auto misfits = sheet.misfits();
        if (!misfits.empty()) {
            EXPECT_EQ(misfits, all);
            tried.push_back(sheet.state.step);
        }
        sheet.refuse(misfits);
    }
    // Waits double from 8 steps up to 128.
    EXPECT_EQ(tried, (std::vector<std::int64_t>{0, 8, 24, 56, 120, 248, 376, 504, 632, 760}));
}

TEST(Misfits, GiveWayToOthersWhileTheyWait)
{
    Sheet sheet = make_sheet(10, 0.01f, flat);
    const auto first = sheet.misfits();
    sheet.refuse(first);
    const auto second = sheet.misfits();
    EXPECT_EQ(first.size(), second.size());
    for (const auto& edge : second) EXPECT_EQ(std::count(first.begin(), first.end(), edge), 0);
}

TEST(Misfits, AreForgottenWithTheirEdges)
{
    Sheet sheet = make_sheet(10, 0.01f, flat);
    sheet.refuse(sheet.misfits());
    EXPECT_EQ(sheet.state.refused_edges.size(), 64u);
    for (std::uint32_t& id : sheet.state.ids) id += 10000;  // other vertices
    sheet.refuse({});
    EXPECT_TRUE(sheet.state.refused_edges.empty());
}

/// Takes steps of `dt` (s) and returns the operations of remeshing.
int advance(Sheet& sheet, int steps, double dt)
{
    Workspace work;
    int operations = 0;
    for (int k = 0; k < steps; ++k) {
        const StepReport report =
            step(sheet.scene, Settings{}, sheet.state.time + dt, sheet.state, work, Attempt::Ordinary);
        EXPECT_EQ(report.status, StepStatus::Done);
        operations += report.remeshed;
    }
    return operations;
}

/// A flat sheet with far more edges to merge than one step tries.
Sheet make_fine_sheet()
{
    return make_sheet(24, 0.3f, flat);
}

TEST(Remeshing, IsDoneByTheFirstPartOfAStepAlone)
{
    constexpr int kParts = 2 * kRemeshPeriod + 1;
    constexpr double kStep = 0.005;
    Sheet sheet = make_fine_sheet();
    Workspace work;
    const PlannedStep planned = {0.0, kStep};
    for (int k = 1; k <= kParts; ++k) {
        const double end = k < kParts ? kStep * k / kParts : kStep;
        EXPECT_EQ(sheet.state.step, 0) << k;
        EXPECT_FALSE(sheet.misfits().empty()) << k << ": edges remain to be merged";
        const StepReport report =
            make_part(sheet.scene, Settings{}, planned, end, sheet.state, work, Attempt::Ordinary);
        ASSERT_EQ(report.status, StepStatus::Done);
        EXPECT_EQ(report.remeshed > 0, k == 1) << k;
    }
    EXPECT_EQ(sheet.state.step, 1);
}

TEST(Remeshing, GoesByPlannedStepsHoweverManyPartsTheyAreMadeIn)
{
    constexpr double kStep = 0.005;
    Sheet sheet = make_fine_sheet();
    Workspace work;
    for (int k = 0; k <= 2 * kRemeshPeriod; ++k) {
        restart(sheet.state);  // each step is made in two parts
        std::vector<int> remeshed;
        const auto failed = arris::advance(sheet.scene, Settings{}, kStep * (k + 1), sheet.state, work,
                                           [&](const StepReport& report, bool) {
                                               remeshed.push_back(report.remeshed);
                                               return true;
                                           });
        ASSERT_FALSE(failed);
        ASSERT_EQ(remeshed.size(), 2u);
        EXPECT_EQ(remeshed[0] > 0, k % kRemeshPeriod == 0) << k;
        EXPECT_EQ(remeshed[1], 0) << k;
        EXPECT_EQ(sheet.state.step, k + 1);
    }
}

// A sheet folded in half, in two layers that rest on each other. Its lower half is held, so that none of the
// edges there can be merged: there are more of them than a step tries.
TEST(Misfits, ThatAreRefusedDoNotKeepFoldedClothFromBecomingCoarser)
{
    constexpr double kGap = 2e-3;  // m, between the layers
    Sheet sheet = make_sheet(16, 0.3f, [](const Vec2& X) {
        const double from_fold = X.x() - 0.5;
        return Vec3(-std::abs(from_fold), X.y(),
                    std::abs(from_fold) < 1e-9 ? 0.5 * kGap : (from_fold < 0.0 ? 0.0 : kGap));
    });
    sheet.scene.self_contact = ClothContact{1e-3};
    Pin pin;
    pin.material = {Vec2(0.0, 0.0), Vec2(0.5, 1.0)};
    sheet.scene.pins = {pin};
    const auto count_upper = [&] {
        return std::count_if(sheet.state.mesh.material.begin(), sheet.state.mesh.material.end(),
                             [](const Vec2& X) { return X.x() > 0.501; });
    };
    sheet.state = make_state(sheet.scene, std::move(sheet.state.mesh), Vec3::Zero());
    std::fill(sheet.state.sizing_field.begin(), sheet.state.sizing_field.end(), 0.3f);
    const auto before = count_upper();
    advance(sheet, 60, 0.005);
    EXPECT_LT(10 * count_upper(), 6 * before) << "others are near the fold";
    EXPECT_FALSE(sheet.state.refused_edges.empty());
}

}  // namespace
}  // namespace arris
