// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surgery/trace_clearing.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "geometry/cloth/mesh_quality.h"
#include "geometry/surgery/surgery_cleanup.h"
#include "geometry/surgery/trace_insertion.h"
#include "tests/geometry/surgery_cloths.h"
#include "tests/geometry/trace_motion.h"

namespace arris {
namespace {

constexpr double kAngle = 15.0;

// Inserts a polyline and returns the vertices at its corners. Fails the test if the insertion is refused.
std::vector<VertexId> cut(ClothSurgery& surgery, const MeshTarget& target, const std::vector<Vec2>& line,
                          int tag)
{
    std::vector<VertexId> nodes;
    for (const Vec2& X : line) {
        const TraceInsertion made =
            insert_trace_point(surgery, target, X, nearest_vertex(surgery, X), {TraceRole::Node, tag});
        EXPECT_EQ(made.verdict, Verdict::Done) << to_string(made.verdict) << " at " << X.transpose();
        nodes.push_back(made.vertex);
    }
    for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
        const TraceJoin join = join_trace_vertices(surgery, target, nodes[k], nodes[k + 1], tag);
        EXPECT_EQ(join.verdict, Verdict::Done) << to_string(join.verdict);
    }
    return nodes;
}

// All trace vertices of a tag, moved by one vector.
std::vector<VertexMove> shifted(const ClothSurgery& surgery, int tag, const Vec2& by)
{
    std::vector<VertexMove> moves;
    const SurgeryResult result = surgery.result();
    for (std::size_t k = 0; k < result.ids.size(); ++k)
        if (result.roles[k] != TraceRole::Free && result.tags[k] == tag)
            moves.push_back({result.ids[k], result.mesh.material[k] + by});
    return moves;
}

MeshTarget target_of(const SurgeryCloth& cloth)
{
    return uniform_target(1.14 * cloth.cell, kAngle);
}

VertexId trace_vertex(const ClothSurgery& surgery, const Vec2& near)
{
    const VertexId v = nearest_vertex(surgery, near);
    EXPECT_NE(surgery.role(v), TraceRole::Free);
    return v;
}

// Measures for a sweep of the trace.
struct SweepFigures {
    int most_vertices = 0;
    std::vector<double> least_angles;  // least angle of the whole mesh after each step, degrees

    void add(const ClothSurgery& surgery)
    {
        most_vertices = std::max(most_vertices, surgery.vertex_count());
        least_angles.push_back(least_material_angle(surgery.result().mesh));
    }
    double least() const { return *std::min_element(least_angles.begin(), least_angles.end()); }
    double percentile(double p) const
    {
        std::vector<double> sorted = least_angles;
        std::sort(sorted.begin(), sorted.end());
        return sorted[std::min(sorted.size() - 1, static_cast<std::size_t>(p * double(sorted.size())))];
    }
    void print(const std::string& name, int vertices) const
    {
        fmt::print("{}: {} steps, vertices {} most {}, least angle {:.2f} p5 {:.2f} median {:.2f}\n", name,
                   least_angles.size(), vertices, most_vertices, least(), percentile(0.05), percentile(0.5));
    }
};

// --- clearing

TEST(ClearAhead, LeavesRoomForTheWholeWay)
{
    const SurgeryCloth cloth = square_cloth(16, 0.2);
    for (const double way : {1e-6, 0.01, 0.05, 0.15}) {
        ClothSurgery surgery = cloth.surgery();
        const SurgeryCheck check(surgery);
        const MeshTarget target = target_of(cloth);
        cut(surgery, target, {{0.2, 0.4}, {0.5, 0.45}, {0.8, 0.4}}, 1);
        clean_up(surgery, target);
        std::vector<TraceShift> shifts;
        for (const VertexMove& move : shifted(surgery, 1, {0, way}))
            shifts.push_back({move.vertex, {0, way}});
        EXPECT_TRUE(clear_ahead(surgery, target, shifts).blocked.empty());
        EXPECT_EQ(check.find_wrong(surgery), "");
        // At least the way and 30 % of the target length are clear. On this way no face is inverted.
        const double clear = std::max(way, 0.3 * 1.14 * cloth.cell);
        for (const double part : {0.1, 0.5, 0.99})
            EXPECT_TRUE(surgery.propose_moves(shifted(surgery, 1, {0, part * clear})).is_legal()) << way;
        // A motion by 30 % of the clear distance takes at most about 30 % of any face's area.
        const SurgeryProposal proposal = surgery.propose_moves(shifted(surgery, 1, {0, 0.3 * clear}));
        for (std::size_t f = 0; f < proposal.event.before.size(); ++f) {
            const auto area = [](const PatchFace& face) {
                return twice_area(face.material[0], face.material[1], face.material[2]);
            };
            EXPECT_GT(area(proposal.event.after[f]), 0.69 * area(proposal.event.before[f]));
        }
    }
}

TEST(ClearAhead, ThreeTenthsOfTheTargetLengthAreClearHoweverSmallTheStep)
{
    const SurgeryCloth cloth = square_cloth(8);
    const MeshTarget target = target_of(cloth);
    for (const double height : {0.2, 0.45}) {
        ClothSurgery surgery = cloth.surgery();
        cut(surgery, target, {{0.25, 0.5}, {0.75, 0.5}}, 1);
        const VertexId node = trace_vertex(surgery, {0.25, 0.5});
        const VertexId above = nearest_vertex(surgery, {0.25, 0.625});
        const SurgeryProposal split = surgery.propose_edge_split(node, above, height);
        ASSERT_EQ(surgery.commit(split), Verdict::Done);
        std::vector<TraceShift> shifts;
        for (const VertexMove& move : shifted(surgery, 1, {0, 0})) shifts.push_back({move.vertex, {0, 1e-9}});
        EXPECT_TRUE(clear_ahead(surgery, target, shifts).blocked.empty());
        EXPECT_EQ(surgery.has_vertex(split.event.changes[0].vertex), height > 0.3 * 1.14);
    }
}

TEST(ClearAhead, WhatCannotBeClearedBlocksNothingBeforeItIsReached)
{
    const SurgeryCloth cloth = square_cloth(8);
    const MeshTarget target = target_of(cloth);
    const auto clear = [&](double height, double way) {
        ClothSurgery surgery = cloth.surgery();
        cut(surgery, target, {{0.25, 0.5}, {0.75, 0.5}}, 1);
        const VertexId node = trace_vertex(surgery, {0.25, 0.5});
        surgery.commit(surgery.propose_edge_split(node, nearest_vertex(surgery, {0.25, 0.625}), height));
        surgery.set_guard([](const SurgeryEvent&) { return false; });
        const ClearanceReport report = clear_ahead(surgery, target, {{node, {0.0, way}}});
        EXPECT_NEAR(report.ways.at(node).y(), std::max(way, 0.3 * 1.14 * cloth.cell), 1e-3);
        EXPECT_EQ(report.needed.at(node).y(), way);
        return report.blocked.empty();
    };
    EXPECT_TRUE(clear(0.2, 1e-9));
    EXPECT_TRUE(clear(0.2, 0.19 * cloth.cell));
    EXPECT_FALSE(clear(0.2, 0.21 * cloth.cell));
    EXPECT_TRUE(clear(0.45, 1e-9));
}

TEST(ClearAhead, WhatItCallsClearIsClearForRandomTracesAndWays)
{
    std::mt19937 random(21);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const auto inside = [&] {
        const double u = unit(random);
        return Vec2(0.3 + 0.4 * u, 0.3 + 0.4 * unit(random));
    };
    int blocked = 0, trials = 0;
    for (unsigned seed = 0; seed < 600; ++seed) {
        const SurgeryCloth cloth = square_cloth(16, 0.25, seed);
        ClothSurgery surgery = cloth.surgery();
        const SurgeryCheck check(surgery);
        const MeshTarget target = target_of(cloth);
        const std::vector<Vec2> line = {inside(), inside(), inside()};
        // Bends sharper than the mesh resolves are tested elsewhere.
        if ((line[0] - line[1]).norm() < 0.15 || (line[2] - line[1]).norm() < 0.15 ||
            (line[0] - line[1]).normalized().dot((line[2] - line[1]).normalized()) > 0.5)
            continue;
        cut(surgery, target, line, 1);
        clean_up(surgery, target);
        const double angle = 6.28 * unit(random);
        const Vec2 way = 2.5 * cloth.cell * unit(random) * Vec2(std::cos(angle), std::sin(angle));
        std::vector<TraceShift> shifts;
        for (const VertexMove& move : shifted(surgery, 1, way)) shifts.push_back({move.vertex, way});
        const bool is_blocked = !clear_ahead(surgery, target, shifts).blocked.empty();
        ASSERT_EQ(check.find_wrong(surgery), "") << seed;
        ++trials;
        blocked += is_blocked ? 1 : 0;
        if (is_blocked) continue;
        for (const double part : {0.05, 0.25, 0.5, 1.0})
            EXPECT_TRUE(surgery.propose_moves(shifted(surgery, 1, part * way)).is_legal()) << seed;
    }
    fmt::print("{} of {} blocked\n", blocked, trials);
    EXPECT_GT(trials, 60);
    EXPECT_EQ(blocked, 0);
}

/// The corner of an L moves along one of its arms. The arm's own vertices hardly move, so they are in the
/// corner's way.
std::vector<VertexMove> corner_moves(const ClothSurgery& surgery, const Vec2& way)
{
    std::vector<VertexMove> moves;
    for (const VertexMove& move : shifted(surgery, 1, {0, 0})) {
        const bool is_on_arm = move.material.x() < 0.5 - 1e-9;
        moves.push_back({move.vertex, move.material + (is_on_arm ? Vec2(0, -1e-6) : way)});
    }
    return moves;
}

TEST(ClearAhead, ACornerThatSlidesAlongItsEdgeTakesInTheVerticesOfTheEdge)
{
    const SurgeryCloth cloth = square_cloth(8);
    const MeshTarget target = target_of(cloth);
    const Vec2 way(-0.2, 0.0);
    ClothSurgery surgery = cloth.surgery();
    const SurgeryCheck check(surgery);
    const VertexId corner = cut(surgery, target, {{0.25, 0.5}, {0.5, 0.5}, {0.5, 0.25}}, 1)[1];
    const VertexId on_arm = trace_vertex(surgery, {0.375, 0.5});
    const VertexId end = trace_vertex(surgery, {0.25, 0.5});
    std::vector<TraceShift> shifts;
    for (const VertexMove& move : corner_moves(surgery, way))
        shifts.push_back({move.vertex, move.material - surgery.material(move.vertex)});
    EXPECT_TRUE(clear_ahead(surgery, target, shifts).blocked.empty());
    EXPECT_EQ(check.find_wrong(surgery), "");
    EXPECT_FALSE(surgery.has_vertex(on_arm));
    EXPECT_NE(surgery.edge_tag(corner, end), kNoTag);
    EXPECT_TRUE(surgery.propose_moves(corner_moves(surgery, way)).is_legal());

    // The trace is now moved this way; the nodes at both ends stay.
    ClothSurgery moved = cloth.surgery();
    cut(moved, target, {{0.25, 0.5}, {0.5, 0.5}, {0.5, 0.25}}, 1);
    EXPECT_EQ(move_trace(moved, target, corner_moves(moved, way)).verdict, Verdict::Done);
    EXPECT_EQ(check.find_wrong(moved), "");
    EXPECT_TRUE(moved.has_vertex(corner) && moved.has_vertex(end));
    ClothSurgery stopped = cloth.surgery();
    cut(stopped, target, {{0.25, 0.5}, {0.5, 0.5}, {0.5, 0.25}}, 1);
    EXPECT_NE(move_trace(stopped, target, corner_moves(stopped, 1.3 * way)).verdict, Verdict::Done);
    EXPECT_EQ(check.find_wrong(stopped), "");
    EXPECT_TRUE(stopped.has_vertex(corner) && stopped.has_vertex(end));
}

TEST(ClearAhead, LeavesNoFaceOfWhichRoundingDecidesWhichSideIsUp)
{
    // Three vertices that are collinear up to rounding must not become a face, even if rounding makes its
    // area positive.
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    double least = 180.0;
    for (unsigned seed = 0; seed < 200; ++seed) {
        const SurgeryCloth cloth = square_cloth(8, 0.2, seed);
        ClothSurgery surgery = cloth.surgery();
        const MeshTarget target = target_of(cloth);
        cut(surgery, target, {{0.25, 0.5}, {0.75, 0.5}}, 1);
        for (const VertexId v : surgery.result().ids)
            for (const VertexId w : surgery.ring(v).vertices)
                if (unit(random) < 0.05) surgery.commit(surgery.propose_edge_split(v, w, 0.3));
        std::vector<TraceShift> shifts;
        for (const VertexMove& move : shifted(surgery, 1, {0, 0}))
            shifts.push_back({move.vertex, {0.05 * unit(random), 0.2 * unit(random)}});
        clear_ahead(surgery, target, shifts);
        least = std::min(least, least_material_angle(surgery.result().mesh));
    }
    EXPECT_GT(least, 0.09);
}

TEST(ClearAhead, NamesWhatItCannotClear)
{
    const SurgeryCloth cloth = square_cloth(8);
    const MeshTarget target = target_of(cloth);
    ClothSurgery surgery = cloth.surgery();
    const SurgeryCheck check(surgery);
    cut(surgery, target, {{0.25, 0.125}, {0.75, 0.125}}, 1);
    const VertexId node = trace_vertex(surgery, {0.25, 0.125});
    // The border is 0.125 away.
    EXPECT_TRUE(clear_ahead(surgery, target, {{node, {0.0, -0.1}}}).blocked.empty());
    EXPECT_EQ(clear_ahead(surgery, target, {{node, {0.0, -0.13}}}).blocked, (std::vector<VertexId>{node}));
    EXPECT_EQ(check.find_wrong(surgery), "");
    // Beyond the required share of its way nothing needs to be cleared.
    EXPECT_TRUE(clear_ahead(surgery, target, {{node, {0.0, -0.2}, 0.5}}).blocked.empty());
    EXPECT_EQ(clear_ahead(surgery, target, {{node, {0.0, -0.26}, 0.5}}).blocked,
              (std::vector<VertexId>{node}));
    // A vertex at rest needs no clearing.
    EXPECT_EQ(clear_ahead(surgery, target, {{node, {0.0, 0.0}}}).operations, 0);
}

// Room beyond the border is not needed, so no vertex of the border is merged to make room.
TEST(ClearAhead, TheBorderStaysAsItIsWhereATraceComesNearIt)
{
    for (const SurgeryCloth& cloth : {square_cloth(8), turned_cloth(8)}) {
        const MeshTarget target = target_of(cloth);
        ClothSurgery surgery = cloth.surgery();
        const Vec2 u = surgery.material(nearest_vertex(surgery, {1, 0})), v(-u.y(), u.x());
        cut(surgery, target, {0.1 * u + 0.03 * v, 0.9 * u + 0.03 * v}, 1);
        clean_up(surgery, target);
        const int vertices = surgery.vertex_count();
        std::vector<TraceShift> shifts;
        for (const VertexMove& move : shifted(surgery, 1, {0, 0})) {
            // Some ways lead beyond the border, where only the share of the way on the cloth must be clear.
            const bool is_tip = shifts.size() % 2 == 1;
            shifts.push_back({move.vertex, (is_tip ? -0.04 : -0.02) * v, is_tip ? 0.5 : 1.0});
        }
        EXPECT_GT(shifts.size(), 5u);
        EXPECT_TRUE(clear_ahead(surgery, target, shifts).blocked.empty()) << cloth.name;
        EXPECT_EQ(surgery.vertex_count(), vertices) << cloth.name;
    }
}

TEST(ClearAhead, IsBlockedByFixedVerticesOtherTracesAndTheGuard)
{
    const SurgeryCloth cloth = square_cloth(8);
    const MeshTarget target = target_of(cloth);
    const auto blocked = [&](ClothSurgery& surgery) {
        cut(surgery, target, {{0.25, 0.25}, {0.75, 0.25}}, 1);
        std::vector<TraceShift> shifts;
        for (const VertexMove& move : shifted(surgery, 1, {0, 0.3}))
            shifts.push_back({move.vertex, {0, 0.3}});
        const SurgeryCheck check(surgery);
        const bool is_blocked = !clear_ahead(surgery, target, shifts).blocked.empty();
        EXPECT_EQ(check.find_wrong(surgery), "");
        return is_blocked;
    };
    ClothSurgery open = cloth.surgery();
    EXPECT_FALSE(blocked(open));
    ClothSurgery pinned(cloth.mesh, cloth.ids(), 81, {nearest_vertex(open, {0.5, 0.5})});
    pinned = ClothSurgery(cloth.mesh, cloth.ids(), 81, {40});
    EXPECT_TRUE(blocked(pinned));
    EXPECT_TRUE(pinned.has_vertex(40));
    ClothSurgery crossed = cloth.surgery();
    cut(crossed, target, {{0.25, 0.5}, {0.75, 0.5}}, 2);
    EXPECT_TRUE(blocked(crossed));
    ClothSurgery guarded = cloth.surgery();
    cut(guarded, target, {{0.25, 0.25}, {0.75, 0.25}}, 1);
    guarded.set_guard([](const SurgeryEvent&) { return false; });
    EXPECT_TRUE(blocked(guarded));
}

TEST(ClearAhead, TracesNearerThanTheRoomAheadAreInEachOthersWayOnlyWhereTheyMeet)
{
    const SurgeryCloth cloth = square_cloth(16);
    const MeshTarget target = target_of(cloth);
    constexpr double kGap = 0.01;  // half of the room that is cleared at any step size
    for (const double way : {1e-9, 0.3 * kGap, 0.7 * kGap}) {
        ClothSurgery surgery = cloth.surgery();
        const SurgeryCheck check(surgery);
        cut(surgery, target, {{0.2, 0.4}, {0.8, 0.4}}, 1);
        cut(surgery, target, {{0.2, 0.4 + kGap}, {0.8, 0.4 + kGap}}, 2);
        clean_up(surgery, target);
        const std::vector<VertexMove> low = shifted(surgery, 1, {0, way}),
                                      high = shifted(surgery, 2, {0, -way});
        std::vector<TraceShift> shifts;
        for (const VertexMove& move : low) shifts.push_back({move.vertex, {0, way}});
        for (const VertexMove& move : high) shifts.push_back({move.vertex, {0, -way}});
        const ClearanceReport cleared = clear_ahead(surgery, target, shifts);
        EXPECT_EQ(cleared.blocked.empty(), 2.0 * way < kGap) << way;
        EXPECT_EQ(check.find_wrong(surgery), "");
        if (2.0 * way > kGap) continue;
        EXPECT_EQ(shifted(surgery, 1, {0, 0}).size(), low.size()) << way;  // no vertex is merged
        EXPECT_EQ(shifted(surgery, 2, {0, 0}).size(), high.size()) << way;
    }
}

// --- motion

TEST(MoveTrace, FarInOneCallPassesManyCells)
{
    for (const SurgeryCloth& cloth :
         {square_cloth(20, 0.2), placed(square_cloth(20, 0.2), 1e-3, {0, 0}),
          placed(square_cloth(20, 0.2), 1e3, {0, 0}), placed(square_cloth(20, 0.2), 1.0, {1000, 1000})}) {
        ClothSurgery surgery = cloth.surgery();
        const SurgeryCheck check(surgery);
        const MeshTarget target = target_of(cloth);
        const Vec2 origin = cloth.mesh.material[0];
        const double size = 20 * cloth.cell;
        cut(surgery, target,
            {origin + size * Vec2(0.2, 0.1), origin + size * Vec2(0.5, 0.15), origin + size * Vec2(0.8, 0.1)},
            1);
        const TraceMotionReport report = move_trace(surgery, target, shifted(surgery, 1, {0, 0.75 * size}));
        EXPECT_EQ(report.verdict, Verdict::Done) << cloth.name << to_string(report.verdict);
        EXPECT_EQ(report.fraction, 1.0);
        EXPECT_EQ(check.find_wrong(surgery), "") << cloth.name;
        const Vec2 node = origin + size * Vec2(0.5, 0.9);
        EXPECT_LT((surgery.material(trace_vertex(surgery, node)) - node).norm(),
                  1e-12 * size + 1e-15 * origin.norm() * 100);
        EXPECT_LE(surgery.vertex_count(), 1.2 * cloth.mesh.vertex_count());
    }
}

TEST(MoveTrace, ChordFromBorderToBorderSlidesAlongIt)
{
    const SurgeryCloth cloth = square_cloth(16);
    ClothSurgery surgery = cloth.surgery();
    const SurgeryCheck check(surgery);
    const MeshTarget target = target_of(cloth);
    cut(surgery, target, {{0.0, 0.3}, {1.0, 0.35}}, 1);
    SweepFigures figures;
    for (int step = 0; step < 200; ++step) {
        const double by = (step / 20 % 2 == 0 ? 0.027 : -0.027);
        ASSERT_EQ(move_trace(surgery, target, shifted(surgery, 1, {0, by})).verdict, Verdict::Done) << step;
        ASSERT_EQ(check.find_wrong(surgery), "") << step;
        figures.add(surgery);
    }
    figures.print("chord", cloth.mesh.vertex_count());
    EXPECT_LE(figures.most_vertices, 1.2 * cloth.mesh.vertex_count());
    EXPECT_GT(figures.percentile(0.05), 10.0);
}

// Every new place on a slanted border is off the border by rounding, but the border must not drift.
TEST(MoveTrace, ChordSlidesAlongASlantedBorder)
{
    for (const Vec2& offset : {Vec2(0, 0), Vec2(1000, 1000)}) {
        const SurgeryCloth cloth = placed(turned_cloth(12), 1.0, offset);
        ClothSurgery surgery = cloth.surgery();
        const SurgeryCheck check(surgery);
        const MeshTarget target = target_of(cloth);
        const Vec2 u(std::cos(0.3), std::sin(0.3)), v(-u.y(), u.x());
        cut(surgery, target, {offset + 0.25 * v, offset + u + 0.25 * v}, 1);
        for (int step = 0; step < 100; ++step) {
            const double by = (step / 20 % 2 == 0 ? 0.0271 : -0.0271);
            const TraceMotionReport report = move_trace(surgery, target, shifted(surgery, 1, by * v));
            ASSERT_EQ(report.verdict, Verdict::Done) << step << " " << to_string(report.verdict);
            ASSERT_EQ(check.find_wrong(surgery), "") << step;
        }
        EXPECT_LE(surgery.vertex_count(), 1.2 * cloth.mesh.vertex_count());
    }
}

TEST(MoveTrace, StopsInFrontOfCornersAndHolesAndSaysWhere)
{
    const SurgeryCloth cloth = square_cloth(16);
    ClothSurgery chord = cloth.surgery();
    const MeshTarget target = target_of(cloth);
    cut(chord, target, {{0.0, 0.8}, {1.0, 0.8}}, 1);
    const TraceMotionReport at_corner = move_trace(chord, target, shifted(chord, 1, {0, 0.5}));
    EXPECT_NE(at_corner.verdict, Verdict::Done);
    EXPECT_GT(at_corner.fraction, 0.2);
    EXPECT_LT(at_corner.fraction, 0.4);
    EXPECT_FALSE(at_corner.blocked.empty());
    EXPECT_EQ(SurgeryCheck(cloth.surgery()).find_wrong(chord), "");

    const SurgeryCloth holed = holed_cloth(15);
    ClothSurgery surgery = holed.surgery();
    cut(surgery, target_of(holed), {{0.2, 0.15}, {0.8, 0.15}}, 1);
    EXPECT_NE(move_trace(surgery, target_of(holed), shifted(surgery, 1, {0, 0.5})).verdict, Verdict::Done);
    EXPECT_EQ(SurgeryCheck(holed.surgery()).find_wrong(surgery), "");
}

TEST(MoveTrace, RefusesWhatIsNoMotion)
{
    const SurgeryCloth cloth = square_cloth(8);
    ClothSurgery surgery = cloth.surgery();
    const MeshTarget target = target_of(cloth);
    EXPECT_EQ(move_trace(surgery, target, {{999, {0.5, 0.5}}}).verdict, Verdict::Missing);
    EXPECT_EQ(move_trace(surgery, target, {{40, {std::nan(""), 0.5}}}).verdict, Verdict::Argument);
    EXPECT_EQ(move_trace(surgery, target, {}).verdict, Verdict::Done);
    EXPECT_TRUE(is_same(surgery.result(), cloth.surgery().result()));
}

TEST(MoveTrace, WorldPositionsStayWhereTheyAreGiven)
{
    const SurgeryCloth cloth = square_cloth(12);
    ClothSurgery surgery = cloth.surgery();
    const MeshTarget target = target_of(cloth);
    cut(surgery, target, {{0.25, 0.5}, {0.75, 0.5}}, 1);
    const VertexId node = trace_vertex(surgery, {0.25, 0.5});
    const Vec3 x = surgery.world(node);
    std::vector<VertexMove> moves = shifted(surgery, 1, {0.0, 0.2});
    for (VertexMove& move : moves) move.keeps_world = true;
    ASSERT_EQ(move_trace(surgery, target, moves).verdict, Verdict::Done);
    EXPECT_EQ(surgery.world(node), x);
    EXPECT_LT((surgery.material(node) - Vec2(0.25, 0.7)).norm(), 1e-15);
}

// Three traces from one corner, 20 degrees apart, slide, turn and jump by up to two cells.
TEST(MoveTrace, CornerOfThreeFeaturesWandersOverTheCloth)
{
    const SurgeryCloth cloth = square_cloth(30, 0.2);
    ClothSurgery surgery = cloth.surgery();
    const SurgeryCheck check(surgery);
    const MeshTarget target = target_of(cloth);
    Vec2 centre(0.5, 0.5);
    const auto node = insert_trace_point(surgery, target, centre, 0, {TraceRole::Node, 1});
    for (int k = 0; k < 3; ++k) {
        const Vec2 X = centre + 0.2 * Vec2(std::cos(0.35 * k), std::sin(0.35 * k));
        const auto end = insert_trace_point(surgery, target, X, node.vertex, {TraceRole::Node, 1});
        ASSERT_EQ(join_trace_vertices(surgery, target, node.vertex, end.vertex, 1).verdict, Verdict::Done);
    }
    clean_up(surgery, target);
    SweepFigures figures;
    for (int step = 0; step < 300; ++step) {
        const Vec2 next = Vec2(0.5, 0.5) + 0.2 * Vec2(std::sin(0.11 * step), std::sin(0.07 * step));
        const Vec2 by = step % 10 == 0 ? Vec2(2.0 * cloth.cell, 0.0) : Vec2(next - centre);
        const Vec2 back = step % 10 == 0 ? Vec2(-by) : Vec2::Zero();
        std::vector<VertexMove> moves = shifted(surgery, 1, by);
        for (VertexMove& move : moves) {
            const Vec2 arm = move.material - by - centre;
            move.material += 0.03 * Vec2(-arm.y(), arm.x());
        }
        ASSERT_EQ(move_trace(surgery, target, moves).verdict, Verdict::Done) << step;
        ASSERT_EQ(move_trace(surgery, target, shifted(surgery, 1, back)).verdict, Verdict::Done) << step;
        if (step % 10 != 0) centre = next;
        ASSERT_EQ(check.find_wrong(surgery), "") << step;
        figures.add(surgery);
    }
    figures.print("three features", cloth.mesh.vertex_count());
    EXPECT_LE(figures.most_vertices, 1.2 * cloth.mesh.vertex_count());
    EXPECT_GT(figures.percentile(0.05), 13.0);
}

TEST(MoveTrace, StaysValidUnderAGuardThatRefusesAtRandom)
{
    std::mt19937 random(12);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (const double refused : {0.1, 0.5, 0.9}) {
        const SurgeryCloth cloth = square_cloth(16, 0.2);
        ClothSurgery surgery = cloth.surgery();
        const SurgeryCheck check(surgery);
        const MeshTarget target = target_of(cloth);
        cut(surgery, target, {{0.2, 0.3}, {0.5, 0.36}, {0.8, 0.3}}, 1);
        // Motion is decided by the time step, so the guard does not refuse it.
        surgery.set_guard([&](const SurgeryEvent& event) {
            return event.operation == SurgeryOperation::Move || unit(random) >= refused;
        });
        int done = 0;
        for (int step = 0; step < 200; ++step) {
            const double by = (step / 20 % 2 == 0 ? 0.021 : -0.021);
            done +=
                move_trace(surgery, target, shifted(surgery, 1, {0, by})).verdict == Verdict::Done ? 1 : 0;
            ASSERT_EQ(check.find_wrong(surgery), "") << step;
        }
        fmt::print("guard refuses {}: {} of 200 steps done, vertices {} -> {}\n", refused, done,
                   cloth.mesh.vertex_count(), surgery.vertex_count());
        EXPECT_GT(done, refused > 0.8 ? 20 : 150);
        EXPECT_LE(surgery.vertex_count(), 1.5 * cloth.mesh.vertex_count());
    }
}

// A second trace follows close behind the first, to and fro.
TEST(MoveTrace, TwoTracesCloseTogetherSlideTogether)
{
    const SurgeryCloth cloth = square_cloth(16);
    for (const double gap : {0.02, 1e-3}) {
        ClothSurgery surgery = cloth.surgery();
        const SurgeryCheck check(surgery);
        const MeshTarget target = target_of(cloth);
        cut(surgery, target, {{0.2, 0.31}, {0.8, 0.33}}, 1);
        cut(surgery, target, {{0.2, 0.31 + gap}, {0.8, 0.33 + gap}}, 2);
        clean_up(surgery, target);
        int most = 0;
        for (int step = 0; step < 120; ++step) {
            const Vec2 by(0.0, step / 20 % 2 == 0 ? 0.021 : -0.021);
            std::vector<VertexMove> moves = shifted(surgery, 1, by);
            for (const VertexMove& move : shifted(surgery, 2, by)) moves.push_back(move);
            ASSERT_EQ(move_trace(surgery, target, moves).verdict, Verdict::Done) << gap << " step " << step;
            ASSERT_EQ(check.find_wrong(surgery), "") << step;
            most = std::max(most, surgery.vertex_count());
        }
        EXPECT_LE(most, 1.2 * cloth.mesh.vertex_count()) << gap;
    }
}

TEST(MoveTrace, IsTheSameFromAMeshRebuiltEveryStep)
{
    const SurgeryCloth cloth = square_cloth(12, 0.2);
    const MeshTarget target = target_of(cloth);
    ClothSurgery whole = cloth.surgery();
    ClothSurgery rebuilt = cloth.surgery();
    for (ClothSurgery* surgery : {&whole, &rebuilt})
        cut(*surgery, target, {{0.2, 0.3}, {0.5, 0.36}, {0.8, 0.3}}, 1);
    for (int step = 0; step < 60; ++step) {
        const SurgeryResult last = rebuilt.result();
        const std::vector<VertexId> touched = rebuilt.take_touched();
        rebuilt = ClothSurgery(last.mesh, last.ids, last.next_id);
        for (std::size_t k = 0; k < last.ids.size(); ++k)
            rebuilt.set_role(last.ids[k], last.roles[k], last.tags[k]);
        for (const auto& edge : last.tagged_edges)
            rebuilt.set_edge_tag(last.ids[edge.a], last.ids[edge.b], edge.tag);
        for (const VertexId v : touched) rebuilt.touch(v);
        for (ClothSurgery* surgery : {&whole, &rebuilt})
            ASSERT_EQ(move_trace(*surgery, target, shifted(*surgery, 1, {0.003, 0.008})).verdict,
                      Verdict::Done);
        ASSERT_TRUE(is_same(whole.result(), rebuilt.result())) << step;
    }
}

// --- traces inserted anew at every step, as for an obstacle that sweeps across the whole cloth

TEST(TraceSweep, CutAnewAtEveryStepInSixDirections)
{
    for (int direction = 0; direction < 6; ++direction) {
        const SurgeryCloth cloth = square_cloth(30);
        ClothSurgery surgery = cloth.surgery();
        const SurgeryCheck check(surgery);
        const MeshTarget target = target_of(cloth);
        const double angle = 0.5236 * direction + 0.05;
        const Vec2 along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
        SweepFigures figures;
        int refused = 0;
        for (int step = 0; step < 100; ++step) {
            const Vec2 middle = Vec2(0.5, 0.5) + 0.2 * std::sin(0.1 * step) * across;
            for (const VertexMove& move : shifted(surgery, 1, {0, 0})) surgery.release_vertex(move.vertex);
            const Vec2 from = middle - 0.23 * along, to = middle + 0.23 * along;
            const auto a = insert_trace_point(surgery, target, from, 0, {TraceRole::Node, 1});
            const auto b = insert_trace_point(surgery, target, to, 0, {TraceRole::Node, 1});
            ASSERT_EQ(a.verdict, Verdict::Done);
            ASSERT_EQ(b.verdict, Verdict::Done);
            const TraceJoin join = join_trace_vertices(surgery, target, a.vertex, b.vertex, 1);
            refused += join.verdict == Verdict::Done ? 0 : 1;
            clean_up(surgery, target);
            ASSERT_EQ(check.find_wrong(surgery), "") << direction << " step " << step;
            figures.add(surgery);
        }
        figures.print(fmt::format("cut anew, direction {}", direction), cloth.mesh.vertex_count());
        EXPECT_EQ(refused, 0);
        EXPECT_LE(figures.most_vertices, 1.2 * cloth.mesh.vertex_count());
        EXPECT_GT(figures.percentile(0.5), kAngle);
    }
}

// The points at which a line enters and leaves the unit square, exactly on its border.
std::array<Vec2, 2> chord(const Vec2& middle, const Vec2& along)
{
    std::array<Vec2, 2> ends;
    for (int k = 0; k < 2; ++k) {
        const Vec2 way = k == 0 ? Vec2(-along) : along;
        double least = 10.0;
        int side = 0;
        for (int i = 0; i < 2; ++i) {
            const double t = ((way[i] > 0.0 ? 1.0 : 0.0) - middle[i]) / way[i];
            if (t < least) {
                least = t;
                side = i;
            }
        }
        ends[k] = middle + least * way;
        ends[k][side] = way[side] > 0.0 ? 1.0 : 0.0;
    }
    return ends;
}

TEST(TraceSweep, ChordsFromBorderToBorderCutAnew)
{
    std::map<Verdict, int> verdicts;
    for (int direction = 0; direction < 6; ++direction) {
        const SurgeryCloth cloth = square_cloth(24, 0.1);
        ClothSurgery surgery = cloth.surgery();
        const SurgeryCheck check(surgery);
        const MeshTarget target = target_of(cloth);
        const double angle = 0.5236 * direction + 0.01;
        const Vec2 along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
        SweepFigures figures;
        for (int step = 0; step < 100; ++step) {
            for (const VertexMove& move : shifted(surgery, 1, {0, 0})) surgery.release_vertex(move.vertex);
            const Vec2 middle = Vec2(0.5, 0.5) + 0.45 * std::sin(0.1 * step) * across;
            std::array<TraceInsertion, 2> ends;
            const std::array<Vec2, 2> places = chord(middle, along);
            for (int k = 0; k < 2; ++k)
                ends[k] = insert_trace_point(surgery, target, places[k], nearest_vertex(surgery, places[k]),
                                             {TraceRole::Node, 1});
            Verdict verdict = ends[0].verdict != Verdict::Done ? ends[0].verdict : ends[1].verdict;
            if (verdict == Verdict::Done)
                verdict = join_trace_vertices(surgery, target, ends[0].vertex, ends[1].vertex, 1).verdict;
            ++verdicts[verdict];
            clean_up(surgery, target);
            ASSERT_EQ(check.find_wrong(surgery), "") << direction << " step " << step;
            figures.add(surgery);
        }
        figures.print(fmt::format("chords cut anew, direction {}", direction), cloth.mesh.vertex_count());
        EXPECT_LE(figures.most_vertices, 1.2 * cloth.mesh.vertex_count());
        EXPECT_GT(figures.percentile(0.05), 13.0);
    }
    for (const auto& [verdict, count] : verdicts) fmt::print("  {} {}\n", to_string(verdict), count);
    // Insertion may be refused only beside the cloth's corners.
    EXPECT_GT(verdicts[Verdict::Done], 570);
}

TEST(MoveTrace, TakesAsManyOperationsOnALargeMeshAsOnASmallOne)
{
    std::vector<std::size_t> operations;
    for (const int n : {30, 90}) {
        const SurgeryCloth cloth = square_cloth(n, 0.2);
        ClothSurgery surgery = cloth.surgery();
        const MeshTarget target = target_of(cloth);
        // The trace has the same length in cells on every mesh.
        const double half = 7.5 * cloth.cell;
        cut(surgery, target, {{0.5 - half, 0.5}, {0.5 + half, 0.52}}, 1);
        clean_up(surgery, target);
        const std::size_t before = surgery.events().size();
        for (int step = 0; step < 200; ++step) {
            const Vec2 by(0.0, (step / 20 % 2 == 0 ? 0.2 : -0.2) * cloth.cell);
            EXPECT_EQ(move_trace(surgery, target, shifted(surgery, 1, by)).verdict, Verdict::Done);
        }
        operations.push_back(surgery.events().size() - before);
    }
    EXPECT_GT(operations[0], 200u);
    EXPECT_LT(operations[1], operations[0] + operations[0] / 2);
}

TEST(MoveTrace, SweptToAndFroHundredTimesKeepsCountAndAngles)
{
    const SurgeryCloth cloth = square_cloth(20, 0.2);
    ClothSurgery surgery = cloth.surgery();
    const SurgeryCheck check(surgery);
    const MeshTarget target = target_of(cloth);
    cut(surgery, target, {{0.15, 0.2}, {0.5, 0.27}, {0.85, 0.2}}, 7);
    clean_up(surgery, target);
    SweepFigures figures;
    for (int step = 0; step < 2000; ++step) {
        const Vec2 by(0.0, step / 20 % 2 == 0 ? 0.025 : -0.025);
        const TraceMotionReport report = move_trace(surgery, target, shifted(surgery, 7, by));
        ASSERT_EQ(report.verdict, Verdict::Done) << to_string(report.verdict) << " step " << step;
        if (step % 10 == 0) {
            ASSERT_EQ(check.find_wrong(surgery), "") << step;
        }
        if (step % 4 == 0) figures.add(surgery);
    }
    figures.print("swept 100 times", cloth.mesh.vertex_count());
    EXPECT_LE(figures.most_vertices, 1.2 * cloth.mesh.vertex_count());
    EXPECT_GT(figures.percentile(0.05), kAngle);
}

}  // namespace
}  // namespace arris
