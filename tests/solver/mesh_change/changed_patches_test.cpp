// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh_change/changed_patches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "geometry/cloth/mesh_topology.h"
#include "tests/solver/eol_cloth.h"

namespace arris {
namespace {

using testing::EolCloth;
using testing::make_draped;
using testing::make_ridge;

VertexFaces faces_at(const State& state)
{
    return VertexFaces(state.mesh.vertex_count(), state.mesh.faces);
}

std::array<VertexId, 3> ids_of(const State& state, const Face& face)
{
    std::array<VertexId, 3> ids = {state.ids[face[0]], state.ids[face[1]], state.ids[face[2]]};
    std::rotate(ids.begin(), std::min_element(ids.begin(), ids.end()), ids.end());
    return ids;
}

bool holds(const ClothMesh& mesh, const Face& face, const Vec2& X)
{
    const auto& [a, b, c] = face;
    const auto& at = mesh.material;
    const double area = twice_area(at[a], at[b], at[c]);
    return std::min({twice_area(X, at[b], at[c]), twice_area(at[a], X, at[c]),
                     twice_area(at[a], at[b], X)}) >= -1e-9 * area;
}

/// Brute force: compares every face of both meshes.
std::vector<ChangedPatch> search_all(const State& before, const State& after)
{
    std::set<std::array<VertexId, 3>> old;
    for (const Face& face : before.mesh.faces) old.insert(ids_of(before, face));
    const auto is_same = [&](int v) {
        const std::uint32_t id = after.ids[v];
        return (before.eol_entry(id) < 0) == (after.eol_entry(id) < 0) &&
               before.mesh.material[before.index_of(id)] == after.mesh.material[v];
    };
    const int n = after.mesh.face_count();
    std::set<int> near;
    for (const Face& face : after.mesh.faces)
        if (!old.contains(ids_of(after, face)) || !std::all_of(face.begin(), face.end(), is_same))
            near.insert(face.begin(), face.end());
    for (int ring = 0; ring < 2; ++ring)
        for (const std::set<int> inner = near; const Face& face : after.mesh.faces)
            if (inner.contains(face[0]) || inner.contains(face[1]) || inner.contains(face[2]))
                near.insert(face.begin(), face.end());

    std::vector<int> patch_of(n, -1);
    std::vector<ChangedPatch> patches;
    const auto is_in = [&](int f) {
        return std::all_of(after.mesh.faces[f].begin(), after.mesh.faces[f].end(),
                           [&](int v) { return near.contains(v); });
    };
    for (int f = 0; f < n; ++f) {
        if (!is_in(f) || patch_of[f] >= 0) continue;
        const int p = static_cast<int>(patches.size());
        patch_of[f] = p;
        for (bool has_grown = true; has_grown;) {
            has_grown = false;
            std::set<int> vertices;
            for (int g = 0; g < n; ++g)
                if (patch_of[g] == p) vertices.insert(after.mesh.faces[g].begin(), after.mesh.faces[g].end());
            for (int g = 0; g < n; ++g) {
                const Face& face = after.mesh.faces[g];
                if (!is_in(g) || patch_of[g] >= 0) continue;
                if (!vertices.contains(face[0]) && !vertices.contains(face[1]) && !vertices.contains(face[2]))
                    continue;
                patch_of[g] = p;
                has_grown = true;
            }
        }
        patches.emplace_back();
    }

    for (int f = 0; f < n; ++f)
        if (patch_of[f] >= 0) patches[patch_of[f]].faces.push_back(f);
    for (std::size_t p = 0; p < patches.size(); ++p) {
        std::set<int> vertices, outside;
        for (int f = 0; f < n; ++f)
            (patch_of[f] == static_cast<int>(p) ? vertices : outside)
                .insert(after.mesh.faces[f].begin(), after.mesh.faces[f].end());
        patches[p].vertices.assign(vertices.begin(), vertices.end());
        for (const int v : vertices) patches[p].is_inside.push_back(!outside.contains(v));
    }
    for (int f = 0; f < before.mesh.face_count(); ++f) {
        const auto& [a, b, c] = before.mesh.faces[f];
        const auto& X = before.mesh.material;
        const Vec2 middle = (X[a] + X[b] + X[c]) / 3.0;
        for (int g = 0; g < n; ++g)
            if (patch_of[g] >= 0 && holds(after.mesh, after.mesh.faces[g], middle)) {
                patches[patch_of[g]].faces_before.push_back(f);
                break;
            }
    }
    return patches;
}

void expect_same(const std::vector<ChangedPatch>& found, const std::vector<ChangedPatch>& expected)
{
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t p = 0; p < found.size(); ++p) {
        EXPECT_EQ(found[p].faces, expected[p].faces);
        EXPECT_EQ(found[p].faces_before, expected[p].faces_before);
        EXPECT_EQ(found[p].vertices, expected[p].vertices);
        EXPECT_EQ(found[p].is_inside, expected[p].is_inside);
    }
}

State after_surgery(const State& before, const ClothSurgery& surgery)
{
    State after = before;
    const SurgeryResult result = surgery.result();
    after.mesh = result.mesh;
    after.ids = result.ids;
    after.next_id = result.next_id;
    std::erase_if(after.eol, [&](const EolVertex& e) { return after.index_of(e.vertex_id) < 0; });
    return after;
}

std::vector<ChangedPatch> find(const State& before, const State& after,
                               const std::vector<SurgeryEvent>& events)
{
    const VertexFaces then = faces_at(before), now = faces_at(after);
    return find_changed_patches({before, after, events, then, now});
}

TEST(ChangedPatches, AreThoseThatASearchOfTheWholeMeshFinds)
{
    std::size_t most = 0;
    for (unsigned seed = 1; seed <= 60; ++seed) {
        const EolCloth cloth(make_ridge(60.0), make_draped({20, 0.0, 180.0}));
        ClothSurgery surgery(cloth.state.mesh, cloth.state.ids, cloth.state.next_id);
        std::mt19937 random(seed);
        // Bursts of operations at one place each, so that some faces vanish with all their vertices.
        for (unsigned place = 0; place < 1 + seed % 4; ++place) {
            VertexId v = static_cast<VertexId>(random() % cloth.state.ids.size());
            for (int k = 0; k < 12; ++k) {
                if (!surgery.has_vertex(v)) break;
                const std::vector<VertexId> ring = surgery.ring(v).vertices;
                const VertexId w = ring[random() % ring.size()];
                const SurgeryProposal proposal =
                    k % 3 == 0 ? surgery.propose_edge_split(v, w, 0.4)
                    : k % 3 == 1
                        ? surgery.propose_collapse(w, v)
                        : surgery.propose_moves({{v, 0.9 * surgery.material(v) + 0.1 * surgery.material(w)}});
                surgery.commit(proposal);
            }
        }
        const State after = after_surgery(cloth.state, surgery);
        const std::vector<ChangedPatch> found = find(cloth.state, after, surgery.events());
        ASSERT_NO_FATAL_FAILURE(expect_same(found, search_all(cloth.state, after))) << seed;
        most = std::max(most, found.size());
    }
    EXPECT_GT(most, 1u) << "places far from one another are patches of their own";
}

TEST(ChangedPatches, WhatBecomesOrCeasesToBeEolIsAChangeToo)
{
    EolCloth cloth(make_ridge(60.0), make_draped({20, 0.0, 180.0}));
    const State before = cloth.state;
    cloth.add_eol(cloth.vertex_at(0.2, 0.2), false, testing::tip_of(cloth.scene.obstacles[0].shape()));
    const std::vector<ChangedPatch> made = find(before, cloth.state, {});
    ASSERT_EQ(made.size(), 1u);
    expect_same(made, search_all(before, cloth.state));
    expect_same(find(cloth.state, before, {}), search_all(cloth.state, before));
    EXPECT_EQ(made[0].faces, made[0].faces_before) << "no face has changed";
}

TEST(ChangedPatches, WhereNothingHasChangedThereAreNone)
{
    const EolCloth cloth(make_ridge(60.0), make_draped({8, 0.0, 180.0}));
    EXPECT_TRUE(find(cloth.state, cloth.state, {}).empty());

    // After the inverse operation the faces are the original ones.
    ClothSurgery surgery(cloth.state.mesh, cloth.state.ids, cloth.state.next_id);
    const VertexId a = cloth.state.ids[cloth.vertex_at(0.2, 0.2)];
    const auto flip = [&](VertexId from, VertexId to) {
        const VertexId left = surgery.apex(from, to), right = surgery.apex(to, from);
        EXPECT_EQ(surgery.commit(surgery.propose_flip(from, to)), Verdict::Done);
        return std::pair(left, right);
    };
    for (const VertexId w : surgery.ring(a).vertices) {
        if (!surgery.propose_flip(a, w).is_legal()) continue;
        const auto [left, right] = flip(a, w);
        EXPECT_FALSE(find(cloth.state, after_surgery(cloth.state, surgery), surgery.events()).empty());
        flip(left, right);
        break;
    }
    ASSERT_EQ(surgery.events().size(), 2u);
    EXPECT_TRUE(find(cloth.state, after_surgery(cloth.state, surgery), surgery.events()).empty());
}

}  // namespace
}  // namespace arris
