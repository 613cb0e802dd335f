// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh_change/mesh_transfer.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "geometry/surgery/cloth_surgery.h"
#include "physics/forces/inertia.h"
#include "solver/model/pin_targets.h"
#include "tests/solver/eol_cloth.h"

namespace arris {
namespace {

using testing::EolCloth;
using testing::kinetic_energy_of;
using testing::make_draped;
using testing::make_ridge;
using testing::momentum_of;

constexpr double kStep = 0.005;  // s, step of the history

/// Round-off of velocities and positions of about 1 m/s and 1 m, through the fit's normal equations.
constexpr double kRoundOff = 1e-10;

void set_history(State& state)
{
    state.previous_dt = kStep;
    for (std::size_t v = 0; v < state.ids.size(); ++v) {
        state.previous_world[v] = state.mesh.world[v] - kStep * state.velocity[v];
        state.previous_material[v] = state.mesh.material[v] - kStep * state.material_velocity[v];
        state.previous_velocity[v] = state.velocity[v];
        state.previous_material_velocity[v] = state.material_velocity[v];
    }
}

void shake(State& state, double speed, std::mt19937& random)
{
    std::normal_distribution<double> normal(0.0, speed);
    for (Vec3& v : state.velocity) v = Vec3(normal(random), normal(random), normal(random));
    set_history(state);
}

/// Cloth far above the ridge without bending stiffness, so that relaxation moves nothing.
EolCloth free_cloth(unsigned seed, double fold = 180.0, double rough = 0.0)
{
    EolCloth cloth(make_ridge(60.0), make_draped({8, 0.0, fold}));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> shift(-rough, rough);
    for (Vec3& x : cloth.state.mesh.world) x += Vec3(shift(random), shift(random), 1.0 + shift(random));
    cloth.scene.materials[0].bending_stiffness = 0.0;
    shake(cloth.state, 1.0, random);
    return cloth;
}

ClothSurgery operate(const State& state)
{
    ClothSurgery surgery(state.mesh, state.ids, state.next_id);
    for (const EolVertex& e : state.eol)
        surgery.set_role(e.vertex_id, e.on.is_corner() ? TraceRole::Node : TraceRole::OnTrace, 0);
    return surgery;
}

ConformedMesh conformed(const ClothSurgery& surgery, std::vector<EolVertex> eol)
{
    return {surgery.result(), surgery.events(), std::move(eol), {}};
}

/// Gain of kinetic energy, J.
double energy_gain(const EolCloth& cloth, const State& after)
{
    return kinetic_energy_of(cloth.scene, after) - kinetic_energy_of(cloth.scene, cloth.state);
}

State carry(const EolCloth& cloth, const ConformedMesh& mesh)
{
    TransferReport made;
    State after =
        transfer(cloth.scene, cloth.state, cloth.stars(), mesh, testing::stars_of(mesh.surgery.mesh), made);
    return after;
}

CornerVelocities corners_of(const State& state)
{
    const ClothElements elements =
        make_elements(state.mesh, make_topology(state.mesh.vertex_count(), state.mesh.faces));
    return compute_corner_velocities(elements, state.mesh.world, state.velocity, state.material_velocity);
}

/// Greatest difference between the material's velocity before and after, m/s, at points inside every new
/// face. The old face of each point is found by search.
double field_difference(const State& before, const State& after)
{
    const CornerVelocities old = corners_of(before), now = corners_of(after);
    double worst = 0.0;
    for (std::size_t f = 0; f < after.mesh.faces.size(); ++f)
        for (const Vec3& weights : {Vec3(0.34, 0.33, 0.33), Vec3(0.8, 0.15, 0.05), Vec3(0.1, 0.2, 0.7)}) {
            Vec2 X = Vec2::Zero();
            Vec3 w = Vec3::Zero();
            for (int i = 0; i < 3; ++i) {
                X += weights[i] * after.mesh.material[after.mesh.faces[f][i]];
                w += weights[i] * now[f][i];
            }
            double nearest = std::numeric_limits<double>::infinity();
            for (std::size_t g = 0; g < before.mesh.faces.size(); ++g) {
                const auto& [a, b, c] = before.mesh.faces[g];
                const auto& M = before.mesh.material;
                const double area = twice_area(M[a], M[b], M[c]);
                const Vec3 at(twice_area(X, M[b], M[c]) / area, twice_area(M[a], X, M[c]) / area,
                              twice_area(M[a], M[b], X) / area);
                if (at.minCoeff() < -1e-9) continue;
                nearest =
                    std::min(nearest, (at[0] * old[g][0] + at[1] * old[g][1] + at[2] * old[g][2] - w).norm());
            }
            worst = std::max(worst, nearest);
        }
    return worst;
}

bool is_same_vertex(const State& a, int i, const State& b, int j)
{
    return a.mesh.world[i] == b.mesh.world[j] && a.mesh.material[i] == b.mesh.material[j] &&
           a.velocity[i] == b.velocity[j] && a.material_velocity[i] == b.material_velocity[j] &&
           a.previous_world[i] == b.previous_world[j] && a.previous_velocity[i] == b.previous_velocity[j] &&
           a.previous_material[i] == b.previous_material[j] &&
           a.previous_material_velocity[i] == b.previous_material_velocity[j];
}

TEST(MeshTransfer, NothingDoneChangesNoBit)
{
    const EolCloth cloth = free_cloth(1, 120.0, 0.01);
    const State after = carry(cloth, conformed(operate(cloth.state), {}));
    ASSERT_EQ(after.ids, cloth.state.ids);
    for (int v = 0; v < after.mesh.vertex_count(); ++v)
        EXPECT_TRUE(is_same_vertex(after, v, cloth.state, v)) << v;
}

TEST(MeshTransfer, ASplitLeavesTheFieldAsItIsEverywhere)
{
    for (unsigned seed = 1; seed <= 4; ++seed) {
        const EolCloth cloth = free_cloth(seed, 100.0, 0.01);
        ClothSurgery surgery = operate(cloth.state);
        std::mt19937 random(seed);
        for (int k = 0; k < 6; ++k) {  // some faces are split repeatedly
            const auto v = static_cast<VertexId>(random() % 81);
            const auto face = surgery.faces_at(v)[0];
            const bool is_edge = k % 2 == 0;
            ASSERT_EQ(surgery.commit(is_edge ? surgery.propose_edge_split(v, face[1], 0.3)
                                             : surgery.propose_face_split(face, Vec3(0.3, 0.3, 0.4))),
                      Verdict::Done);
        }
        const State after = carry(cloth, conformed(surgery, {}));
        ASSERT_EQ(after.mesh.vertex_count(), 87);
        EXPECT_LT(field_difference(cloth.state, after), kRoundOff);
        EXPECT_LT(std::abs(energy_gain(cloth, after)), kRoundOff * kinetic_energy_of(cloth.scene, after));
        for (std::size_t v = 0; v < after.ids.size(); ++v) {
            EXPECT_TRUE(after.material_velocity[v].isZero());
            EXPECT_EQ(after.previous_material[v], after.mesh.material[v]);
            // The history was extrapolated back by each velocity, which is linear on the split faces.
            EXPECT_LT((after.previous_world[v] - (after.mesh.world[v] - kStep * after.velocity[v])).norm(),
                      kRoundOff);
            EXPECT_LT((after.previous_velocity[v] - after.velocity[v]).norm(), kRoundOff);
        }
        for (int v = 0; v < 81; ++v) EXPECT_EQ(after.mesh.world[v], cloth.state.mesh.world[v]);
    }
}

/// Cloth that slides over the ridge at `speed`; the fold is at rest in the world.
EolCloth sliding_cloth(double speed)
{
    EolCloth cloth(make_ridge(60.0), make_draped({8, 0.0, 60.0}));
    State& state = cloth.state;
    cloth.scene.materials[0].bending_stiffness = 0.0;
    for (int v = 0; v < state.mesh.vertex_count(); ++v) {
        const double across = state.mesh.material[v].x() - 0.2;
        if (std::abs(across) < 1e-9) {
            cloth.add_eol(v, false, testing::tip_of(cloth.scene.obstacles[0].shape()));
            state.material_velocity[v] = Vec2(-speed, 0);
            state.mesh.world[v] = Vec3(0, state.mesh.world[v].y(), 0);
        } else {
            state.velocity[v] = speed * state.mesh.world[v].normalized().cwiseProduct(Vec3(1, 0, 1));
            const Vec3 along = Vec3(state.mesh.world[v].x(), 0, state.mesh.world[v].z()).normalized();
            state.velocity[v] = across < 0.0 ? Vec3(-speed * along) : Vec3(speed * along);
        }
    }
    set_history(state);
    return cloth;
}

TEST(MeshTransfer, AVertexMadeOnATraceFlowsLikeItsNeighbours)
{
    const double speed = 0.7;
    const EolCloth cloth = sliding_cloth(speed);
    ClothSurgery surgery = operate(cloth.state);
    const int a = cloth.vertex_at(0.2, 0.15), b = cloth.vertex_at(0.2, 0.2);
    surgery.set_edge_tag(cloth.state.ids[a], cloth.state.ids[b], 0);
    const SurgeryProposal split = surgery.propose_edge_split(cloth.state.ids[a], cloth.state.ids[b], 0.4);
    ASSERT_EQ(surgery.commit(split), Verdict::Done);
    const VertexId made = split.event.changes[0].vertex;
    std::vector<EolVertex> eol = cloth.state.eol;
    eol.push_back({made, FeatureId::edge(0, eol[0].on.index), Vec3::UnitZ(), 0});
    const State after = carry(cloth, conformed(surgery, eol));
    const int v = after.index_of(made);
    ASSERT_GE(v, 0);
    EXPECT_LT(after.velocity[v].norm(), kRoundOff);
    EXPECT_LT((after.material_velocity[v] - Vec2(-speed, 0)).norm(), kRoundOff);
    EXPECT_LT((after.previous_world[v] - after.mesh.world[v]).norm(), kRoundOff);
    EXPECT_LT((after.previous_material[v] - (after.mesh.material[v] + kStep * Vec2(speed, 0))).norm(),
              kRoundOff);
    EXPECT_LT(field_difference(cloth.state, after), kRoundOff);
}

const Vec3 kDown(0.5, 0, -std::sqrt(0.75));  // down a flank of the 60-degree ridge

/// Splits an edge halfway from the fold to the next vertex. Returns the state and the new vertex's index.
std::pair<State, int> split_beside_fold(const EolCloth& cloth)
{
    ClothSurgery surgery = operate(cloth.state);
    const VertexId a = cloth.state.ids[cloth.vertex_at(0.2, 0.2)],
                   b = cloth.state.ids[cloth.vertex_at(0.25, 0.2)];
    const SurgeryProposal split = surgery.propose_edge_split(a, b, 0.5);
    EXPECT_EQ(surgery.commit(split), Verdict::Done);
    State after = carry(cloth, conformed(surgery, cloth.state.eol));
    const int v = after.index_of(split.event.changes[0].vertex);
    return {std::move(after), v};
}

TEST(MeshTransfer, AVertexMadeBesideATraceIsOfTheMaterialAndAlwaysWas)
{
    // The fold's vertices rest while material flows through them; the new vertex moves with the material.
    const double speed = 0.7;
    const EolCloth cloth = sliding_cloth(speed);
    const auto [after, v] = split_beside_fold(cloth);
    const Vec3 down = speed * kDown;
    EXPECT_LT((after.velocity[v] - down).norm(), kRoundOff);
    EXPECT_LT((after.previous_velocity[v] - down).norm(), kRoundOff);
    EXPECT_LT((after.previous_world[v] - (after.mesh.world[v] - kStep * down)).norm(), kRoundOff);
    EXPECT_TRUE(after.material_velocity[v].isZero());
    EXPECT_EQ(after.previous_material[v], after.mesh.material[v]);
    EXPECT_LT(field_difference(cloth.state, after), kRoundOff);
}

TEST(MeshTransfer, AVertexWhoseFacesWereNoFacesAStepAgoHasMovedAsItMovesNow)
{
    // A cell of material flows through the fold in a step, so one step ago the faces ahead of the fold were
    // degenerate.
    for (const double cells : {1.0, 1.0 - 1e-14, 1.0 - 1e-9, 1.0 - 1e-3, 1.0 + 1e-14, 1.0 + 1e-3, 1.5, 3.0}) {
        SCOPED_TRACE(cells);
        const double speed = cells * 0.05 / kStep;
        const EolCloth cloth = sliding_cloth(speed);
        const auto [after, v] = split_beside_fold(cloth);
        const Vec3 down = speed * kDown;
        EXPECT_LT((after.velocity[v] - down).norm(), kRoundOff * speed);
        EXPECT_LT((after.previous_velocity[v] - down).norm(), kRoundOff * speed);
        EXPECT_LT((after.previous_world[v] - (after.mesh.world[v] - kStep * down)).norm(), kRoundOff);
    }
}

TEST(MeshTransfer, FlatClothInUniformMotionKeepsItWhereAVertexBecomesEol)
{
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    for (const double turn : {0.0, 33.0}) {
        RigidMotion motion;
        motion.velocity = Vec3(0.3, -0.2, 0.1);
        MovingObstacle ridge("ridge", make_ridge(60.0).shape().mesh(), {}, motion, 30.0);
        EolCloth cloth(std::move(ridge), make_draped({8, turn, 180.0}));
        const Vec3 uniform(normal(random), normal(random), normal(random));
        for (Vec3& v : cloth.state.velocity) v = uniform;
        set_history(cloth.state);
        ClothSurgery surgery = operate(cloth.state);
        const int v = cloth.vertex_at(0.2, 0.2);
        const VertexId id = cloth.state.ids[v];
        surgery.set_role(id, TraceRole::OnTrace, 0);
        const State after = carry(
            cloth,
            conformed(surgery, {{id, FeatureId::edge(0, testing::tip_of(cloth.scene.obstacles[0].shape())),
                                 Vec3::UnitZ(), 0}}));
        EXPECT_LT(field_difference(cloth.state, after), kRoundOff);
        EXPECT_LT(std::abs(energy_gain(cloth, after)), kRoundOff);
        EXPECT_NEAR(after.velocity[v].x(), motion.velocity.x(), kRoundOff) << "it stays over the ridge";
        EXPECT_GT(after.material_velocity[v].norm(), 1e-3) << "and the material flows";
        EXPECT_EQ(after.previous_velocity[v], after.velocity[v]);
        EXPECT_EQ(after.previous_material_velocity[v], after.material_velocity[v]);
        EXPECT_LT(
            (after.previous_material[v] + kStep * after.material_velocity[v] - after.mesh.material[v]).norm(),
            kRoundOff);
        EXPECT_LT((after.previous_world[v] + kStep * after.velocity[v] - after.mesh.world[v]).norm(),
                  kRoundOff);
    }
}

/// Flat cloth that moves uniformly over the ridge, with one EOL vertex that stays on the ridge.
constexpr std::array<double, 3> kUniform = {0.5, 0.1, 0.2};  // m/s
EolCloth flat_cloth_through(double u, double v)
{
    EolCloth flat(make_ridge(60.0), make_draped({8, 0.0, 180.0}));
    for (Vec3& velocity : flat.state.velocity) velocity = Vec3(kUniform.data());
    const int on_ridge = flat.vertex_at(u, v);
    flat.add_eol(on_ridge, false, testing::tip_of(flat.scene.obstacles[0].shape()));
    flat.state.velocity[on_ridge] = Vec3(0.0, kUniform[1], kUniform[2]);
    flat.state.material_velocity[on_ridge] = Vec2(-kUniform[0], 0.0);
    set_history(flat.state);
    return flat;
}

TEST(MeshTransfer, AReleasedVertexIsOfTheMaterialAgain)
{
    // On flat cloth the velocity field does not change.
    const EolCloth flat = flat_cloth_through(0.2, 0.2);
    const Vec3 uniform(kUniform.data());
    const int middle = flat.vertex_at(0.2, 0.2);
    ClothSurgery surgery = operate(flat.state);
    surgery.release_vertex(flat.state.ids[middle]);
    const State after = carry(flat, conformed(surgery, {}));
    EXPECT_TRUE(after.eol.empty());
    EXPECT_EQ(after.material_velocity[middle], Vec2(0, 0));
    EXPECT_EQ(after.previous_material_velocity[middle], Vec2(0, 0));
    EXPECT_EQ(after.previous_material[middle], after.mesh.material[middle]);
    EXPECT_LT((after.velocity[middle] - uniform).norm(), kRoundOff);
    EXPECT_LT((after.previous_world[middle] - (after.mesh.world[middle] - kStep * uniform)).norm(),
              kRoundOff);

    // On a fold the velocity field must change, but momentum is kept and energy does not rise.
    const EolCloth folded = sliding_cloth(0.7);
    surgery = operate(folded.state);
    std::vector<EolVertex> eol = folded.state.eol;
    const VertexId gone = eol[4].vertex_id;
    surgery.release_vertex(gone);
    eol.erase(eol.begin() + 4);
    const State released = carry(folded, conformed(surgery, eol));
    EXPECT_TRUE(released.material_velocity[released.index_of(gone)].isZero());
    EXPECT_LT((momentum_of(folded.scene, released) - momentum_of(folded.scene, folded.state)).norm(),
              kRoundOff * momentum_of(folded.scene, released).norm() + 1e-15);
    EXPECT_LE(energy_gain(folded, released), 1e-9 * kinetic_energy_of(folded.scene, folded.state));
    EXPECT_LT(energy_gain(folded, released), -1e-6) << "what two sides of a fold did, one velocity cannot";
}

TEST(MeshTransfer, WhatCanHaveNoCoordinatesAnyMoreIsOfTheMaterialThoughItsEntryIsLeft)
{
    const EolCloth flat = flat_cloth_through(0.2, 0.0);
    const Vec3 uniform(kUniform.data());
    const int at_border = flat.vertex_at(0.2, 0.0);
    ASSERT_TRUE(flat.place(at_border).coordinates);
    std::vector<EolVertex> eol = flat.state.eol;
    // A vertex on the cloth's border cannot be EOL on a corner.
    eol[0].on = FeatureId::corner(0, testing::end_of(flat.scene.obstacles[0].shape()));
    const State after = carry(flat, conformed(operate(flat.state), eol));
    ASSERT_EQ(after.eol.size(), 1u);
    EXPECT_EQ(after.material_velocity[at_border], Vec2(0, 0));
    EXPECT_EQ(after.previous_material_velocity[at_border], Vec2(0, 0));
    EXPECT_EQ(after.previous_material[at_border], after.mesh.material[at_border]);
    EXPECT_LT((after.velocity[at_border] - uniform).norm(), kRoundOff);
    EXPECT_EQ(after.previous_velocity[at_border], after.velocity[at_border]);
}

TEST(MeshTransfer, FitsNothingWhereAPatchIsStrainedByMoreThanItMay)
{
    // Cutting off a fold at two places strains cloth at rest by more than its elastic energy.
    EolCloth cloth(make_ridge(60.0), make_draped({16, 0.0, 90.0}));
    for (Vec3& x : cloth.state.mesh.world) x.z() += 1.0;
    set_history(cloth.state);
    ClothSurgery surgery = operate(cloth.state);
    for (const double y : {0.1, 0.3}) {
        const VertexId fold = cloth.state.ids[cloth.vertex_at(0.2, y)];
        const VertexId beside = cloth.state.ids[cloth.vertex_at(0.225, y)];
        ASSERT_EQ(surgery.commit(surgery.propose_collapse(fold, beside)), Verdict::Done);
    }
    const ConformedMesh mesh = conformed(surgery, {});
    constexpr double kAny = std::numeric_limits<double>::infinity();
    for (const auto& [most_strain, strained] : {std::pair{kAny, 2u}, {0.01, 1u}}) {
        TransferReport report;
        transfer(cloth.scene, cloth.state, cloth.stars(), mesh, testing::stars_of(mesh.surgery.mesh), report,
                 most_strain);
        EXPECT_GT(report.strain, 0.01);
        EXPECT_EQ(report.strained.size(), strained)
            << "nothing is looked at after the first that is too much";
    }
}

TEST(MeshTransfer, FarFromThePatchNoBitChanges)
{
    EolCloth cloth = free_cloth(7, 120.0, 0.01);
    ClothSurgery surgery = operate(cloth.state);
    const int near = cloth.vertex_at(0.05, 0.05);
    const VertexId v = cloth.state.ids[near];
    ASSERT_EQ(surgery.commit(surgery.propose_collapse(v, surgery.ring(v).vertices[0])), Verdict::Done);
    const State after = carry(cloth, conformed(surgery, {}));
    ASSERT_EQ(after.index_of(v), -1);
    int changed = 0, far = 0;
    for (int i = 0; i < after.mesh.vertex_count(); ++i) {
        const bool is_same = is_same_vertex(after, i, cloth.state, cloth.state.index_of(after.ids[i]));
        changed += is_same ? 0 : 1;
        // Only the vertex's star and two rings around it may change; their outer border is held. Cells are
        // 0.05 m.
        if ((after.mesh.material[i] - Vec2(0.05, 0.05)).cwiseAbs().maxCoeff() > 0.101) {
            ++far;
            EXPECT_TRUE(is_same) << after.mesh.material[i].transpose();
        }
    }
    EXPECT_GT(changed, 0);
    EXPECT_GT(far, 50);
}

TEST(MeshTransfer, MomentumOfFreeClothIsKeptAndEnergyNeverRises)
{
    double worst_gain = -1.0, worst_momentum = 0.0;
    for (unsigned seed = 1; seed <= 90; ++seed) {
        EolCloth cloth = free_cloth(seed, seed % 2 == 0 ? 90.0 : 180.0, 0.008);
        if (seed > 30) {  // a smooth field instead of noise: rotation or ripples
            const Vec3 spin(3, seed, -2);
            for (std::size_t v = 0; v < cloth.state.ids.size(); ++v) {
                const Vec3& x = cloth.state.mesh.world[v];
                cloth.state.velocity[v] =
                    seed > 60 ? spin.cross(x) : Vec3(0, std::sin(40.0 * x.x()), std::cos(15.0 * x.y()));
            }
            set_history(cloth.state);
        }
        ClothSurgery surgery = operate(cloth.state);
        std::mt19937 random(seed);
        int done = 0;
        for (int k = 0; k < 40 && done < 4; ++k) {
            const auto v = static_cast<VertexId>(random() % 81);
            if (!surgery.has_vertex(v) || surgery.is_border(v)) continue;
            const VertexId w = surgery.ring(v).vertices[0];
            const SurgeryProposal proposal =
                k % 2 == 0 ? surgery.propose_collapse(v, w) : surgery.propose_flip(v, w);
            if (proposal.is_legal() && surgery.commit(proposal) == Verdict::Done) ++done;
        }
        ASSERT_GT(done, 1);
        const State after = carry(cloth, conformed(surgery, {}));
        const double energy = kinetic_energy_of(cloth.scene, cloth.state);
        const Vec3 momentum = momentum_of(cloth.scene, cloth.state);
        worst_gain = std::max(worst_gain, energy_gain(cloth, after) / energy);
        const double scale = std::sqrt(2.0 * energy * cloth.scene.materials[0].density * 0.16);
        worst_momentum =
            std::max(worst_momentum, (momentum_of(cloth.scene, after) - momentum).norm() / scale);
    }
    EXPECT_LE(worst_gain, 1e-9);
    EXPECT_LT(worst_momentum, 1e-12);
}

TEST(MeshTransfer, ContactsAndAnchorsOfVerticesThatAreGoneAreDropped)
{
    EolCloth cloth = free_cloth(3);
    const VertexId gone = cloth.state.ids[cloth.vertex_at(0.2, 0.2)];
    ClothSurgery surgery = operate(cloth.state);
    const VertexId kept = surgery.ring(gone).vertices[0], third = surgery.ring(gone).vertices[1];
    const auto contact = [](ContactVertexIds ids, ContactKind kind, double multiplier) {
        std::sort(ids.begin(), ids.end());
        return ActiveContact{ids, kind, 0, 0, Vec3::UnitZ(), multiplier};
    };
    cloth.state.active = {
        contact({gone}, ContactKind::Vertex, 1.0), contact({kept}, ContactKind::Vertex, 2.0),
        contact({gone, kept}, ContactKind::Edge, 3.0), contact({kept, third}, ContactKind::Edge, 4.0),
        contact({gone, kept, third}, ContactKind::Triangle, 5.0)};
    cloth.state.anchors = {{0, std::min(gone, kept), Vec3::Zero()}, {0, std::max(gone, kept), Vec3::Zero()}};
    ASSERT_EQ(surgery.commit(surgery.propose_collapse(gone, kept)), Verdict::Done);
    const State after = carry(cloth, conformed(surgery, {}));
    ASSERT_EQ(after.active.size(), 2u);
    EXPECT_EQ(after.active[0].multiplier, 2.0);
    EXPECT_EQ(after.active[1].multiplier, 4.0);
    ASSERT_EQ(after.anchors.size(), 1u);
    EXPECT_EQ(after.anchors[0].vertex_id, kept);
}

TEST(MeshTransfer, ContactsOfAnEdgeThatWasSplitAndOfItsFacesAreDropped)
{
    EolCloth cloth = free_cloth(3);
    ClothSurgery surgery = operate(cloth.state);
    const VertexId a = cloth.state.ids[cloth.vertex_at(0.2, 0.2)], b = surgery.ring(a).vertices[0];
    const VertexId c = surgery.apex(a, b);
    const auto contact = [](ContactVertexIds ids, ContactKind kind, double multiplier) {
        std::sort(ids.begin(), ids.end());
        return ActiveContact{ids, kind, 0, 0, Vec3::UnitZ(), multiplier};
    };
    cloth.state.active = {contact({a}, ContactKind::Vertex, 1.0), contact({a, b}, ContactKind::Edge, 2.0),
                          contact({b, c}, ContactKind::Edge, 3.0),
                          contact({a, b, c}, ContactKind::Triangle, 4.0)};
    ASSERT_EQ(surgery.commit(surgery.propose_edge_split(a, b, 0.5)), Verdict::Done);
    const State after = carry(cloth, conformed(surgery, {}));
    ASSERT_EQ(after.active.size(), 2u);
    EXPECT_EQ(after.active[0].multiplier, 1.0);
    EXPECT_EQ(after.active[1].multiplier, 3.0);
}

/// Stiff cloth bent to a cylinder, above the ridge.
EolCloth bent_cloth()
{
    EolCloth cloth(make_ridge(60.0), make_draped({8, 0.0, 180.0}));
    cloth.scene.materials[0] = {0.2, 5e4, 0.3, 1e-6, 0.0, 1e-3};
    for (Vec3& x : cloth.state.mesh.world) {
        const double angle = x.x() / 0.1;
        x = Vec3(0.1 * std::sin(angle), x.y(), 1.0 + 0.1 * std::cos(angle));
    }
    set_history(cloth.state);
    return cloth;
}

TEST(MeshTransfer, WhatGivesWayIsNeverWhatIsOnAFeature)
{
    EolCloth cloth = bent_cloth();
    const int on_it = cloth.vertex_at(0.2, 0.25);
    const VertexId eol = cloth.state.ids[on_it], gone = cloth.state.ids[cloth.vertex_at(0.2, 0.2)];
    cloth.add_eol(on_it, false, testing::tip_of(cloth.scene.obstacles[0].shape()));
    ClothSurgery surgery = operate(cloth.state);
    ASSERT_EQ(surgery.commit(surgery.propose_collapse(gone, surgery.ring(gone).vertices[0])), Verdict::Done);
    const State after = carry(cloth, conformed(surgery, cloth.state.eol));
    EXPECT_EQ(after.mesh.world[after.index_of(eol)], cloth.state.mesh.world[on_it]);
    int moved = 0;
    for (std::size_t v = 0; v < after.ids.size(); ++v)
        moved += after.mesh.world[v] == surgery.result().mesh.world[v] ? 0 : 1;
    EXPECT_GT(moved, 5);
}

TEST(MeshTransfer, WhatFrictionHoldsDoesNotGiveWay)
{
    EolCloth cloth = bent_cloth();
    ClothSurgery surgery = operate(cloth.state);
    const VertexId gone = cloth.state.ids[cloth.vertex_at(0.2, 0.2)];
    ASSERT_EQ(surgery.commit(surgery.propose_collapse(gone, surgery.ring(gone).vertices[0])), Verdict::Done);
    const ConformedMesh mesh = conformed(surgery, {});
    const VertexId beside = cloth.state.ids[cloth.vertex_at(0.2, 0.25)];
    const auto way_beside = [&](const Vec3& slip, double budget) {
        ActiveContact contact{};
        contact.vertex_ids = {beside};
        contact.kind = ContactKind::Vertex;
        contact.normal = Vec3::UnitZ();
        contact.friction.slip = slip;
        contact.friction.budget = budget;
        cloth.state.active = {contact};
        const State after = carry(cloth, mesh);
        return (after.mesh.world[after.index_of(beside)] - mesh.surgery.mesh.world[after.index_of(beside)])
            .norm();
    };
    EXPECT_GT(way_beside(Vec3::Zero(), 0.0), 1e-6);   // without friction
    EXPECT_GT(way_beside(Vec3::UnitX(), 1.0), 1e-6);  // slides
    EXPECT_EQ(way_beside(Vec3::Zero(), 1.0), 0.0);    // sticks
}

TEST(MeshTransfer, StiffClothIsNotStrainedByAChangeOfItsMesh)
{
    // A vertex is removed from the top of a round fold, whose chord is shorter than the cloth.
    const EolCloth cloth = bent_cloth();
    ClothSurgery surgery = operate(cloth.state);
    const VertexId v = cloth.state.ids[cloth.vertex_at(0.2, 0.2)];
    ASSERT_EQ(surgery.commit(surgery.propose_collapse(v, surgery.ring(v).vertices[0])), Verdict::Done);
    const double raw = testing::elastic_energy_of(cloth.scene, surgery.result().mesh);
    const double before = testing::elastic_energy_of(cloth.scene, cloth.state.mesh);
    const State after = carry(cloth, conformed(surgery, {}));
    const double relaxed = testing::elastic_energy_of(cloth.scene, after.mesh);
    ASSERT_GT(raw, 2.0 * before) << "else there is nothing to relax";
    EXPECT_LT(relaxed - before, 0.1 * (raw - before));
    for (std::size_t i = 0; i < after.ids.size(); ++i) {
        EXPECT_LT((after.previous_world[i] - after.mesh.world[i]).norm(), 1e-14) << "no velocity comes of it";
        EXPECT_TRUE(after.velocity[i].isZero(1e-14));
    }
}

TEST(MeshTransfer, StrainOfClothAtRestWithoutWeightIsRelativeToItsElasticEnergy)
{
    // A vertex is removed from a fold whose vertices are all held, so that nothing gives way.
    const auto strain_of = [](double stiffness) {
        EolCloth cloth = bent_cloth();
        cloth.scene.materials[0].youngs_modulus *= stiffness;
        cloth.scene.materials[0].bending_stiffness *= stiffness;
        Pin pin;
        pin.material = {Vec2(-10.0, -10.0), Vec2(10.0, 10.0)};
        cloth.scene.pins = {pin};
        attach_pins(cloth.scene, cloth.state);
        ClothSurgery surgery = operate(cloth.state);
        const VertexId v = cloth.state.ids[cloth.vertex_at(0.2, 0.2)];
        EXPECT_EQ(surgery.commit(surgery.propose_collapse(v, surgery.ring(v).vertices[0])), Verdict::Done);
        const ConformedMesh mesh = conformed(surgery, {});
        const double before = testing::elastic_energy_of(cloth.scene, cloth.state.mesh);
        const double gain = testing::elastic_energy_of(cloth.scene, mesh.surgery.mesh) - before;
        TransferReport report;
        transfer(cloth.scene, cloth.state, cloth.stars(), mesh, testing::stars_of(mesh.surgery.mesh), report);
        EXPECT_GE(report.strain, 0.99 * gain / before) << "the patch has a part of the energy";
        return report.strain;
    };
    const double strain = strain_of(1.0);
    EXPECT_TRUE(std::isfinite(strain));
    EXPECT_NEAR(strain_of(16.0), strain, 1e-6 * strain);
}

}  // namespace
}  // namespace arris
