// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh_change/step_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "solver/mesh_change/mesh_transfer.h"
#include "solver/mesh_change/strain_allowance.h"
#include "tests/solver/eol_cloth.h"

namespace arris {
namespace {

using testing::EolCloth;
using testing::kLyingCell;
using testing::kStep;
using testing::lying;
using testing::press_edges;

/// A trace half a cell beside a raised row of vertices, as in a pleat, with a pin behind the row. Merging the
/// row into the trace would shorten the cloth by 5 %. The trace flows towards the row by a quarter of a cell
/// a step.
EolCloth heading_for_pleat(double youngs_modulus)
{
    EolCloth cloth = lying(0.0);
    cloth.scene.gravity = Gravity{};
    cloth.scene.materials[0].youngs_modulus = youngs_modulus;
    press_edges(cloth);
    testing::take(cloth);

    Pin pin;
    pin.material = {Vec2(4.9 * kLyingCell, 0.0), Vec2(0.4, 0.4)};
    cloth.scene.pins = {pin};
    constexpr double kHeight = 0.2;  // cells
    const double before = 0.5 - std::sqrt(0.25 - kHeight * kHeight);
    const double behind = 1.0 - std::sqrt(1.0 - kHeight * kHeight);
    for (std::size_t v = 0; v < cloth.state.mesh.world.size(); ++v) {
        const double u = cloth.state.mesh.material[v].x() / kLyingCell;
        if (u < 3.6) continue;
        const bool is_pleat = u < 4.5;
        cloth.state.mesh.world[v].x() -= (is_pleat ? before : before + behind) * kLyingCell;
        if (is_pleat) cloth.state.mesh.world[v].z() += kHeight * kLyingCell;
    }
    for (const EolVertex& e : cloth.state.eol)
        cloth.state.material_velocity[cloth.state.index_of(e.vertex_id)] =
            Vec2(0.25 * kLyingCell / kStep, 0.0);
    press_edges(cloth);
    return cloth;
}

TEST(StepMesh, AVertexWhoseWayCannotBeClearedBecomesARow)
{
    for (const double youngs_modulus : {200.0, 800.0}) {
        EolCloth cloth = heading_for_pleat(youngs_modulus);
        MeshCache cache;
        update_mesh_cache(cloth.scene, cloth.state, cache);
        StepReport report;
        const std::size_t eol = cloth.state.eol.size();
        ASSERT_GT(eol, 6u);
        const State& start =
            choose_step_mesh(cloth.scene, {cloth.state.time, cloth.state.time + kStep},
                             cloth.state.time + kStep, FailedFlow(), cloth.state, cache, report)
                .start;
        EXPECT_GT(std::count_if(cache.refused.begin(), cache.refused.end(),
                                [](const RefusedContact& refused) {
                                    return refused.cause == ConstraintCause::Blocked;
                                }),
                  0);
        EXPECT_LT(start.eol.size(), eol);
    }
}

constexpr int kCells = 21;
constexpr double kCell = 0.4 / kCells;  // m

/// Like heading_for_pleat, but with a pleat at either end of the trace and without a pin. Between the pleats
/// the trace rests or also flows.
EolCloth heading_for_two_pleats(double youngs_modulus, double turn, const std::array<double, 2>& heights,
                                bool rests_between)
{
    EolCloth cloth(testing::make_ridge(60.0), testing::make_draped({kCells, turn, 180.0}));
    cloth.scene.eol = uniform_target(kCell, 10.0);
    for (Vec3& x : cloth.state.mesh.world) x.z() += testing::kThickness;
    cloth.scene.gravity = Gravity{};
    cloth.scene.materials[0].youngs_modulus = youngs_modulus;
    press_edges(cloth);
    testing::take(cloth);

    const auto is_between = [](const Vec2& X) { return std::abs(X.y() - 0.2) < 0.07; };
    for (std::size_t v = 0; v < cloth.state.mesh.world.size(); ++v) {
        const Vec2& X = cloth.state.mesh.material[v];
        const double u = X.x() / kCell - 0.5 * kCells;
        if (u < 0.1 || is_between(X)) continue;
        const double height = heights[X.y() > 0.2 ? 1 : 0];
        const double before = 0.5 - std::sqrt(0.25 - height * height);
        const double behind = 1.0 - std::sqrt(1.0 - height * height);
        const bool is_pleat = u < 1.0;
        cloth.state.mesh.world[v].x() -= (is_pleat ? before : before + behind) * kCell;
        if (is_pleat) cloth.state.mesh.world[v].z() += height * kCell;
    }
    for (const EolVertex& e : cloth.state.eol) {
        const int v = cloth.state.index_of(e.vertex_id);
        if (!rests_between || !is_between(cloth.state.mesh.material[v]))
            cloth.state.material_velocity[v] = Vec2(0.25 * kCell / kStep, 0.0);
    }
    press_edges(cloth);
    return cloth;
}

TEST(StepMesh, IsMadeWithCareOnlyWhereItStrainsTheCloth)
{
    // With StrainLimit::GivesWay both pleats are cleared. At the higher one the cloth stays strained by 30 %
    // of its energy scale.
    EolCloth cloth = heading_for_two_pleats(100.0, -0.5, {0.2, 0.3}, true);
    const auto count_low = [](const std::vector<EolVertex>& eol, const std::vector<VertexId>& ids,
                              const std::vector<Vec2>& material) {
        return std::count_if(eol.begin(), eol.end(), [&](const EolVertex& e) {
            const auto at = std::lower_bound(ids.begin(), ids.end(), e.vertex_id) - ids.begin();
            return material[at].y() < 0.2;
        });
    };
    const std::size_t eol = cloth.state.eol.size();
    const auto low = count_low(cloth.state.eol, cloth.state.ids, cloth.state.mesh.material);
    ASSERT_GT(low, 8);
    const ConformOutcome giving = testing::conform_cloth(cloth);
    EXPECT_EQ(giving.lost, 0);
    const ConformOutcome careful = testing::conform_cloth(cloth, {}, {.strain = StrainLimit::AsMade});
    ASSERT_TRUE(careful.mesh);
    const SurgeryResult& made = careful.mesh->surgery;
    EXPECT_LT(count_low(careful.mesh->eol, made.ids, made.mesh.material), low - 5) << "care costs vertices";

    MeshCache cache;
    update_mesh_cache(cloth.scene, cloth.state, cache);
    StepReport report;
    const State& start = choose_step_mesh(cloth.scene, {cloth.state.time, cloth.state.time + kStep},
                                          cloth.state.time + kStep, FailedFlow(), cloth.state, cache, report)
                             .start;
    EXPECT_LT(start.eol.size(), eol) << "what strains the cloth is not done";
    EXPECT_EQ(count_low(start.eol, start.ids, start.mesh.material), low);
}

TEST(StepMesh, OfPatchesThatStayStrainedTheVerticesAreKnown)
{
    const EolCloth cloth = heading_for_two_pleats(100.0, -0.5, {0.2, 0.3}, true);
    const ConformOutcome giving = testing::conform_cloth(cloth);
    ASSERT_TRUE(giving.mesh);
    TransferReport report;
    transfer(cloth.scene, cloth.state, cloth.stars(), *giving.mesh,
             testing::stars_of(giving.mesh->surgery.mesh), report);
    EXPECT_GT(report.strain, kPatchStrain);
    ASSERT_EQ(report.strained.size(), 1u) << "the cloth gives way at the lower pleat";
    const std::vector<VertexId>& patch = report.strained[0];
    EXPECT_TRUE(std::is_sorted(patch.begin(), patch.end()));
    EXPECT_GT(patch.size(), 20u);
    for (const VertexId id : patch) {
        const int v = cloth.state.index_of(id);
        ASSERT_GE(v, 0) << "there before";
        EXPECT_GT(cloth.state.mesh.material[v].y(), 0.2);
    }
}

TEST(StepMesh, AMeshThatStaysStrainedIsCarriedOverWhole)
{
    EolCloth cloth = heading_for_two_pleats(100.0, -0.5, {0.2, 0.3}, true);
    const Vec3 before = testing::momentum_of(cloth.scene, cloth.state);
    const std::vector<Face> faces = cloth.state.mesh.faces;
    MeshCache cache;
    update_mesh_cache(cloth.scene, cloth.state, cache);
    StepReport report;
    const State& start = choose_step_mesh(cloth.scene, {cloth.state.time, cloth.state.time + kStep},
                                          cloth.state.time + kStep, FailedFlow(), cloth.state, cache, report)
                             .start;
    ASSERT_NE(start.mesh.faces, faces) << "the mesh of the test before";
    const Vec3 change = testing::momentum_of(cloth.scene, start) - before;
    EXPECT_LT(change.norm(), 1e-12 * before.norm());
}

TEST(StepMesh, StrainDoesNotDependOnHowHighTheSceneIs)
{
    const auto report_at = [](double height) {
        EolCloth cloth = heading_for_two_pleats(100.0, -0.5, {0.2, 0.3}, true);
        ObstacleMesh ridge = cloth.scene.obstacles[0].shape().mesh();
        for (Vec3& p : ridge.points) p.z() += height;
        cloth.scene.obstacles[0] = MovingObstacle("ridge", std::move(ridge), {}, {}, 30.0);
        for (Vec3& x : cloth.state.mesh.world) x.z() += height;
        const ConformOutcome giving = testing::conform_cloth(cloth);
        TransferReport report;
        transfer(cloth.scene, cloth.state, cloth.stars(), *giving.mesh,
                 testing::stars_of(giving.mesh->surgery.mesh), report);
        return report;
    };
    const TransferReport low = report_at(0.0);
    EXPECT_GT(low.cloth_strain, 1e-3);
    for (const double height : {-50.0, 50.0}) {
        const TransferReport high = report_at(height);
        EXPECT_NEAR(high.strain, low.strain, 1e-6 * low.strain);
        EXPECT_NEAR(high.cloth_strain, low.cloth_strain, 1e-6 * low.cloth_strain);
    }
}

TEST(StepMesh, StopsTheFlowThroughAVertexThatLosesItsCoordinatesOnAMeshThatStays)
{
    EolCloth cloth = lying(0.0);
    press_edges(cloth);
    testing::take(cloth);
    State& state = cloth.state;
    const Vec2 flow(0.1, 0.0);  // m/s
    for (const EolVertex& e : state.eol) {
        const int v = state.index_of(e.vertex_id);
        state.material_velocity[v] = state.previous_material_velocity[v] = flow;
        state.previous_material[v] = state.mesh.material[v] - kStep * flow;
    }
    state.previous_dt = kStep;
    cloth.scene.eol.reset();  // the mesh stays
    MeshCache cache;
    StepReport report;
    const auto choose = [&]() -> const State& {
        return choose_step_mesh(cloth.scene, {state.time, state.time + kStep}, state.time + kStep,
                                FailedFlow(), state, cache, report)
            .start;
    };
    EXPECT_EQ(&choose(), &state) << "every vertex has coordinates";

    // Cloth in a plane across the ridge: motion out of the ridge is flow, too.
    const int lost = cloth.vertex_at(0.2, 0.2);
    ASSERT_GE(state.eol_entry(state.ids[lost]), 0);
    const Vec3 place = state.mesh.world[lost];
    const ClothStars stars = cloth.stars();
    for (const int f : stars.faces[lost])
        for (const int v : state.mesh.faces[f]) {
            const Vec2 way = state.mesh.material[v] - state.mesh.material[lost];
            state.mesh.world[v] = place + Vec3(0.0, way.y(), way.x());
        }
    ASSERT_FALSE(cloth.place(lost).coordinates);
    const State before = state;
    const State& start = choose();
    EXPECT_EQ(start.mesh.faces, before.mesh.faces);
    for (const EolVertex& e : start.eol) {
        const int v = start.index_of(e.vertex_id);
        const bool flows = v != lost;
        EXPECT_EQ(start.material_velocity[v], flows ? flow : Vec2(0.0, 0.0));
        EXPECT_EQ(start.previous_material_velocity[v], flows ? flow : Vec2(0.0, 0.0));
        EXPECT_EQ(start.previous_material[v] == start.mesh.material[v], !flows);
    }
    EXPECT_NEAR((start.velocity[lost] - before.velocity[lost] + Vec3(0.0, 0.0, flow.x())).norm(), 0.0, 1e-12)
        << "it moves with the material";
    EXPECT_EQ(state.material_velocity[lost], flow) << "a step that fails leaves the state as it was";
}

}  // namespace
}  // namespace arris
