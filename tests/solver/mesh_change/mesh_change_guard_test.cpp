// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh_change/mesh_change_guard.h"
#include "physics/forces/make_terms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "geometry/sort_unique.h"
#include "physics/forces/energies.h"
#include "solver/eol/creases.h"
#include "solver/mesh_change/surgery_energy.h"
#include "tests/solver/eol_cloth.h"

namespace arris {
namespace {

using testing::EolCloth;
using testing::make_draped;
using testing::make_ridge;

/// Cloth folded over the ridge, but far above it. Its vertices on the fold form a trace.
struct Folded {
    EolCloth cloth;
    ClothSurgery surgery;

    explicit Folded(double fold_degrees = 90.0, double rough = 1e-300)
        : cloth(make_ridge(60.0), make_draped({8, 0.0, fold_degrees})), surgery(make(rough))
    {
        cloth.scene.gravity = Gravity{};
    }

    VertexId at(double u, double v) const { return cloth.state.ids[cloth.vertex_at(u, v)]; }

    /// Stretch, bending and gravity energy of the whole cloth, computed as in a step.
    double energy(const Terms& terms) const { return energies(terms).sum(); }

    Energies energies(const Terms& terms) const
    {
        const SurgeryResult made = surgery.result();
        Creases creases{{kCreaseWidth}, {}};
        for (const auto& edge : made.tagged_edges) creases.edges.push_back({edge.a, edge.b});
        ClothElements elements =
            make_elements(made.mesh, make_topology(made.mesh.vertex_count(), made.mesh.faces));
        mark_creases(creases, made.mesh, elements);
        return compute_energies(elements, terms, made.mesh.world);
    }

    static constexpr double kCreaseWidth = 0.05;  // m

  private:
    ClothSurgery make(double rough)
    {
        std::mt19937 random(1);
        std::normal_distribution<double> shift(0.0, rough);
        for (Vec3& x : cloth.state.mesh.world) x += Vec3(shift(random), shift(random), 1.0 + shift(random));
        ClothSurgery made(cloth.state.mesh, cloth.state.ids, cloth.state.next_id);
        for (int k = 1; k < 6; ++k) made.set_role(at(0.2, 0.05 * k), TraceRole::OnTrace, 0);
        for (int k = 1; k < 5; ++k) made.set_edge_tag(at(0.2, 0.05 * k), at(0.2, 0.05 * (k + 1)), 0);
        return made;
    }
};

TEST(SurgeryEnergy, IsTheRiseThatTheStepWillFind)
{
    for (const double stiffness : {0.0, 1e-3, 1e-1}) {
        Folded cloth(90.0, 3e-3);
        cloth.cloth.scene.materials[0].bending_stiffness = stiffness;
        const Scene& scene = cloth.cloth.scene;
        const Terms terms = make_terms(scene.materials, scene.gravity, {}, {});
        ClothSurgery& surgery = cloth.surgery;
        const VertexId on = cloth.at(0.2, 0.2), next = cloth.at(0.2, 0.15);
        const VertexId beside = cloth.at(0.15, 0.2), inner = cloth.at(0.1, 0.1), border = cloth.at(0.0, 0.2);
        double greatest = 0.0;
        const auto check = [&](const SurgeryProposal& proposal, const char* what) {
            ASSERT_TRUE(proposal.is_legal()) << what << to_string(proposal.verdict);
            const SurgeryEvent& event = proposal.event;
            const auto energy = [&](const std::vector<PatchFace>& faces) {
                return find_energies(surgery, event, faces, terms, {Folded::kCreaseWidth}).sum();
            };
            const double rise = energy(event.after) - energy(event.before), before = cloth.energy(terms);
            ASSERT_EQ(surgery.commit(proposal), Verdict::Done) << what;
            constexpr double kRoundOff = 1e-12;  // J, for energies of 0.3 J
            EXPECT_NEAR(rise, cloth.energy(terms) - before, kRoundOff) << what << ", " << stiffness;
            greatest = std::max(greatest, std::abs(rise));
        };
        check(surgery.propose_edge_split(on, next, 0.3), "a trace's edge");
        check(surgery.propose_edge_split(on, beside, 0.4), "an edge from it");
        check(surgery.propose_edge_split(border, surgery.ring(border).vertices.front(), 0.4), "the border");
        check(surgery.propose_face_split(surgery.faces_at(inner)[0], {0.2, 0.3, 0.5}), "a face");
        check(surgery.propose_moves({{beside, surgery.material(beside) + Vec2(-0.02, 0.005)}}), "a move");
        check(surgery.propose_moves({{on, surgery.material(on) + Vec2(0.01, 0.0), true}}), "the trace");
        check(surgery.propose_collapse(cloth.at(0.25, 0.15), next), "beside a trace");
        check(surgery.propose_collapse(cloth.at(0.2, 0.1), next), "along a trace");
        check(surgery.propose_flip(inner, cloth.at(0.15, 0.15)), "a flip");
        EXPECT_GT(greatest, 1e-4) << "they matter";
    }
}

TEST(SurgeryEnergy, OfAPlateIsNearTheRiseThatTheStepWillFind)
{
    // Moments of a plate reach beyond the patch, where its energy takes them as zero.
    constexpr double kShare = 0.25;  // of the rise, on rough cloth
    for (const char* what : {"a move", "a collapse", "a flip"}) {
        Folded cloth(90.0, 3e-3);
        Material& material = cloth.cloth.scene.materials[0];
        material.bending_stiffness = 1e-1;
        material.bending_model = BendingModel::Plate;
        const Terms terms = make_terms(material, {}, {}, {});
        ClothSurgery& surgery = cloth.surgery;
        const VertexId beside = cloth.at(0.15, 0.2), inner = cloth.at(0.1, 0.1);
        const std::string name = what;
        const SurgeryProposal proposal =
            name == "a move"
                ? surgery.propose_moves({{beside, surgery.material(beside) + Vec2(-0.02, 0.005)}})
            : name == "a collapse" ? surgery.propose_collapse(cloth.at(0.1, 0.2), beside)
                                   : surgery.propose_flip(inner, cloth.at(0.15, 0.15));
        ASSERT_TRUE(proposal.is_legal()) << what << to_string(proposal.verdict);
        const auto bending = [&](const std::vector<PatchFace>& faces) {
            return find_energies(surgery, proposal.event, faces, terms, {Folded::kCreaseWidth}).bending;
        };
        const double rise = bending(proposal.event.after) - bending(proposal.event.before);
        const double before = cloth.energies(terms).bending;
        ASSERT_EQ(surgery.commit(proposal), Verdict::Done) << what;
        const double true_rise = cloth.energies(terms).bending - before;
        EXPECT_NEAR(rise, true_rise, kShare * std::abs(true_rise)) << what;
    }
}

TEST(MeshChangeGuard, DoesNotLetStiffClothBeBent)
{
    // Flipping an edge of the fold makes the fold a zigzag. The cloth is so soft that the stretch has no
    // noticeable energy.
    for (const auto& [stiffness, is_allowed] : {std::pair(1e-9, true), {1e-1, false}}) {
        Folded cloth(160.0);
        cloth.cloth.scene.materials[0].youngs_modulus = 1e-3;
        cloth.cloth.scene.materials[0].bending_stiffness = stiffness;
        cloth.cloth.scene.gravity.reset();
        for (Vec3& v : cloth.cloth.state.velocity) v = Vec3(0.3, 0.0, 0.0);
        RelaxationMemo relaxations;
        MeshChangeGuard guard(cloth.cloth.scene, cloth.cloth.state, StrainLimit::AsMade, {}, relaxations);
        guard.watch(cloth.surgery);
        const SurgeryProposal flip = cloth.surgery.propose_flip(cloth.at(0.2, 0.3), cloth.at(0.2, 0.35));
        ASSERT_TRUE(flip.is_legal());
        EXPECT_EQ(guard.allows(flip.event), is_allowed) << stiffness;
    }
}

TEST(MeshChangeGuard, DoesNotLetClothBeLifted)
{
    // Soft cloth sags. Collapsing a vertex of the valley lifts the cloth around it to the chord.
    for (const bool is_heavy : {false, true}) {
        Folded cloth(180.0);
        State& state = cloth.cloth.state;
        cloth.cloth.scene.materials[0] = {1.0, 1e-6, 0.3, 0.0, 0.0, 1e-3};
        if (!is_heavy) cloth.cloth.scene.gravity.reset();
        for (Vec3& v : state.velocity) v = Vec3(0.5, 0.0, 0.0);
        for (std::size_t v = 0; v < state.ids.size(); ++v)
            state.mesh.world[v].z() += 5.0 * std::pow(state.mesh.material[v].x() - 0.2, 2);
        const ClothSurgery sagging(state.mesh, state.ids, state.next_id);
        RelaxationMemo relaxations;
        MeshChangeGuard guard(cloth.cloth.scene, state, StrainLimit::AsMade, {}, relaxations);
        guard.watch(sagging);
        const SurgeryProposal gone = sagging.propose_collapse(cloth.at(0.2, 0.2), cloth.at(0.25, 0.2));
        ASSERT_TRUE(gone.is_legal());
        EXPECT_EQ(guard.allows(gone.event), !is_heavy);
    }
}

TEST(MeshChangeGuard, WithCareNothingCountsOnClothThatGivesWay)
{
    // On rough cloth, selects the edges whose flip strains the cloth but is allowed because the cloth gives
    // way.
    Folded cloth(180.0, 1e-3);
    cloth.cloth.scene.gravity.reset();
    RelaxationMemo relaxations;
    const auto ask = [&](const SurgeryEvent& event, StrainLimit limit,
                         const std::vector<VertexId>& careful_at, std::vector<VertexId>& relies_at) {
        MeshChangeGuard guard(cloth.cloth.scene, cloth.cloth.state, limit, careful_at, relaxations);
        guard.watch(cloth.surgery);
        const bool is_allowed = guard.allows(event);
        relies_at = guard.relies_at();
        return is_allowed;
    };
    int counted = 0;
    for (const MeshEdge& edge : testing::edges_of(cloth.cloth.state)) {
        const std::vector<VertexId>& ids = cloth.cloth.state.ids;
        const SurgeryProposal flip = cloth.surgery.propose_flip(ids[edge.a], ids[edge.b]);
        std::vector<VertexId> relies_at, none, replaced;
        if (!flip.is_legal() || ask(flip.event, StrainLimit::AsMade, {}, none)) continue;
        EXPECT_TRUE(none.empty());
        if (!ask(flip.event, StrainLimit::GivesWay, {}, relies_at)) continue;
        ++counted;
        for (const PatchFace& face : flip.event.before)
            replaced.insert(replaced.end(), face.vertices.begin(), face.vertices.end());
        sort_unique(replaced);
        EXPECT_EQ(relies_at, replaced);
        for (const VertexId v : ids) {
            const bool is_there = std::binary_search(replaced.begin(), replaced.end(), v);
            EXPECT_EQ(ask(flip.event, StrainLimit::GivesWay, {v}, relies_at), !is_there) << v;
            EXPECT_EQ(relies_at.empty(), is_there);
        }
    }
    EXPECT_GT(counted, 0);
}

TEST(MeshChangeGuard, SplitsAreFree)
{
    Folded cloth;
    cloth.cloth.scene.materials[0].bending_stiffness = 1e-1;
    RelaxationMemo relaxations;
    MeshChangeGuard guard(cloth.cloth.scene, cloth.cloth.state, StrainLimit::AsMade, {}, relaxations);
    guard.watch(cloth.surgery);
    const SurgeryProposal split =
        cloth.surgery.propose_edge_split(cloth.at(0.2, 0.2), cloth.at(0.15, 0.2), 0.1);
    ASSERT_TRUE(split.is_legal());
    EXPECT_TRUE(guard.allows(split.event)) << "no surface has changed";
}

}  // namespace
}  // namespace arris
