// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surgery/cloth_surgery.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>

#include "geometry/cloth/mesh_topology.h"
#include "geometry/surgery/material_location.h"
#include "tests/geometry/surgery_cloths.h"

namespace arris {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// X + (0, 0, X.x * X.y) is not a plane, so interpolation can be verified.
ClothSurgery make(const std::vector<Vec2>& material, const std::vector<Face>& faces)
{
    ClothMesh mesh{material, {}, faces};
    std::vector<VertexId> ids;
    for (const Vec2& X : material) {
        mesh.world.emplace_back(X.x(), X.y(), X.x() * X.y());
        ids.push_back(static_cast<VertexId>(ids.size()));
    }
    EXPECT_EQ(validate(mesh), "");
    return ClothSurgery(mesh, ids, static_cast<VertexId>(ids.size()));
}

//  6 - 7 - 8      vertices 3 x 3, one apart, diagonals upwards
//  | / | / |
//  3 - 4 - 5
//  | / | / |
//  0 - 1 - 2
ClothSurgery three_by_three()
{
    std::vector<Vec2> material;
    std::vector<Face> faces;
    for (int v = 0; v < 9; ++v) material.emplace_back(v % 3, v / 3);
    for (const int v : {0, 1, 3, 4}) {
        faces.push_back({v, v + 1, v + 4});
        faces.push_back({v, v + 4, v + 3});
    }
    return make(material, faces);
}

Verdict collapse(ClothSurgery& surgery, VertexId v, VertexId w)
{
    return surgery.commit(surgery.propose_collapse(v, w));
}

Verdict flip(ClothSurgery& surgery, VertexId a, VertexId b)
{
    return surgery.commit(surgery.propose_flip(a, b));
}

Verdict move(ClothSurgery& surgery, VertexId v, const Vec2& X)
{
    return surgery.commit(surgery.propose_moves({{v, X}}));
}

void mark_trace(ClothSurgery& surgery, const std::vector<VertexId>& path, int tag)
{
    for (const VertexId v : path) surgery.set_role(v, TraceRole::OnTrace, tag);
    for (std::size_t k = 0; k + 1 < path.size(); ++k) surgery.set_edge_tag(path[k], path[k + 1], tag);
}

TEST(ClothSurgery, GivesBackWhatItWasGiven)
{
    const ClothSurgery surgery = three_by_three();
    const SurgeryResult result = surgery.result();
    EXPECT_EQ(result.mesh.vertex_count(), 9);
    EXPECT_EQ(result.mesh.face_count(), 8);
    EXPECT_EQ(result.mesh.faces.front(), (Face{0, 1, 4}));
    EXPECT_EQ(result.next_id, 9u);
    EXPECT_TRUE(result.tagged_edges.empty());
}

TEST(ClothSurgery, CornersAreFixedAndStraightBorderIsNot)
{
    const ClothSurgery surgery = three_by_three();
    for (const VertexId v : {0u, 2u, 6u, 8u}) EXPECT_TRUE(surgery.is_fixed(v)) << v;
    for (const VertexId v : {1u, 3u, 4u, 5u, 7u}) EXPECT_FALSE(surgery.is_fixed(v)) << v;
    EXPECT_FALSE(surgery.is_border(4));
}

TEST(ClothSurgery, BorderThatTurnsByLittleIsACornerAndRoundingIsNot)
{
    const auto is_corner = [](double off) {
        return make({{0, 0}, {1, off}, {2, 0}, {1, 1}}, {{0, 1, 3}, {1, 2, 3}}).is_fixed(1);
    };
    EXPECT_TRUE(is_corner(-1e-12));
    EXPECT_TRUE(is_corner(1e-12));
    EXPECT_FALSE(is_corner(1e-16));
}

TEST(ClothSurgery, RingsStartAtTheBorderOrTheLeastId)
{
    const ClothSurgery surgery = three_by_three();
    EXPECT_EQ(surgery.ring(4).vertices, (std::vector<VertexId>{0, 1, 5, 8, 7, 3}));
    EXPECT_TRUE(surgery.ring(4).is_closed);
    EXPECT_EQ(surgery.ring(1).vertices, (std::vector<VertexId>{2, 5, 4, 0}));
    EXPECT_FALSE(surgery.ring(1).is_closed);
}

TEST(ClothSurgery, SplitEdgeInterpolatesBothCoordinates)
{
    ClothSurgery surgery = three_by_three();
    const SurgeryProposal proposal = surgery.propose_edge_split(4, 8, 0.25);
    ASSERT_EQ(surgery.commit(proposal), Verdict::Done);
    EXPECT_EQ(surgery.material(9), Vec2(1.25, 1.25));
    EXPECT_EQ(surgery.world(9), Vec3(1.25, 1.25, 1.0 + 0.25 * 3.0));
    ASSERT_EQ(surgery.events().size(), 1u);
    const SurgeryEvent& event = surgery.events()[0];
    EXPECT_EQ(event.changes[0].vertex, 9u);
    EXPECT_EQ(event.changes[0].parents, (IdFace{4, 8, 8}));
    EXPECT_EQ(event.before.size(), 2u);
    EXPECT_EQ(event.after.size(), 4u);
    EXPECT_EQ(surgery.ring(9).vertices, (std::vector<VertexId>{4, 5, 8, 7}));
    EXPECT_EQ(surgery.result().next_id, 10u);
}

TEST(ClothSurgery, SplitBorderEdgeStaysOnIt)
{
    ClothSurgery surgery = three_by_three();
    ASSERT_EQ(surgery.commit(surgery.propose_edge_split(1, 2, 1.0 / 3.0)), Verdict::Done);
    EXPECT_EQ(surgery.material(9).y(), 0.0);
    EXPECT_TRUE(surgery.is_border(9));
    EXPECT_FALSE(surgery.is_fixed(9));
    EXPECT_EQ(collapse(surgery, 9, 1), Verdict::Done);
}

TEST(ClothSurgery, SplitFaceHasItsWeights)
{
    ClothSurgery surgery = three_by_three();
    ASSERT_EQ(surgery.commit(surgery.propose_face_split({1, 5, 4}, {2, 1, 1}, TraceRole::Node, 3)),
              Verdict::Done);
    EXPECT_EQ(surgery.material(9), Vec2(1.25, 0.5));
    EXPECT_EQ(surgery.role(9), TraceRole::Node);
    EXPECT_EQ(surgery.tag(9), 3);
    EXPECT_EQ(surgery.faces_at(9).size(), 3u);
}

TEST(ClothSurgery, ArgumentsThatAreNoInnerPointAreRefused)
{
    ClothSurgery surgery = three_by_three();
    const SurgeryResult before = surgery.result();
    for (const double s : {0.0, 1.0, -1.0, 2.0, kNan, 1e300})
        EXPECT_EQ(surgery.commit(surgery.propose_edge_split(4, 8, s)), Verdict::Argument) << s;
    for (const Vec3& w : {Vec3(0, 1, 1), Vec3(-1, 1, 1), Vec3(kNan, 1, 1), Vec3(0, 0, 0),
                          Vec3(1, std::numeric_limits<double>::infinity(), 1)})
        EXPECT_EQ(surgery.commit(surgery.propose_face_split({1, 5, 4}, w)), Verdict::Argument);
    EXPECT_EQ(move(surgery, 4, Vec2(kNan, 1)), Verdict::Argument);
    EXPECT_EQ(surgery.commit(surgery.propose_moves({{4, {1, 1}}, {4, {1, 1}}})), Verdict::Argument);
    EXPECT_EQ(surgery.commit(surgery.propose_edge_split(0, 8, 0.5)), Verdict::Missing);
    EXPECT_EQ(surgery.commit(surgery.propose_edge_split(4, 99, 0.5)), Verdict::Missing);
    EXPECT_EQ(surgery.commit(surgery.propose_face_split({0, 1, 5}, {1, 1, 1})), Verdict::Missing);
    EXPECT_EQ(collapse(surgery, 0, 8), Verdict::Missing);
    EXPECT_EQ(flip(surgery, 0, 8), Verdict::Missing);
    EXPECT_EQ(move(surgery, 99, Vec2(1, 1)), Verdict::Missing);
    EXPECT_TRUE(is_same(surgery.result(), before));
    EXPECT_TRUE(surgery.events().empty());
}

TEST(ClothSurgery, SplitSoCloseThatAFaceWouldVanishIsRefused)
{
    ClothSurgery surgery = three_by_three();
    // 1 + 1e-300 is 1, so the new vertex would coincide with vertex 4.
    EXPECT_EQ(surgery.commit(surgery.propose_edge_split(4, 8, 1e-300)), Verdict::Orientation);
}

TEST(ClothSurgery, CollapseGivesTheFacesToTheOtherEnd)
{
    ClothSurgery surgery = three_by_three();
    ASSERT_EQ(collapse(surgery, 4, 8), Verdict::Done);
    EXPECT_FALSE(surgery.has_vertex(4));
    EXPECT_EQ(surgery.material(8), Vec2(2, 2));
    EXPECT_TRUE(surgery.is_fixed(8));
    EXPECT_EQ(surgery.ring(8).vertices, (std::vector<VertexId>{7, 3, 0, 1, 5}));
    EXPECT_EQ(validate(surgery.result().mesh), "");
    const SurgeryEvent& event = surgery.events()[0];
    EXPECT_EQ(event.before.size(), 6u);
    EXPECT_EQ(event.after.size(), 4u);
    EXPECT_EQ(event.changes[0].vertex, 4u);
    EXPECT_EQ(event.changes[0].old_material, Vec2(1, 1));
}

TEST(ClothSurgery, CollapseLeavesTheOtherEndAsItIs)
{
    const SurgeryCloth cloth = square_cloth(3);
    int done = 0;
    for (const VertexId v : cloth.ids())
        for (const VertexId w : cloth.surgery().ring(v).vertices) {
            ClothSurgery surgery(cloth.mesh, cloth.ids(), 16, {5});
            if (v != 5) surgery.set_role(w, TraceRole::Node, 4);
            const bool was_fixed = surgery.is_fixed(w);
            const TraceRole role = surgery.role(w);
            if (collapse(surgery, v, w) != Verdict::Done) continue;
            ++done;
            EXPECT_EQ(surgery.is_fixed(w), was_fixed) << v << " -> " << w;
            EXPECT_EQ(surgery.role(w), role);
            EXPECT_EQ(surgery.material(w), cloth.mesh.material[w]);
            EXPECT_EQ(surgery.world(w), cloth.mesh.world[w]);
            EXPECT_EQ(SurgeryCheck(cloth.surgery()).find_wrong(surgery), "");
        }
    EXPECT_GT(done, 20);
}

TEST(ClothSurgery, CornersAndTheBordersPolygonStay)
{
    ClothSurgery surgery = three_by_three();
    EXPECT_EQ(collapse(surgery, 0, 1), Verdict::Fixed);
    EXPECT_EQ(collapse(surgery, 1, 4), Verdict::Border);
    EXPECT_EQ(collapse(surgery, 1, 5), Verdict::Border);  // an inner edge between border vertices
    EXPECT_EQ(move(surgery, 0, Vec2(0.1, 0)), Verdict::Fixed);
    EXPECT_EQ(move(surgery, 1, Vec2(1, 0.1)), Verdict::Border);
    EXPECT_EQ(move(surgery, 1, Vec2(1, -1e-13)), Verdict::Border);
    EXPECT_EQ(move(surgery, 1, Vec2(2, 0)), Verdict::Border);  // moves onto the corner
    EXPECT_EQ(move(surgery, 1, Vec2(3, 0)), Verdict::Border);  // moves past the corner
    EXPECT_EQ(move(surgery, 1, Vec2(1.2, 0)), Verdict::Done);
    EXPECT_EQ(collapse(surgery, 1, 2), Verdict::Done);
}

TEST(ClothSurgery, BordersThatMeetAtAVertexAreNotJoinedAcross)
{
    // In a strip one face wide, the inner edge 1-3 joins border to border.
    ClothSurgery surgery =
        make({{0, 0}, {1, 0}, {2, 0}, {0, 1}, {1, 1}, {2, 1}}, {{0, 1, 3}, {1, 4, 3}, {1, 2, 4}, {2, 5, 4}});
    EXPECT_EQ(collapse(surgery, 1, 3), Verdict::Border);
    EXPECT_EQ(collapse(surgery, 1, 4), Verdict::Border);
    EXPECT_EQ(collapse(surgery, 1, 0), Verdict::Done);
    EXPECT_EQ(validate(surgery.result().mesh), "");
}

TEST(ClothSurgery, CollapseThatWouldJoinAnEdgeTwiceIsRefused)
{
    // v = 3 and w = 4 share the neighbours 0, 1 (of their edge's faces) and 2 through the inside of triangle
    // (0, 1, 2).
    ClothSurgery surgery = make({{0, 0}, {4, 0}, {2, 4}, {2, 0.5}, {2, 1.5}},
                                {{0, 1, 3}, {1, 4, 3}, {0, 3, 4}, {1, 2, 4}, {0, 4, 2}});
    EXPECT_EQ(collapse(surgery, 3, 4), Verdict::Done);
    EXPECT_EQ(surgery.faces_at(4).size(), 3u);
    EXPECT_EQ(collapse(surgery, 4, 0), Verdict::Done);
    EXPECT_EQ(surgery.result().mesh.face_count(), 1);
    EXPECT_EQ(collapse(surgery, 0, 1), Verdict::Fixed);
    // With an inner vertex of degree 3 beside v, collapsing v to w would fold its faces.
    ClothSurgery other = make({{0, 0}, {4, 0}, {2, 4}, {2, 1}, {2, 0.4}},
                              {{0, 1, 4}, {1, 3, 4}, {3, 0, 4}, {1, 2, 3}, {2, 0, 3}});
    EXPECT_EQ(collapse(other, 3, 0), Verdict::Topology);
    EXPECT_EQ(collapse(other, 3, 1), Verdict::Topology);
}

TEST(ClothSurgery, ChangesThatTurnAFaceAreRefusedExactly)
{
    ClothSurgery surgery = three_by_three();
    EXPECT_EQ(move(surgery, 4, Vec2(0.5, 2.5)), Verdict::Orientation);
    // On the line 0-1-2 the face (0, 1, 4) has area 0; at the next double above, the area is positive.
    EXPECT_EQ(move(surgery, 4, Vec2(1, 0)), Verdict::Orientation);
    EXPECT_EQ(move(surgery, 4, Vec2(1, std::numeric_limits<double>::denorm_min())), Verdict::Done);
    EXPECT_EQ(validate(surgery.result().mesh), "");
    EXPECT_EQ(flip(surgery, 1, 4), Verdict::Orientation);  // vertex 4 is a concave corner of the two faces
}

TEST(ClothSurgery, FlipTurnsAnEdgeAndBack)
{
    ClothSurgery surgery = three_by_three();
    EXPECT_EQ(flip(surgery, 4, 8), Verdict::Done);
    EXPECT_TRUE(surgery.has_edge(5, 7));
    EXPECT_FALSE(surgery.has_edge(4, 8));
    EXPECT_EQ(flip(surgery, 5, 7), Verdict::Done);
    EXPECT_TRUE(surgery.has_edge(4, 8));
    EXPECT_EQ(flip(surgery, 0, 1), Verdict::Border);
    mark_trace(surgery, {4, 8}, 1);
    EXPECT_EQ(flip(surgery, 4, 8), Verdict::Trace);
}

TEST(ClothSurgery, MovedVertexStaysOnTheSurfaceUnlessItsPlaceIsGiven)
{
    ClothSurgery surgery = three_by_three();
    ASSERT_EQ(move(surgery, 4, Vec2(1.25, 1.5)), Verdict::Done);
    // The place is in the face (4, 8, 7) with weights 1/2, 1/4, 1/4; the heights are 1, 4, 2.
    EXPECT_EQ(surgery.world(4), Vec3(1.25, 1.5, 2.0));
    ASSERT_EQ(surgery.commit(surgery.propose_moves({{4, {1.0, 1.0}, true}})), Verdict::Done);
    EXPECT_EQ(surgery.world(4), Vec3(1.25, 1.5, 2.0));
    EXPECT_EQ(surgery.events().back().changes[0].old_material, Vec2(1.25, 1.5));
}

TEST(ClothSurgery, VerticesMoveTogetherWhereOneAloneCouldNot)
{
    const SurgeryCloth cloth = square_cloth(10);
    ClothSurgery surgery = cloth.surgery();
    const VertexId a = nearest_vertex(surgery, {0.5, 0.5});
    const VertexId b = nearest_vertex(surgery, {0.5, 0.6});
    const Vec2 up(0.0, 0.11);
    EXPECT_EQ(move(surgery, a, surgery.material(a) + up), Verdict::Orientation);
    // b is in the way of a. Moved together, they only approach the next vertex.
    EXPECT_EQ(surgery.commit(surgery.propose_moves(
                  {{a, surgery.material(a) + Vec2(0.0, 0.09)}, {b, surgery.material(b) + Vec2(0.0, 0.09)}})),
              Verdict::Done);
}

TEST(ClothSurgery, TraceIsCollapsedOnlyAlongItself)
{
    const SurgeryCloth cloth = square_cloth(4);
    ClothSurgery surgery = cloth.surgery();
    const auto at = [&](double u, double v) { return nearest_vertex(surgery, {u, v}); };
    const VertexId a = at(0.25, 0.5), b = at(0.5, 0.5), c = at(0.75, 0.5), above = at(0.5, 0.75);
    mark_trace(surgery, {a, b, c}, 5);
    EXPECT_EQ(collapse(surgery, b, above), Verdict::Trace);
    EXPECT_EQ(collapse(surgery, a, b), Verdict::Trace);  // the end of a trace
    EXPECT_EQ(surgery.propose_collapse(above, b).verdict, Verdict::Done);
    surgery.set_role(b, TraceRole::Node, 5);
    EXPECT_EQ(collapse(surgery, b, c), Verdict::Fixed);
    surgery.set_role(b, TraceRole::OnTrace, 5);
    surgery.set_edge_tag(b, c, 6);
    EXPECT_EQ(collapse(surgery, b, c), Verdict::Trace);  // a vertex where two features meet
    surgery.set_edge_tag(b, c, 5);
    EXPECT_EQ(collapse(surgery, b, c), Verdict::Done);
    EXPECT_EQ(surgery.edge_tag(a, c), 5);
    EXPECT_EQ(surgery.result().tagged_edges.size(), 1u);
}

TEST(ClothSurgery, TwoEdgesOfATraceAreNotMergedIntoOne)
{
    ClothSurgery surgery = three_by_three();
    mark_trace(surgery, {4, 5, 8}, 1);
    surgery.set_edge_tag(4, 8, 1);
    EXPECT_EQ(collapse(surgery, 4, 5), Verdict::Trace);
    EXPECT_EQ(surgery.result().tagged_edges.size(), 3u);
}

TEST(ClothSurgery, SplitTraceStaysATrace)
{
    ClothSurgery surgery = three_by_three();
    mark_trace(surgery, {4, 8}, 2);
    ASSERT_EQ(surgery.commit(surgery.propose_edge_split(8, 4, 0.5)), Verdict::Done);
    EXPECT_EQ(surgery.role(9), TraceRole::OnTrace);
    EXPECT_EQ(surgery.tag(9), 2);
    EXPECT_EQ(surgery.edge_tag(4, 9), 2);
    EXPECT_EQ(surgery.edge_tag(9, 8), 2);
    EXPECT_EQ(surgery.edge_tag(9, 5), kNoTag);
}

TEST(ClothSurgery, ReleaseLeavesOrdinaryVertices)
{
    ClothSurgery surgery = three_by_three();
    mark_trace(surgery, {3, 4, 5}, 2);
    surgery.set_role(3, TraceRole::Node, 2);
    surgery.take_touched();
    surgery.release_vertex(4);
    EXPECT_EQ(surgery.role(4), TraceRole::Free);
    EXPECT_EQ(surgery.role(5), TraceRole::Free);  // vertex 5 has no trace edge left
    EXPECT_EQ(surgery.role(3), TraceRole::Node);
    EXPECT_TRUE(surgery.result().tagged_edges.empty());
    EXPECT_EQ(surgery.take_touched(), (std::vector<VertexId>{3, 4, 5}));
}

TEST(ClothSurgery, GuardSeesEveryChangeAndMayRefuseIt)
{
    ClothSurgery surgery = three_by_three();
    const SurgeryResult before = surgery.result();
    int asked = 0;
    surgery.set_guard([&](const SurgeryEvent& event) {
        EXPECT_FALSE(event.before.empty());
        EXPECT_FALSE(event.after.empty());
        ++asked;
        return false;
    });
    EXPECT_EQ(collapse(surgery, 4, 8), Verdict::Guard);
    EXPECT_EQ(flip(surgery, 4, 8), Verdict::Guard);
    EXPECT_EQ(move(surgery, 4, Vec2(1.1, 1)), Verdict::Guard);
    EXPECT_EQ(surgery.commit(surgery.propose_edge_split(4, 8, 0.5)), Verdict::Guard);
    EXPECT_EQ(surgery.commit(surgery.propose_face_split({1, 5, 4}, {1, 1, 1})), Verdict::Guard);
    EXPECT_EQ(asked, 5);
    EXPECT_TRUE(is_same(surgery.result(), before));
    EXPECT_TRUE(surgery.events().empty());
    EXPECT_TRUE(surgery.take_touched().empty());
}

TEST(ClothSurgery, CallersVerticesStayWhereTheyAre)
{
    const SurgeryCloth cloth = square_cloth(4);
    const VertexId pinned = nearest_vertex(cloth.surgery(), {0.5, 0.5});
    ClothSurgery surgery(cloth.mesh, cloth.ids(), 25, {pinned});
    EXPECT_EQ(collapse(surgery, pinned, surgery.ring(pinned).vertices[0]), Verdict::Fixed);
    EXPECT_EQ(move(surgery, pinned, {0.51, 0.5}), Verdict::Fixed);
}

TEST(Locate, AgreesWithTheFacesThatHoldThePoint)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-0.1, 1.1);
    for (const SurgeryCloth& cloth : {square_cloth(6, 0.3), bay_cloth(6), holed_cloth(6)}) {
        const ClothSurgery surgery = cloth.surgery();
        const ClothMesh& mesh = cloth.mesh;
        for (int k = 0; k < 300; ++k) {
            Vec2 X(unit(random), unit(random));
            if (k % 3 == 0) X = mesh.material[k % mesh.vertex_count()];
            const auto found = locate(surgery, X, 0);
            bool is_inside = false;
            for (const Face& f : mesh.faces) {
                bool holds = true;
                for (int i = 0; i < 3; ++i)
                    holds = holds && twice_area(mesh.material[f[i]], mesh.material[f[(i + 1) % 3]], X) >= 0.0;
                is_inside = is_inside || holds;
            }
            ASSERT_EQ(found.has_value(), is_inside) << cloth.name << " " << X.transpose();
            if (!found) continue;
            Vec2 Y = Vec2::Zero();
            for (int i = 0; i < 3; ++i) Y += found->weights[i] * surgery.material(found->face[i]);
            EXPECT_LT((X - Y).norm(), 1e-15);
        }
    }
    EXPECT_FALSE(locate(square_cloth(3).surgery(), {kNan, 0.5}, 0));
    EXPECT_FALSE(locate(square_cloth(3).surgery(), {0.5, 0.5}, 99));
}

// --- random operations

struct Fuzz {
    explicit Fuzz(unsigned seed) : random(seed) {}

    double unit() { return std::uniform_real_distribution<double>(0.0, 1.0)(random); }
    std::size_t below(std::size_t n) { return static_cast<std::size_t>(unit() * double(n)); }

    VertexId vertex(const std::vector<VertexId>& ids) { return ids[below(ids.size())]; }

    // Fractions from the middle to as near the end as doubles allow.
    double fraction() { return unit() < 0.7 ? unit() : std::pow(10.0, -20.0 * unit()); }

    SurgeryProposal propose(const ClothSurgery& surgery, const std::vector<VertexId>& ids, double cell)
    {
        const VertexId v = vertex(ids);
        const VertexRing ring = surgery.ring(v);
        const VertexId w = ring.vertices[below(ring.vertices.size())];
        const std::vector<IdFace> faces = surgery.faces_at(v);
        switch (below(6)) {
            case 0:
                return surgery.propose_edge_split(v, w, fraction());
            case 1:
                return surgery.propose_face_split(faces[below(faces.size())], {unit(), unit(), fraction()});
            case 2: {
                const Vec2 by(unit() - 0.5, unit() - 0.5);
                return surgery.propose_moves({{v, surgery.material(v) + cell * by, unit() < 0.5}});
            }
            case 3: {
                const Vec2 along = surgery.material(w) - surgery.material(v);
                return surgery.propose_moves({{v, surgery.material(v) + (fraction() - 0.3) * along}});
            }
            case 4:
                return surgery.propose_flip(v, w);
            default:
                return surgery.propose_collapse(v, w);
        }
    }

    std::mt19937 random;
};

std::vector<SurgeryCloth> nasty_cloths()
{
    return {square_cloth(1),
            square_cloth(5, 0.3),
            bay_cloth(6),
            holed_cloth(6),
            turned_cloth(5),
            placed(square_cloth(5, 0.3), 1e-3, {0, 0}),
            placed(turned_cloth(5), 1e3, {0, 0}),
            placed(square_cloth(5, 0.3), 1.0, {1000, -1000}),
            placed(turned_cloth(5), 1.0, {1000, 1000}),
            sabotaged_cloth(6, 1),
            sabotaged_cloth(6, 2)};
}

TEST(ClothSurgery, RandomOperationsNeverMakeAnInvalidMesh)
{
    for (const SurgeryCloth& cloth : nasty_cloths()) {
        ClothSurgery surgery = cloth.surgery();
        const SurgeryCheck check(surgery);
        Fuzz fuzz(11);
        surgery.set_guard([&](const SurgeryEvent&) { return fuzz.unit() < 0.8; });
        std::map<Verdict, int> verdicts;
        for (int k = 0; k < 1500; ++k) {
            const std::vector<VertexId> ids = surgery.result().ids;
            // Some vertices are marked as trace.
            const VertexId v = fuzz.vertex(ids);
            const VertexId w = surgery.ring(v).vertices[0];
            if (k % 50 == 0) mark_trace(surgery, {v, w}, k % 3);
            if (k % 120 == 0) surgery.release_vertex(v);
            const Verdict verdict = surgery.commit(fuzz.propose(surgery, ids, cloth.cell));
            ++verdicts[verdict];
            if (verdict == Verdict::Done) {
                ASSERT_EQ(check.find_wrong(surgery), "") << cloth.name << " operation " << k;
            }
        }
        EXPECT_GT(verdicts[Verdict::Done], 300) << cloth.name;
        EXPECT_GT(verdicts[Verdict::Orientation], 15) << cloth.name;
        EXPECT_GT(verdicts[Verdict::Guard], 100) << cloth.name;
    }
}

// Runs two surgeries with equal random numbers. The second is taken apart and reassembled at every step.
TEST(ClothSurgery, RebuiltFromItsResultGoesOnAlike)
{
    const SurgeryCloth cloth = square_cloth(6, 0.3);
    ClothSurgery whole = cloth.surgery();
    ClothSurgery rebuilt = cloth.surgery();
    Fuzz fuzz(5), again(5);
    for (int k = 0; k < 2000; ++k) {
        whole.commit(fuzz.propose(whole, whole.result().ids, cloth.cell));
        const SurgeryResult last = rebuilt.result();
        rebuilt = ClothSurgery(last.mesh, last.ids, last.next_id);
        rebuilt.commit(again.propose(rebuilt, last.ids, cloth.cell));
        ASSERT_TRUE(is_same(whole.result(), rebuilt.result())) << k;
    }
    EXPECT_GT(whole.result().next_id, 300u);
}

// A random walk of operations whose events are replayed on arrays: the events must describe what happened.
TEST(ClothSurgery, EventsTellAllThatHappened)
{
    const SurgeryCloth cloth = square_cloth(6, 0.3);
    ClothSurgery surgery = cloth.surgery();
    Fuzz fuzz(9);
    for (int k = 0; k < 2000; ++k) surgery.commit(fuzz.propose(surgery, surgery.result().ids, cloth.cell));

    const auto from_least = [](IdFace f) {
        std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
        return f;
    };
    std::set<IdFace> faces;
    std::map<VertexId, std::pair<Vec2, Vec3>> places;
    for (const Face& f : cloth.mesh.faces)
        faces.insert(from_least({VertexId(f[0]), VertexId(f[1]), VertexId(f[2])}));
    for (int v = 0; v < cloth.mesh.vertex_count(); ++v)
        places[VertexId(v)] = {cloth.mesh.material[v], cloth.mesh.world[v]};
    for (const SurgeryEvent& event : surgery.events()) {
        for (const PatchFace& face : event.before) {
            ASSERT_EQ(faces.erase(from_least(face.vertices)), 1u);
            for (int i = 0; i < 3; ++i) {
                EXPECT_EQ(places.at(face.vertices[i]).first, face.material[i]);
                EXPECT_EQ(places.at(face.vertices[i]).second, face.world[i]);
            }
        }
        for (const VertexChange& change : event.changes) {
            if (event.operation == SurgeryOperation::Collapse)
                places.erase(change.vertex);
            else
                places[change.vertex] = {change.new_material, change.new_world};
        }
        for (const PatchFace& face : event.after) ASSERT_TRUE(faces.insert(from_least(face.vertices)).second);
    }
    const SurgeryResult result = surgery.result();
    ASSERT_EQ(result.ids.size(), places.size());
    for (std::size_t v = 0; v < result.ids.size(); ++v) {
        EXPECT_EQ(places.at(result.ids[v]).first, result.mesh.material[v]);
        EXPECT_EQ(places.at(result.ids[v]).second, result.mesh.world[v]);
    }
    std::set<IdFace> left;
    for (const Face& f : result.mesh.faces)
        left.insert(from_least({result.ids[f[0]], result.ids[f[1]], result.ids[f[2]]}));
    EXPECT_EQ(left, faces);
}

}  // namespace
}  // namespace arris
