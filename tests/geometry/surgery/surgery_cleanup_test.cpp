// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surgery/surgery_cleanup.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "geometry/cloth/mesh_quality.h"
#include "geometry/surgery/trace_insertion.h"
#include "tests/geometry/surgery_cloths.h"

namespace arris {
namespace {

constexpr double kAngle = 15.0;

MeshTarget target_of(const SurgeryCloth& cloth)
{
    return uniform_target(1.14 * cloth.cell, kAngle);
}

void touch_all(ClothSurgery& surgery)
{
    for (const VertexId v : surgery.result().ids) surgery.touch(v);
}

void mark_trace(ClothSurgery& surgery, const std::vector<VertexId>& path, int tag)
{
    for (const VertexId v : path) surgery.set_role(v, TraceRole::OnTrace, tag);
    for (std::size_t k = 0; k + 1 < path.size(); ++k) surgery.set_edge_tag(path[k], path[k + 1], tag);
}

// The vertices of the line y = `y` from x0 to x1, which must be mesh edges.
std::vector<VertexId> row(const ClothSurgery& surgery, double y, double x0, double x1, double cell)
{
    std::vector<VertexId> vertices;
    for (double x = x0; x < x1 + 0.5 * cell; x += cell) vertices.push_back(nearest_vertex(surgery, {x, y}));
    return vertices;
}

VertexId split(ClothSurgery& surgery, VertexId a, VertexId b, double s)
{
    EXPECT_EQ(surgery.commit(surgery.propose_edge_split(a, b, s)), Verdict::Done);
    return surgery.events().back().changes[0].vertex;
}

TEST(CleanUp, LeavesAGoodMeshAlone)
{
    for (const SurgeryCloth& cloth : {square_cloth(8), square_cloth(8, 0.05), bay_cloth(9), holed_cloth(9)}) {
        ClothSurgery surgery = cloth.surgery();
        touch_all(surgery);
        const CleanupReport report = clean_up(surgery, target_of(cloth));
        EXPECT_EQ(report.operations(), 0) << cloth.name;
        EXPECT_GE(least_material_angle(surgery.result().mesh), kAngle) << cloth.name;
    }
}

TEST(CleanUp, LooksOnlyAtWhatWasTouched)
{
    // All angles are smaller than the target, but only the patch may change.
    const SurgeryCloth cloth = sabotaged_cloth(12, 3);
    ClothSurgery surgery = cloth.surgery();
    const VertexId v = nearest_vertex(surgery, {0.5, 0.5});
    EXPECT_EQ(clean_up(surgery, target_of(cloth)).patch_vertices, 0);
    surgery.touch(v);
    const CleanupReport report = clean_up(surgery, target_of(cloth));
    EXPECT_EQ(report.patch_vertices, 1 + int(cloth.surgery().ring(v).vertices.size()));
    for (const SurgeryEvent& event : surgery.events())
        for (const PatchFace& face : event.before)
            for (const Vec2& X : face.material) EXPECT_LT((X - Vec2(0.5, 0.5)).norm(), 0.45);
}

TEST(CleanUp, CostDoesNotDependOnTheMeshesSize)
{
    std::vector<std::array<int, 3>> figures;
    for (const int n : {16, 64, 128}) {
        SurgeryCloth cloth = placed(square_cloth(n), n / 16.0, {0, 0});
        ClothSurgery surgery = cloth.surgery();
        const MeshTarget target = target_of(cloth);
        const auto a = insert_trace_point(surgery, target, {0.31, 0.33}, 0, {TraceRole::Node, 1});
        const auto b = insert_trace_point(surgery, target, {0.57, 0.52}, a.vertex, {TraceRole::Node, 1});
        ASSERT_EQ(join_trace_vertices(surgery, target, a.vertex, b.vertex, 1).verdict, Verdict::Done);
        const CleanupReport report = clean_up(surgery, target);
        figures.push_back({report.patch_vertices, report.operations(), report.most_operations});
    }
    EXPECT_EQ(figures[0], figures[1]);
    EXPECT_EQ(figures[0], figures[2]);
}

TEST(CleanUp, ShortEdgesAreMergedAwayFromFeatures)
{
    const SurgeryCloth cloth = square_cloth(8);
    ClothSurgery surgery = cloth.surgery();
    split(surgery, nearest_vertex(surgery, {0.5, 0.5}), nearest_vertex(surgery, {0.625, 0.5}), 0.2);
    EXPECT_EQ(surgery.vertex_count(), 82);
    const CleanupReport report = clean_up(surgery, target_of(cloth));
    EXPECT_EQ(report.collapses, 1);
    EXPECT_EQ(surgery.vertex_count(), 81);
}

TEST(CleanUp, ShortEdgesAtFeaturesAreMergedIntoThem)
{
    const SurgeryCloth cloth = square_cloth(8);
    ClothSurgery surgery = cloth.surgery();
    const std::vector<VertexId> trace = row(surgery, 0.5, 0.25, 0.75, 0.125);
    mark_trace(surgery, trace, 1);
    const VertexId beside = split(surgery, trace[2], nearest_vertex(surgery, {0.5, 0.625}), 0.2);
    const Vec2 before = surgery.material(trace[2]);
    clean_up(surgery, target_of(cloth));
    EXPECT_FALSE(surgery.has_vertex(beside));
    EXPECT_EQ(surgery.material(trace[2]), before);
    EXPECT_EQ(surgery.result().tagged_edges.size(), 4u);
}

TEST(CleanUp, TraceVerticesMergeAlongTheTraceAndNodesStay)
{
    const SurgeryCloth cloth = square_cloth(8);
    for (const TraceRole role : {TraceRole::OnTrace, TraceRole::Node}) {
        ClothSurgery surgery = cloth.surgery();
        const std::vector<VertexId> trace = row(surgery, 0.5, 0.25, 0.75, 0.125);
        mark_trace(surgery, trace, 1);
        for (const VertexId v : trace) surgery.set_role(v, TraceRole::Node, 1);
        const VertexId close = split(surgery, trace[2], trace[3], 0.2);
        surgery.set_role(close, role, 1);
        clean_up(surgery, target_of(cloth));
        EXPECT_EQ(surgery.has_vertex(close), role == TraceRole::Node);
        EXPECT_EQ(surgery.result().tagged_edges.size(), role == TraceRole::Node ? 5u : 4u);
        for (const VertexId v : trace) EXPECT_TRUE(surgery.has_vertex(v));
    }
}

TEST(CleanUp, BorderAndCornersKeepTheirPlaces)
{
    const SurgeryCloth cloth = square_cloth(8);
    ClothSurgery surgery = cloth.surgery();
    const SurgeryCheck check(surgery);
    const VertexId corner = nearest_vertex(surgery, {0, 0});
    const VertexId border = split(surgery, corner, nearest_vertex(surgery, {0.125, 0}), 0.1);
    const VertexId inside =
        split(surgery, nearest_vertex(surgery, {0.5, 0}), nearest_vertex(surgery, {0.5, 0.125}), 0.1);
    clean_up(surgery, target_of(cloth));
    EXPECT_FALSE(surgery.has_vertex(border));
    EXPECT_FALSE(surgery.has_vertex(inside));
    EXPECT_TRUE(surgery.has_vertex(nearest_vertex(cloth.surgery(), {0.5, 0})));
    EXPECT_EQ(check.find_wrong(surgery), "");
}

TEST(CleanUp, LongEdgesAreSplitOnATraceTooAndNoneIsLeft)
{
    SurgeryCloth cloth = square_cloth(4);
    ClothSurgery surgery = cloth.surgery();
    mark_trace(surgery, row(surgery, 0.5, 0.0, 1.0, 0.25), 1);
    const MeshTarget target = uniform_target(0.12, kAngle);  // the cells' sides are more than twice as long
    for (int pass = 0; pass < 2; ++pass) {
        touch_all(surgery);
        clean_up(surgery, target);
    }
    for (const VertexId v : surgery.result().ids)
        for (const IdFace& face : surgery.faces_at(v))
            EXPECT_LE(longest_edge({surgery.patch_face(face)}), 0.24);
    EXPECT_GT(surgery.vertex_count(), 40);
    for (const auto& edge : surgery.result().tagged_edges) EXPECT_EQ(edge.tag, 1);
    EXPECT_EQ(SurgeryCheck(cloth.surgery()).find_wrong(surgery), "");
}

// A trace that has merged all vertices up to a border leaves a few huge faces. No second clean-up follows, so
// the first must refine them completely.
TEST(CleanUp, OfEdgesManyTimesTooLongNoneIsLeftTheFirstTime)
{
    for (const double length : {0.1, 0.02}) {
        const SurgeryCloth cloth = square_cloth(2);
        ClothSurgery surgery = cloth.surgery();
        const SurgeryCheck check(surgery);
        touch_all(surgery);
        const CleanupReport report = clean_up(surgery, uniform_target(length, kAngle));
        EXPECT_LE(report.operations(), report.most_operations);
        EXPECT_EQ(check.find_wrong(surgery), "");
        const ClothMesh made = surgery.result().mesh;
        for (const MeshEdge& e : make_topology(made.vertex_count(), made.faces).edges)
            EXPECT_LE((made.material[e.b] - made.material[e.a]).norm(), 2.0 * length);
        // The mesh is no finer than the target: this is the vertex count of a square with that side length.
        EXPECT_LT(made.vertex_count(), std::pow(1.0 + 1.0 / length, 2.0));
        EXPECT_GT(least_material_angle(made), kAngle);
    }
}

TEST(CleanUp, CapBesideATraceIsOpened)
{
    // A free vertex is close to the middle of a long trace edge.
    const SurgeryCloth cloth = square_cloth(8);
    ClothSurgery surgery = cloth.surgery();
    const std::vector<VertexId> trace = row(surgery, 0.5, 0.25, 0.75, 0.125);
    mark_trace(surgery, trace, 1);
    for (const VertexId v : trace) surgery.set_role(v, TraceRole::Node, 1);
    const VertexId cap = nearest_vertex(surgery, {0.5, 0.625});
    ASSERT_EQ(surgery.commit(surgery.propose_moves({{cap, {0.44, 0.501}}})), Verdict::Done);
    EXPECT_LT(least_material_angle(surgery.result().mesh), 2.0);
    clean_up(surgery, target_of(cloth));
    EXPECT_GT(least_material_angle(surgery.result().mesh), kAngle);
    EXPECT_EQ(SurgeryCheck(cloth.surgery()).find_wrong(surgery), "");
}

TEST(CleanUp, WhatTheGuardKeepsFromAMergeIsNotSplitInstead)
{
    // A row of free vertices is close beside a trace, as after folded cloth has left the trace.
    const SurgeryCloth cloth = square_cloth(8);
    ClothSurgery surgery = cloth.surgery();
    const std::vector<VertexId> trace = row(surgery, 0.5, 0.25, 0.75, 0.125);
    mark_trace(surgery, trace, 1);
    for (const VertexId v : trace) surgery.set_role(v, TraceRole::Node, 1);
    for (const VertexId v : row(surgery, 0.625, 0.25, 0.75, 0.125))
        ASSERT_EQ(surgery.commit(surgery.propose_moves({{v, surgery.material(v) - Vec2(0.0, 0.12)}})),
                  Verdict::Done);
    touch_all(surgery);
    surgery.set_guard(
        [](const SurgeryEvent& event) { return event.operation != SurgeryOperation::Collapse; });
    EXPECT_EQ(clean_up(surgery, target_of(cloth)).splits, 0);
    EXPECT_EQ(surgery.vertex_count(), 81);
    surgery.set_guard({});
    touch_all(surgery);
    EXPECT_GT(clean_up(surgery, target_of(cloth)).collapses, 0);
    EXPECT_EQ(SurgeryCheck(cloth.surgery()).find_wrong(surgery), "");
}

// Four corners on one circle have two equally good triangulations; clean-up must not flip between them
// forever.
TEST(CleanUp, CocircularFacesAreLeftAlone)
{
    SurgeryCloth cloth = square_cloth(8);
    for (Vec2& X : cloth.mesh.material) X.y() *= 4.0;  // the least angle is then 14 degrees
    ClothSurgery surgery = cloth.surgery();
    touch_all(surgery);
    const CleanupReport report = clean_up(surgery, uniform_target(2.5 * cloth.cell, 10.0));
    EXPECT_EQ(report.flips, 0);
}

TEST(CleanUp, SabotagedMeshesAreMended)
{
    for (unsigned seed = 0; seed < 20; ++seed) {
        const SurgeryCloth cloth = sabotaged_cloth(10, seed);
        ClothSurgery surgery = cloth.surgery();
        const SurgeryCheck check(surgery);
        ASSERT_LT(least_material_angle(cloth.mesh), 1e-3);
        for (int pass = 0; pass < 3; ++pass) {
            touch_all(surgery);
            const CleanupReport report = clean_up(surgery, target_of(cloth));
            EXPECT_LE(report.operations(), report.most_operations);
            ASSERT_EQ(check.find_wrong(surgery), "");
        }
        EXPECT_GT(least_material_angle(surgery.result().mesh), kAngle) << seed;
    }
}

TEST(CleanUp, EndsWithinItsBoundWhateverTheGuardRefuses)
{
    std::mt19937 random(8);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (const double refused : {0.1, 0.5, 0.9, 1.0})
        for (unsigned seed = 0; seed < 10; ++seed) {
            const SurgeryCloth cloth = sabotaged_cloth(10, seed);
            ClothSurgery surgery = cloth.surgery();
            const SurgeryCheck check(surgery);
            surgery.set_guard([&](const SurgeryEvent&) { return unit(random) >= refused; });
            for (int pass = 0; pass < 5; ++pass) {
                touch_all(surgery);
                const std::size_t events = surgery.events().size();
                const CleanupReport report = clean_up(surgery, target_of(cloth));
                EXPECT_EQ(std::size_t(report.operations()), surgery.events().size() - events);
                EXPECT_LE(report.operations(), report.most_operations);
                ASSERT_EQ(check.find_wrong(surgery), "");
            }
        }
}

// The guard refuses every merge, so only splits and flips are left: their number must stay bounded.
TEST(CleanUp, DoesNotExplodeWhereNothingMayBeMerged)
{
    for (unsigned seed = 0; seed < 5; ++seed) {
        const SurgeryCloth cloth = sabotaged_cloth(10, seed);
        ClothSurgery surgery = cloth.surgery();
        surgery.set_guard(
            [](const SurgeryEvent& event) { return event.operation != SurgeryOperation::Collapse; });
        for (int pass = 0; pass < 30; ++pass) {
            touch_all(surgery);
            clean_up(surgery, target_of(cloth));
        }
        EXPECT_LT(surgery.vertex_count(), 2 * cloth.mesh.vertex_count());
    }
}

TEST(CleanUp, IsTheSameFromARebuiltMesh)
{
    for (unsigned seed = 0; seed < 5; ++seed) {
        const SurgeryCloth cloth = sabotaged_cloth(10, seed);
        ClothSurgery whole = cloth.surgery();
        touch_all(whole);
        clean_up(whole, target_of(cloth));
        const SurgeryResult result = whole.result();
        ClothSurgery rebuilt(result.mesh, result.ids, result.next_id);
        for (ClothSurgery* surgery : {&whole, &rebuilt}) {
            surgery->commit(
                surgery->propose_edge_split(result.ids[40], surgery->ring(result.ids[40]).vertices[0], 0.1));
            touch_all(*surgery);
            clean_up(*surgery, uniform_target(1.5 * cloth.cell, kAngle));
        }
        EXPECT_GT(whole.events().size(), 20u);
        EXPECT_TRUE(is_same(whole.result(), rebuilt.result()));
    }
}

}  // namespace
}  // namespace arris
