// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surgery/trace_insertion.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <random>

#include "geometry/cloth/mesh_quality.h"
#include "geometry/surgery/surgery_cleanup.h"
#include "tests/geometry/surgery_cloths.h"

namespace arris {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kAngle = 15.0;

MeshTarget target_of(const SurgeryCloth& cloth)
{
    return uniform_target(1.14 * cloth.cell, kAngle);
}

TraceInsertion insert(ClothSurgery& surgery, const MeshTarget& target, const Vec2& X, int tag = 1)
{
    return insert_trace_point(surgery, target, X, nearest_vertex(surgery, X), {TraceRole::Node, tag});
}

// Inserts both ends and joins them by a straight trace.
TraceJoin cut(ClothSurgery& surgery, const MeshTarget& target, const Vec2& from, const Vec2& to, int tag = 1)
{
    const TraceInsertion a = insert(surgery, target, from, tag);
    const TraceInsertion b = insert(surgery, target, to, tag);
    if (a.verdict != Verdict::Done) return {a.verdict, {}};
    if (b.verdict != Verdict::Done) return {b.verdict, {}};
    if (a.vertex == b.vertex) return {Verdict::Argument, {}};
    return join_trace_vertices(surgery, target, a.vertex, b.vertex, tag);
}

void release_all(ClothSurgery& surgery)
{
    const SurgeryResult result = surgery.result();
    for (std::size_t k = 0; k < result.ids.size(); ++k)
        if (result.roles[k] != TraceRole::Free) surgery.release_vertex(result.ids[k]);
}

// Checks a completed join: a path of tagged edges from end to end on the straight line.
void expect_on_line(const ClothSurgery& surgery, const TraceJoin& join, int tag, double tolerance)
{
    ASSERT_EQ(join.verdict, Verdict::Done) << to_string(join.verdict);
    const Vec2 a = surgery.material(join.vertices.front());
    const Vec2 d = surgery.material(join.vertices.back()) - a;
    double along = 0.0;
    for (std::size_t k = 1; k < join.vertices.size(); ++k) {
        EXPECT_EQ(surgery.edge_tag(join.vertices[k - 1], join.vertices[k]), tag);
        EXPECT_NE(surgery.role(join.vertices[k]), TraceRole::Free);
        const Vec2 p = surgery.material(join.vertices[k]) - a;
        EXPECT_LE(std::abs(d.x() * p.y() - d.y() * p.x()) / d.norm(), tolerance);
        EXPECT_GT(p.dot(d), along);
        along = p.dot(d);
    }
}

constexpr double kStraight = 1e-15;  // m, on a unit square: rounding of one intersection

// --- one point

TEST(InsertEdgeCrossing, SplitsInTheMiddleAndSnapsNearTheEnds)
{
    for (const auto& [s, is_new] : {std::pair(0.5, true), {0.2, false}, {0.85, false}, {0.31, true}}) {
        const SurgeryCloth cloth = square_cloth(8);
        ClothSurgery surgery = cloth.surgery();
        const VertexId a = nearest_vertex(surgery, {0.5, 0.5}), b = nearest_vertex(surgery, {0.5, 0.625});
        const auto made = insert_edge_crossing(surgery, uniform_target(cloth.cell, kAngle), a, b, s, {});
        ASSERT_EQ(made.verdict, Verdict::Done);
        EXPECT_EQ(made.vertex != a && made.vertex != b, is_new) << s;
        EXPECT_LT((surgery.material(made.vertex) - Vec2(0.5, 0.5 + s * 0.125)).norm(), 1e-16);
        EXPECT_EQ(surgery.role(made.vertex), TraceRole::OnTrace);
        EXPECT_EQ(SurgeryCheck(cloth.surgery()).find_wrong(surgery), "");
    }
}

TEST(InsertEdgeCrossing, AtAVertexTakesIt)
{
    for (const double s : {0.0, 1.0, 1e-17, 1e-9}) {
        const SurgeryCloth cloth = square_cloth(8);
        ClothSurgery surgery = cloth.surgery();
        const VertexId a = nearest_vertex(surgery, {0.5, 0.5}), b = nearest_vertex(surgery, {0.5, 0.625});
        const auto made = insert_edge_crossing(surgery, target_of(cloth), a, b, s, {});
        EXPECT_EQ(made.verdict, Verdict::Done);
        EXPECT_EQ(made.vertex, s < 0.5 ? a : b);
        EXPECT_EQ(surgery.vertex_count(), 81);
    }
}

TEST(InsertEdgeCrossing, BorderVerticesMoveAlongTheBorderOnlyAndCornersNever)
{
    const SurgeryCloth cloth = square_cloth(8);
    ClothSurgery surgery = cloth.surgery();
    const MeshTarget target = target_of(cloth);
    const VertexId border = nearest_vertex(surgery, {0.5, 0.0}), next = nearest_vertex(surgery, {0.625, 0.0});
    const VertexId inside = nearest_vertex(surgery, {0.5, 0.125}), corner = nearest_vertex(surgery, {0, 0});
    const VertexId beside = nearest_vertex(surgery, {0.125, 0});
    const auto off = insert_edge_crossing(surgery, target, border, inside, 0.1, {TraceRole::OnTrace, 1});
    EXPECT_EQ(off.verdict, Verdict::Done);
    EXPECT_NE(off.vertex, border);
    EXPECT_EQ(
        insert_edge_crossing(surgery, target, border, off.vertex, 0.01, {TraceRole::OnTrace, 2}).verdict,
        Verdict::Quality);
    EXPECT_EQ(insert_edge_crossing(surgery, target, border, next, 0.1, {TraceRole::OnTrace, 3}).vertex,
              border);
    EXPECT_EQ(surgery.material(border).y(), 0.0);
    EXPECT_EQ(insert_edge_crossing(surgery, target, corner, beside, 0.01, {}).verdict, Verdict::Quality);
    EXPECT_EQ(insert_edge_crossing(surgery, target, corner, beside, 0.0, {}).verdict, Verdict::Fixed);
    EXPECT_EQ(insert_edge_crossing(surgery, target, corner, beside, 0.1, {}).verdict, Verdict::Done);
    EXPECT_EQ(SurgeryCheck(cloth.surgery()).find_wrong(surgery), "");
}

TEST(InsertEdgeCrossing, BesideAVertexThatTheGuardKeepsSplitsWhereTheTraceDoesNotRunIntoIt)
{
    const SurgeryCloth cloth = square_cloth(8);
    const MeshTarget target = target_of(cloth);
    const auto insert_with = [&](const Vec2& way, double s) {
        ClothSurgery surgery = cloth.surgery();
        const SurgeryCheck check(surgery);
        surgery.set_guard(
            [](const SurgeryEvent& event) { return event.operation != SurgeryOperation::Move; });
        const VertexId a = nearest_vertex(surgery, {0.5, 0.5}), b = nearest_vertex(surgery, {0.5, 0.625});
        const TraceInsertion made =
            insert_edge_crossing(surgery, target, a, b, s, {TraceRole::OnTrace, 1, way});
        EXPECT_EQ(check.find_wrong(surgery), "");
        EXPECT_EQ(surgery.vertex_count(), made.verdict == Verdict::Done ? 82 : 81);
        if (made.verdict == Verdict::Done) {
            EXPECT_LT((surgery.material(made.vertex) - Vec2(0.5, 0.5 + s * 0.125)).norm(), 1e-15);
        }
        return made.verdict;
    };
    for (const double s : {0.2, 0.04, 0.002}) {
        EXPECT_EQ(insert_with({0.0, 0.1}, s), Verdict::Done) << s;
        EXPECT_EQ(insert_with({5.0, 1.0}, s), Verdict::Done) << s;
        EXPECT_EQ(insert_with({0.0, -1.0}, s), Verdict::Guard) << s;
        EXPECT_EQ(insert_with({kNan, 0.0}, s), Verdict::Guard) << s;
        EXPECT_EQ(insert_with({0.0, -1.0}, 1.0 - s), Verdict::Done) << s;
    }
    EXPECT_EQ(insert_with({0.0, 1.0}, 0.0005), Verdict::Quality);
    // A vertex ahead of the trace may stay if the trace does not reach it, but not nearer than 10 % of the
    // target length.
    const double cell = 0.125;
    EXPECT_EQ(insert_with({0.0, -0.19 * cell}, 0.2), Verdict::Done);
    EXPECT_EQ(insert_with({0.0, -0.21 * cell}, 0.2), Verdict::Guard);
    EXPECT_EQ(insert_with({0.0, 0.0}, 0.12), Verdict::Done);
    EXPECT_EQ(insert_with({0.0, 0.0}, 0.11), Verdict::Guard);
    // One behind the trace may be nearer, but not where the trace is still so near at the end of its way.
    EXPECT_EQ(insert_with({0.0, 1e-9}, 0.06), Verdict::Done);
    EXPECT_EQ(insert_with({0.0, 0.02 * cell}, 0.04), Verdict::Done);
    EXPECT_EQ(insert_with({0.0, 1e-9}, 0.04), Verdict::Quality);
}

TEST(InsertEdgeCrossing, BesideABorderVertexSplitsWhereTheTraceSoonLeavesRoom)
{
    // The trace crosses an edge 0.4 % from its end on the border. That end cannot move to the trace, and no
    // clean-up can open the faces between them while the trace is near.
    const SurgeryCloth cloth = square_cloth(8);
    const double cell = 0.125, s = 0.004;
    const auto insert_with = [&](const Vec2& way) {
        ClothSurgery surgery = cloth.surgery();
        const VertexId v = nearest_vertex(surgery, {0.0, 0.5}), inner = nearest_vertex(surgery, {0.125, 0.5});
        return insert_edge_crossing(surgery, target_of(cloth), v, inner, s, {TraceRole::OnTrace, 1, way})
            .verdict;
    };
    EXPECT_EQ(insert_with({0.05 * cell, 0.0}), Verdict::Done);
    EXPECT_EQ(insert_with({0.04 * cell, 0.0}), Verdict::Quality);
    EXPECT_EQ(insert_with({1e-9, 0.0}), Verdict::Quality) << "not decided by the sign of round-off";
    EXPECT_EQ(insert_with({-0.05 * cell, 0.0}), Verdict::Quality);
}

TEST(InsertEdgeCrossing, RefusesWhatIsNoCrossing)
{
    const SurgeryCloth cloth = square_cloth(8);
    ClothSurgery surgery = cloth.surgery();
    const MeshTarget target = target_of(cloth);
    EXPECT_EQ(insert_edge_crossing(surgery, target, 0, 80, 0.5, {}).verdict, Verdict::Missing);
    EXPECT_EQ(insert_edge_crossing(surgery, target, 0, 1, kNan, {}).verdict, Verdict::Argument);
    EXPECT_EQ(insert_edge_crossing(surgery, target, 0, 1, 1.5, {}).verdict, Verdict::Argument);
    EXPECT_EQ(insert_trace_point(surgery, target, {kNan, 0}, 0, {}).verdict, Verdict::Missing);
    EXPECT_EQ(insert_trace_point(surgery, target, {2, 0}, 0, {}).verdict, Verdict::Missing);
    EXPECT_EQ(insert_trace_point(surgery, target, {0.5, 0.5}, 999, {}).verdict, Verdict::Missing);
    EXPECT_EQ(insert_face_point(surgery, target, {0, 1, 2}, {1, 1, 1}, {}).verdict, Verdict::Missing);
    EXPECT_EQ(insert_face_point(surgery, target, {0, 1, 10}, {kNan, 1, 1}, {}).verdict, Verdict::Argument);
    EXPECT_EQ(insert_face_point(surgery, target, {0, 1, 10}, {0, 0, 0}, {}).verdict, Verdict::Argument);
    EXPECT_TRUE(is_same(surgery.result(), cloth.surgery().result()));
}

TEST(InsertFacePoint, LiesWhereItWasAskedFor)
{
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const SurgeryCloth cloth = square_cloth(8, 0.2);
    for (int k = 0; k < 300; ++k) {
        ClothSurgery surgery = cloth.surgery();
        const Vec2 X(unit(random), unit(random));
        const TraceInsertion made = insert(surgery, target_of(cloth), X);
        ASSERT_EQ(SurgeryCheck(cloth.surgery()).find_wrong(surgery), "");
        if (made.verdict != Verdict::Done) {
            // Insertion may fail only beside the border, where no vertex can be moved.
            EXPECT_LT(std::min({X.x(), X.y(), 1 - X.x(), 1 - X.y()}), 1e-9) << X.transpose();
            continue;
        }
        EXPECT_LT((surgery.material(made.vertex) - X).norm(), 1e-15);
    }
}

TEST(InsertFacePoint, BesideACornerThatTheGuardKeepsSplitsWhereTheTraceLeavesItBehind)
{
    const SurgeryCloth cloth = square_cloth(8);
    ClothSurgery surgery = cloth.surgery();
    surgery.set_guard([](const SurgeryEvent& event) { return event.operation != SurgeryOperation::Move; });
    const VertexId v = nearest_vertex(surgery, {0.5, 0.5});
    const IdFace face = surgery.faces_at(v)[0];
    const auto corners = surgery.patch_face(face).material;
    const Vec2 away = 0.5 * (corners[1] + corners[2]) - corners[0];
    const Vec3 weights(0.8, 0.1, 0.1);
    TraceVertex made{TraceRole::Node, 1, -away};
    EXPECT_EQ(insert_face_point(surgery, target_of(cloth), face, weights, made).verdict, Verdict::Guard);
    made.way = away;
    EXPECT_EQ(insert_face_point(surgery, target_of(cloth), face, weights, made).verdict, Verdict::Done);
    EXPECT_EQ(SurgeryCheck(cloth.surgery()).find_wrong(surgery), "");
}

TEST(InsertFacePoint, ANodeIsNotWhatSlidesAlongItsTraceAndTheTraceGoesThroughIt)
{
    // The new node is beside an edge of its own trace and near one of its ends.
    const SurgeryCloth cloth = square_cloth(8);
    ClothSurgery surgery = cloth.surgery();
    const MeshTarget target = target_of(cloth);
    const TraceInsertion a = insert_trace_point(surgery, target, {0.375, 0.5}, 0, {TraceRole::OnTrace, 7});
    const TraceInsertion b = insert_trace_point(surgery, target, {0.5, 0.5}, 0, {TraceRole::OnTrace, 7});
    ASSERT_EQ(join_trace_vertices(surgery, target, a.vertex, b.vertex, 7).verdict, Verdict::Done);
    const Vec2 X(0.4, 0.505);
    const TraceInsertion slides = insert_trace_point(surgery, target, X, a.vertex, {TraceRole::OnTrace, 7});
    EXPECT_EQ(slides.vertex, a.vertex) << "what slides is there already";
    const TraceInsertion node = insert_trace_point(surgery, target, X, a.vertex, {TraceRole::Node, 7});
    ASSERT_EQ(node.verdict, Verdict::Done);
    EXPECT_NE(node.vertex, a.vertex);
    EXPECT_LT((surgery.material(node.vertex) - X).norm(), kStraight);
    EXPECT_FALSE(surgery.has_edge(a.vertex, b.vertex)) << "its chord is flipped away";
    for (const VertexId end : {a.vertex, b.vertex}) EXPECT_EQ(surgery.edge_tag(node.vertex, end), 7);
}

TEST(InsertFacePoint, CoincidentPointsAreOneVertex)
{
    const SurgeryCloth cloth = square_cloth(8);
    ClothSurgery surgery = cloth.surgery();
    const TraceInsertion first = insert(surgery, target_of(cloth), {0.53, 0.55});
    const TraceInsertion second = insert(surgery, target_of(cloth), {0.53, 0.55});
    EXPECT_EQ(first.vertex, second.vertex);
    const TraceInsertion other = insert(surgery, target_of(cloth), {0.53, 0.55}, 2);
    EXPECT_NE(other.verdict, Verdict::Done);
    EXPECT_EQ(SurgeryCheck(cloth.surgery()).find_wrong(surgery), "");
}

TEST(InsertFacePoint, CloudsMuchFinerThanTheMeshAreInserted)
{
    const SurgeryCloth cloth = square_cloth(20);
    ClothSurgery surgery = cloth.surgery();
    const SurgeryCheck check(surgery);
    const MeshTarget target = target_of(cloth);
    int refused = 0;
    for (int k = 0; k < 100; ++k) {
        const Vec2 X = Vec2(0.43, 0.41) + 0.01 * Vec2(k % 10, k / 10);
        const TraceInsertion made =
            insert_trace_point(surgery, target, X, nearest_vertex(surgery, X), {TraceRole::Node, k});
        refused += made.verdict == Verdict::Done ? 0 : 1;
        clean_up(surgery, target);
        ASSERT_EQ(check.find_wrong(surgery), "");
    }
    EXPECT_EQ(refused, 0);
    EXPECT_LE(surgery.vertex_count(), 441 + 130);
}

// --- lines

TEST(JoinTraceVertices, AlongMeshLinesAddsNoVertex)
{
    const std::array<std::array<Vec2, 2>, 3> lines = {{{Vec2(0.25, 0.5), Vec2(0.875, 0.5)},
                                                       {Vec2(0.25, 0.25), Vec2(0.75, 0.75)},
                                                       {Vec2(0.5, 0.0), Vec2(0.5, 1.0)}}};
    for (const auto& [from, to] : lines) {
        const SurgeryCloth cloth = square_cloth(8);
        ClothSurgery surgery = cloth.surgery();
        expect_on_line(surgery, cut(surgery, target_of(cloth), from, to), 1, 0.0);
        EXPECT_EQ(surgery.vertex_count(), 81);
        EXPECT_EQ(clean_up(surgery, target_of(cloth)).operations(), 0);
    }
}

TEST(JoinTraceVertices, NextToMeshLinesSnapsOrSplitsCleanly)
{
    const SurgeryCloth cloth = square_cloth(8);
    for (int power = -17; power <= -2; ++power)
        for (const double sign : {-1.0, 1.0})
            for (const double turn : {0.0, 1.0}) {
                ClothSurgery surgery = cloth.surgery();
                const SurgeryCheck check(surgery);
                const double off = sign * std::pow(10.0, power);
                const TraceJoin join =
                    cut(surgery, target_of(cloth), {0.25, 0.5 + off}, {0.75, 0.5 - turn * off});
                expect_on_line(surgery, join, 1, kStraight);
                EXPECT_EQ(check.find_wrong(surgery), "");
                clean_up(surgery, target_of(cloth));
                EXPECT_EQ(check.find_wrong(surgery), "");
            }
}

TEST(JoinTraceVertices, OneUnitInTheLastPlaceBesideVerticesIsNoTrouble)
{
    const SurgeryCloth cloth = square_cloth(8);
    for (const double y : {std::nextafter(0.5, 0.0), std::nextafter(0.5, 1.0)}) {
        ClothSurgery surgery = cloth.surgery();
        expect_on_line(surgery, cut(surgery, target_of(cloth), {0.1, y}, {0.9, 0.5}), 1, kStraight);
        EXPECT_EQ(SurgeryCheck(cloth.surgery()).find_wrong(surgery), "");
    }
}

TEST(JoinTraceVertices, EndsOnVerticesEdgesBorderAndCorner)
{
    const std::vector<Vec2> ends = {{0.5, 0.5},  {0.53, 0.5}, {0.57, 0.52}, {0.5, 0.0},
                                    {0.53, 0.0}, {1.0, 0.3},  {0.125, 1.0}, {0.3, 1.0}};
    const SurgeryCloth cloth = square_cloth(8);
    for (const Vec2& a : ends)
        for (const Vec2& b : ends) {
            // Lines along the border are excluded.
            if (a == b || (a.y() == b.y() && (a.y() == 0.0 || a.y() == 1.0))) continue;
            ClothSurgery surgery = cloth.surgery();
            const TraceJoin join = cut(surgery, target_of(cloth), a, b);
            EXPECT_EQ(SurgeryCheck(cloth.surgery()).find_wrong(surgery), "");
            if ((a - b).norm() > 0.1) {
                SCOPED_TRACE(fmt::format("({}, {}) ({}, {})", a.x(), a.y(), b.x(), b.y()));
                expect_on_line(surgery, join, 1, kStraight);
            }
        }
    // A corner of the cloth is never used, but an edge next to the corner is.
    ClothSurgery surgery = cloth.surgery();
    EXPECT_EQ(cut(surgery, target_of(cloth), {0.0, 0.0}, {0.5, 0.4}).verdict, Verdict::Fixed);
    EXPECT_EQ(cut(surgery, target_of(cloth), {1e-6, 0.0}, {0.0, 1e-6}).verdict, Verdict::Quality);
    EXPECT_EQ(SurgeryCheck(cloth.surgery()).find_wrong(surgery), "");
}

TEST(JoinTraceVertices, BesideTheBorderIsRefusedOrValid)
{
    const SurgeryCloth cloth = square_cloth(8);
    for (int power = -9; power <= -2; ++power) {
        ClothSurgery surgery = cloth.surgery();
        const double y = std::pow(10.0, power);
        cut(surgery, target_of(cloth), {0.2, y}, {0.9, y});
        EXPECT_EQ(SurgeryCheck(cloth.surgery()).find_wrong(surgery), "") << y;
        clean_up(surgery, target_of(cloth));
        EXPECT_EQ(SurgeryCheck(cloth.surgery()).find_wrong(surgery), "") << y;
    }
}

TEST(JoinTraceVertices, DoesNotLeaveTheCloth)
{
    for (const SurgeryCloth& cloth : {bay_cloth(9), holed_cloth(9)}) {
        ClothSurgery surgery = cloth.surgery();
        const SurgeryCheck check(surgery);
        EXPECT_EQ(cut(surgery, target_of(cloth), {0.15, 0.55}, {0.85, 0.52}).verdict, Verdict::Border);
        // Only the ends of the failed attempt remain.
        EXPECT_TRUE(surgery.result().tagged_edges.empty());
        EXPECT_EQ(check.find_wrong(surgery), "");
        EXPECT_EQ(cut(surgery, target_of(cloth), {0.1, 0.18}, {0.9, 0.12}).verdict, Verdict::Done);
        EXPECT_EQ(check.find_wrong(surgery), "");
    }
}

TEST(JoinTraceVertices, DoesNotCrossAnotherTraceButAtACommonNode)
{
    const SurgeryCloth cloth = square_cloth(12, 0.2);
    ClothSurgery surgery = cloth.surgery();
    const SurgeryCheck check(surgery);
    const MeshTarget target = target_of(cloth);
    ASSERT_EQ(cut(surgery, target, {0.2, 0.5}, {0.8, 0.52}, 1).verdict, Verdict::Done);
    const std::size_t edges = surgery.result().tagged_edges.size();
    EXPECT_EQ(cut(surgery, target, {0.5, 0.2}, {0.53, 0.8}, 2).verdict, Verdict::Trace);
    EXPECT_EQ(surgery.result().tagged_edges.size(), edges);
    EXPECT_EQ(check.find_wrong(surgery), "");
    release_all(surgery);
    // The traces may cross at a common node.
    const TraceInsertion node = insert(surgery, target, {0.51, 0.51}, 3);
    for (const Vec2& end : {Vec2(0.2, 0.5), Vec2(0.8, 0.52), Vec2(0.5, 0.2), Vec2(0.53, 0.8)}) {
        const TraceInsertion far = insert(surgery, target, end, 3);
        EXPECT_EQ(join_trace_vertices(surgery, target, node.vertex, far.vertex, 3).verdict, Verdict::Done);
    }
    clean_up(surgery, target);
    EXPECT_EQ(check.find_wrong(surgery), "");
}

TEST(JoinTraceVertices, ParallelTracesFarCloserThanTheMeshAreBothCut)
{
    const SurgeryCloth cloth = square_cloth(12);
    for (const double gap : {1e-2, 1e-3, 1e-4}) {
        ClothSurgery surgery = cloth.surgery();
        const SurgeryCheck check(surgery);
        const MeshTarget target = target_of(cloth);
        EXPECT_EQ(cut(surgery, target, {0.21, 0.53}, {0.79, 0.55}, 1).verdict, Verdict::Done);
        const TraceJoin join = cut(surgery, target, {0.21, 0.53 + gap}, {0.79, 0.55 + gap}, 2);
        EXPECT_EQ(join.verdict, Verdict::Done) << gap << " " << to_string(join.verdict);
        for (int k = 0; k < 5; ++k) {
            clean_up(surgery, target);
            ASSERT_EQ(check.find_wrong(surgery), "");
        }
        EXPECT_LE(surgery.vertex_count(), 1.2 * 169) << gap;
    }
}

TEST(JoinTraceVertices, ThreeFeaturesAtTwentyDegrees)
{
    const SurgeryCloth cloth = square_cloth(30, 0.2);
    ClothSurgery surgery = cloth.surgery();
    const SurgeryCheck check(surgery);
    const MeshTarget target = target_of(cloth);
    const Vec2 corner(0.41, 0.52);
    const TraceInsertion node = insert(surgery, target, corner, 0);
    for (int k = 0; k < 3; ++k) {
        const double angle = 0.35 * k;
        const TraceInsertion end =
            insert(surgery, target, corner + 0.3 * Vec2(std::cos(angle), std::sin(angle)), k);
        const TraceJoin join = join_trace_vertices(surgery, target, node.vertex, end.vertex, k);
        EXPECT_EQ(join.verdict, Verdict::Done) << to_string(join.verdict);
    }
    clean_up(surgery, target);
    EXPECT_EQ(check.find_wrong(surgery), "");
    EXPECT_GT(least_material_angle(surgery.result().mesh), 7.0);
}

// Inside an ordinary mesh a join always succeeds, wherever vertices are near the line and its ends.
TEST(JoinTraceVertices, LinesInsideAnIrregularMeshAreNotRefused)
{
    std::mt19937 random(21);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const auto inside = [&] {
        const double u = unit(random);
        return Vec2(0.3 + 0.4 * u, 0.3 + 0.4 * unit(random));
    };
    int lines = 0;
    for (unsigned seed = 0; seed < 3000; ++seed) {
        const SurgeryCloth cloth = square_cloth(16, 0.25, seed);
        const Vec2 from = inside();
        const Vec2 to = inside();
        if ((from - to).norm() < 0.15) continue;
        ClothSurgery surgery = cloth.surgery();
        ++lines;
        expect_on_line(surgery, cut(surgery, target_of(cloth), from, to), 1, kStraight);
    }
    EXPECT_GT(lines, 2000);
}

TEST(JoinTraceVertices, WalkEndsOnMeshesWithoutAltitude)
{
    std::mt19937 random(4);
    std::uniform_real_distribution<double> unit(0.03, 0.97);
    std::map<Verdict, int> verdicts;
    for (unsigned seed = 0; seed < 60; ++seed) {
        const SurgeryCloth cloth = sabotaged_cloth(8, seed);
        ClothSurgery surgery = cloth.surgery();
        const SurgeryCheck check(surgery);
        for (int k = 0; k < 5; ++k) {
            const Vec2 from(unit(random), unit(random));
            const Vec2 to(unit(random), unit(random));
            ++verdicts[cut(surgery, target_of(cloth), from, to).verdict];
            ASSERT_EQ(check.find_wrong(surgery), "") << cloth.name;
            release_all(surgery);
            if (k == 3) clean_up(surgery, target_of(cloth));
            ASSERT_EQ(check.find_wrong(surgery), "") << cloth.name;
        }
    }
    for (const auto& [verdict, count] : verdicts) fmt::print("  {}: {}\n", to_string(verdict), count);
    EXPECT_GT(verdicts[Verdict::Done], 150);
}

TEST(JoinTraceVertices, RandomLinesInTurnKeepMeshAndVertexCount)
{
    std::mt19937 random(6);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (const SurgeryCloth& cloth :
         {square_cloth(16, 0.2), placed(square_cloth(16, 0.2), 1e-3, {0, 0}),
          placed(square_cloth(16), 1e3, {0, 0}), placed(square_cloth(16, 0.2), 1.0, {1000, 1000}),
          bay_cloth(15), holed_cloth(15)}) {
        ClothSurgery surgery = cloth.surgery();
        const SurgeryCheck check(surgery);
        const MeshTarget target = target_of(cloth);
        const Vec2 origin = cloth.mesh.material[0];
        double size = 0.0;
        for (const Vec2& X : cloth.mesh.material) size = std::max(size, X.x() - origin.x());
        std::map<Verdict, int> verdicts;
        int most = 0;
        for (int k = 0; k < 300; ++k) {
            // The ends are at distances from tiny to arbitrary from the mesh's own vertices.
            const SurgeryResult now = surgery.result();
            const auto pick = [&]() -> Vec2 {
                const std::size_t v =
                    std::min(std::size_t(unit(random) * double(now.ids.size())), now.ids.size() - 1);
                const double off = std::pow(10.0, -17.0 + 16.0 * unit(random));
                const Vec2 by(off * (unit(random) - 0.5), off * (unit(random) - 0.5));
                const Vec2 X = now.mesh.material[v] + size * by;
                return X.cwiseMax(origin).cwiseMin(origin + Vec2(size, size));
            };
            const Vec2 from = pick();
            const Vec2 to = pick();
            const TraceJoin join = cut(surgery, target, from, to);
            ++verdicts[join.verdict];
            ASSERT_EQ(check.find_wrong(surgery), "") << cloth.name << " line " << k;
            clean_up(surgery, target);
            ASSERT_EQ(check.find_wrong(surgery), "") << cloth.name << " line " << k;
            release_all(surgery);
            clean_up(surgery, target);
            most = std::max(most, surgery.vertex_count());
        }
        fmt::print("{}: vertices {} most {};", cloth.name, cloth.mesh.vertex_count(), most);
        for (const auto& [verdict, count] : verdicts) fmt::print(" {} {}", to_string(verdict), count);
        fmt::print("\n");
        EXPECT_LE(most, 1.2 * cloth.mesh.vertex_count()) << cloth.name;
        EXPECT_EQ(verdicts[Verdict::Budget], 0);
    }
}

}  // namespace
}  // namespace arris
