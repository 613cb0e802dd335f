// SPDX-License-Identifier: GPL-3.0-or-later
// Surgery of sewn cloth: what changes a seam changes both of its sides alike.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "geometry/cloth/mesh_quality.h"
#include "geometry/cloth/sewing.h"
#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/surgery/cloth_surgery.h"
#include "geometry/surgery/material_location.h"
#include "geometry/surgery/surgery_cleanup.h"
#include "tests/sewn_cloth.h"

namespace arris {
namespace {

constexpr double kExact = 1e-13;  // m: rounding of places of about a metre

ClothMesh make_grid(std::array<int, 2> cells, GridPattern pattern = GridPattern::Diagonal)
{
    ClothGrid grid;
    grid.size = Vec2(1.0, 1.0);
    grid.resolution = cells;
    grid.pattern = pattern;
    ClothMesh mesh = make_cloth_grid(grid);
    for (Vec3& x : mesh.world) x.z() = 0.1 * std::sin(5.0 * x.x()) * std::cos(4.0 * x.y());
    return mesh;
}

std::vector<VertexId> ascending(std::size_t count, VertexId first)
{
    std::vector<VertexId> ids(count);
    std::iota(ids.begin(), ids.end(), first);
    return ids;
}

ClothSurgery operate_on(const ClothMesh& mesh)
{
    const auto n = static_cast<VertexId>(mesh.vertex_count());
    return ClothSurgery(mesh, ascending(mesh.world.size(), 0), static_cast<VertexId>(mesh.material.size()),
                        {}, ascending(mesh.seam_vertices.size(), n));
}

/// A surgery of a result's mesh.
ClothSurgery rebuild(const SurgeryResult& result)
{
    return ClothSurgery(result.mesh, result.ids, result.next_id, {}, result.seam_ids);
}

class SeamSurgery : public ::testing::Test {
  protected:
    /// A point of the vertex at this place of the sheet before it was parted.
    VertexId at(double u, double v) const
    {
        for (int k = 0; k < sheet.vertex_count(); ++k)
            if ((sheet.material[k] - Vec2(u, v)).norm() < 1e-9) return static_cast<VertexId>(k);
        ADD_FAILURE() << "no vertex at " << u << ", " << v;
        return kNoVertex;
    }
    VertexId beyond(VertexId v) const { return surgery.points_at(v).back(); }
    double area() const { return material_area(surgery.result().mesh); }

    const ClothMesh sheet = make_grid({4, 4});
    const ClothMesh sewn = part_and_sew(sheet, {0, 0.5, 0.75, 30.0, 1.25});
    ClothSurgery surgery = operate_on(sewn);
};

TEST_F(SeamSurgery, ReturnsTheMeshItWasMadeOf)
{
    const SurgeryResult result = surgery.result();
    EXPECT_EQ(validate(result.mesh), "");
    EXPECT_EQ(result.ids.size(), sheet.world.size());
    EXPECT_EQ(result.seam_ids.size(), 5u);
    EXPECT_EQ(result.mesh.world, sewn.world);
    EXPECT_EQ(result.mesh.material, sewn.material);
    EXPECT_EQ(result.mesh.face_count(), sewn.face_count());
    EXPECT_EQ(material_area(result.mesh), material_area(sewn));
}

TEST_F(SeamSurgery, KnowsThePartnerOfAnEdge)
{
    const VertexId a = at(0.5, 0.25), b = at(0.5, 0.5);
    ASSERT_EQ(surgery.points_at(a).size(), 2u);
    const auto other = surgery.partner(a, b);
    ASSERT_TRUE(other);
    EXPECT_EQ(*other, (std::array{beyond(a), beyond(b)}));
    EXPECT_EQ(*surgery.partner(beyond(a), beyond(b)), (std::array{a, b}));
    EXPECT_TRUE(surgery.is_border_edge(a, b));
    EXPECT_FALSE(surgery.partner(a, at(0.25, 0.25)));
    EXPECT_EQ(surgery.vertex_of(beyond(a)), a);
    // The material beyond is turned by 30 degrees and larger by a quarter.
    EXPECT_LT((surgery.turn_over(a, beyond(a)) * Vec2::UnitX() - 1.25 * Vec2(std::cos(M_PI / 6), 0.5)).norm(),
              kExact);
}

TEST_F(SeamSurgery, SplitsBothSidesAtOneShare)
{
    const VertexId a = at(0.5, 0.25), b = at(0.5, 0.5);
    const double before = area();
    const SurgeryProposal split = surgery.propose_edge_split(beyond(a), beyond(b), 0.3);
    ASSERT_EQ(surgery.commit(split), Verdict::Done);
    ASSERT_EQ(split.event.changes.size(), 2u);
    EXPECT_EQ(split.event.before.size(), 2u);
    EXPECT_EQ(split.event.after.size(), 4u);
    const VertexId made = split.event.changes[0].vertex, other = split.event.changes[1].vertex;
    EXPECT_EQ(surgery.vertex_of(other), made);
    EXPECT_EQ(surgery.world(made), surgery.world(other));
    EXPECT_LT((surgery.material(other) - (0.7 * surgery.material(a) + 0.3 * surgery.material(b))).norm(),
              kExact);
    const SurgeryResult result = surgery.result();
    EXPECT_EQ(validate(result.mesh), "");
    EXPECT_EQ(result.ids.size(), sheet.world.size() + 1);
    EXPECT_EQ(result.seam_ids.size(), 6u);
    EXPECT_NEAR(area(), before, kExact);
}

TEST_F(SeamSurgery, MergesBothSidesOfAStraightSeam)
{
    const VertexId a = at(0.5, 0.5), gone = beyond(a);
    const double before = area();
    const auto merge = [&](double v) { return surgery.commit(surgery.propose_collapse(a, at(0.5, v))); };
    ASSERT_TRUE(merge(0.25) == Verdict::Done || merge(0.75) == Verdict::Done);
    EXPECT_FALSE(surgery.has_vertex(a));
    EXPECT_FALSE(surgery.has_vertex(gone));
    const SurgeryResult result = surgery.result();
    EXPECT_EQ(validate(result.mesh), "");
    EXPECT_EQ(result.seam_ids.size(), 4u);
    EXPECT_NEAR(area(), before, kExact);
    EXPECT_TRUE(surgery.partner(at(0.5, 0.25), at(0.5, 0.75)));
}

TEST_F(SeamSurgery, KeepsWhatHoldsASeam)
{
    // The ends of the seam, which are corners of both panels, and seam vertices off the seam.
    EXPECT_EQ(surgery.propose_collapse(at(0.5, 0.0), at(0.5, 0.25)).verdict, Verdict::Fixed);
    EXPECT_EQ(surgery.propose_collapse(at(0.5, 0.25), at(0.25, 0.25)).verdict, Verdict::Border);
    EXPECT_EQ(surgery.propose_moves({{at(0.5, 0.25), Vec2(0.45, 0.25)}}).verdict, Verdict::Border);
    EXPECT_EQ(surgery.propose_flip(at(0.5, 0.25), at(0.5, 0.5)).verdict, Verdict::Border);
    // An inner vertex merges into the seam, which stays.
    const auto merge = [&](double v) {
        return surgery.commit(surgery.propose_collapse(at(0.25, 0.5), at(0.5, v))) == Verdict::Done;
    };
    EXPECT_TRUE(merge(0.25) || merge(0.5) || merge(0.75));
    EXPECT_EQ(validate(surgery.result().mesh), "");
}

TEST_F(SeamSurgery, MovesThePointBeyondByTheSameShare)
{
    const VertexId v = at(0.5, 0.5), up = at(0.5, 0.75), down = at(0.5, 0.25);
    for (const double way : {0.1, -0.05}) {
        ClothSurgery moved = operate_on(sewn);
        ASSERT_EQ(moved.commit(moved.propose_moves({{v, Vec2(0.5, 0.5 + way)}})), Verdict::Done);
        const VertexId other = beyond(v), end = beyond(way > 0.0 ? up : down);
        const double share = std::abs(way) / 0.25;
        const Vec2 from = surgery.material(other), to = surgery.material(end);
        EXPECT_LT((moved.material(other) - (from + share * (to - from))).norm(), kExact);
        EXPECT_EQ(moved.world(other), moved.world(v));
        EXPECT_EQ(validate(moved.result().mesh), "");
    }
    EXPECT_EQ(surgery.propose_moves({{v, Vec2(0.5, 0.8)}}).verdict, Verdict::Border);
}

TEST_F(SeamSurgery, KeepsAVertexFromWhichOneSideIsEased)
{
    // Beyond the seam the upper half is longer: a merge or a move would sew other material together.
    ClothMesh eased = sewn;
    const VertexId v = at(0.5, 0.5), top = at(0.5, 1.0);
    const Vec2 middle = surgery.material(beyond(v));
    const auto point = [&](VertexId id) {
        return sewn.vertex_count() + static_cast<int>(id) - static_cast<int>(sheet.vertex_count());
    };
    for (const VertexId w : {at(0.5, 0.75), top})
        eased.material[point(beyond(w))] += 0.1 * (surgery.material(beyond(w)) - middle);
    ASSERT_EQ(validate(eased), "");
    const ClothSurgery operation = operate_on(eased);
    for (const double other : {0.25, 0.75})
        EXPECT_EQ(operation.propose_collapse(v, at(0.5, other)).verdict, Verdict::Fixed);
    EXPECT_EQ(operation.propose_moves({{v, Vec2(0.5, 0.55)}}).verdict, Verdict::Fixed);
    EXPECT_TRUE(operation.propose_moves({{at(0.5, 0.25), Vec2(0.5, 0.27)}}).is_legal());
}

TEST_F(SeamSurgery, FindsMaterialBeyondTheSeam)
{
    const VertexId far = at(1.0, 1.0);
    const auto found = locate(surgery, surgery.material(far), at(0.0, 0.0));
    ASSERT_TRUE(found);
    EXPECT_NE(std::find(found->face.begin(), found->face.end(), far), found->face.end());
}

TEST_F(SeamSurgery, RolesAreThoseOfTheVertex)
{
    const VertexId v = at(0.5, 0.5);
    surgery.set_role(beyond(v), TraceRole::OnTrace, 3);
    EXPECT_EQ(surgery.role(v), TraceRole::OnTrace);
    surgery.set_role(at(0.25, 0.5), TraceRole::OnTrace, 3);
    surgery.set_edge_tag(v, at(0.25, 0.5), 3);
    surgery.release_vertex(beyond(v));
    EXPECT_EQ(surgery.role(v), TraceRole::Free);
    EXPECT_EQ(surgery.edge_tag(v, at(0.25, 0.5)), kNoTag);
}

TEST_F(SeamSurgery, RefinedAndCoarsenedFiftyTimesASeamKeepsAreaAndShares)
{
    // The place beyond the seam of a place on it.
    const Vec2 first = surgery.material(at(0.5, 0.0)), beyond_first = surgery.material(beyond(at(0.5, 0.0))),
               last = surgery.material(at(0.5, 1.0)), beyond_last = surgery.material(beyond(at(0.5, 1.0)));
    int most = 0, least = 1000;
    for (int round = 0; round < 50; ++round)
        for (const double length : {0.08, 0.35}) {
            const SurgeryResult now = surgery.result();
            surgery = rebuild(now);
            for (const auto& ids : {now.ids, now.seam_ids})
                for (const VertexId v : ids) surgery.touch(v);
            clean_up(surgery, uniform_target(length, 15.0));
            const SurgeryResult made = surgery.result();
            ASSERT_EQ(validate(made.mesh), "") << round;
            ASSERT_NEAR(material_area(made.mesh), material_area(sewn), 1e-12);
            const int count = static_cast<int>(made.seam_ids.size());
            most = std::max(most, count);
            least = std::min(least, count);
            for (const VertexId point : made.seam_ids) {
                const std::vector<VertexId> both = surgery.points_at(point);
                const bool is_beyond = surgery.material(both[0]).x() > 0.55;
                const VertexId on_first = both[is_beyond ? 1 : 0], on_beyond = both[is_beyond ? 0 : 1];
                const double share = (surgery.material(on_first) - first).norm() / (last - first).norm();
                const Vec2 expected = beyond_first + share * (beyond_last - beyond_first);
                ASSERT_LT((surgery.material(on_beyond) - expected).norm(), 1e-12);
            }
        }
    EXPECT_GE(most, 13) << "the longer side has cells of at most 1.4 target lengths";
    EXPECT_LE(least, 7);
}

/// Whether no operation can make two edges between two vertices of the cloth, as at the corners of a pillow.
TEST(SeamSurgeryOfAPillow, MakesNoEdgeTwice)
{
    // Two squares of 2 x 2 cells, sewn along all sides.
    ClothMesh front = make_grid({2, 2}, GridPattern::Cross), back = front;
    for (Vec2& X : back.material) X = Vec2(3.0 - X.x(), X.y());
    for (Face& face : back.faces) std::swap(face[1], face[2]);
    for (Vec3& x : back.world) x.z() -= 0.3;
    ClothMesh both = join({front, back});
    std::vector<int> vertex_of(both.world.size());
    int count = front.vertex_count();
    for (int v = 0; v < count; ++v) vertex_of[v] = v;
    for (int v = 0, next = count; v < front.vertex_count(); ++v) {
        const Vec2& X = front.material[v];
        const bool is_inside = X.minCoeff() > 0.0 && X.maxCoeff() < 1.0;
        vertex_of[count + v] = is_inside ? next++ : v;
        if (!is_inside) both.world[count + v] = both.world[v];
    }
    const ClothMesh pillow = sew(both, vertex_of);
    ASSERT_EQ(validate(pillow), "");
    std::mt19937 random(7);
    int made = 0;
    for (int round = 0; round < 40; ++round) {
        ClothSurgery surgery = operate_on(pillow);
        for (int k = 0; k < 30; ++k) {
            const SurgeryResult now = surgery.result();
            const auto any = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
            const int f = static_cast<int>(any(now.mesh.faces.size()));
            const Face& points = now.mesh.points_of(f);
            const auto id = [&](int p) {
                const auto i = static_cast<std::size_t>(p);
                return i < now.ids.size() ? now.ids[i] : now.seam_ids[i - now.ids.size()];
            };
            const VertexId a = id(points[0]), b = id(points[1]);
            const int kind = static_cast<int>(any(4));
            const SurgeryProposal proposal =
                kind == 0   ? surgery.propose_edge_split(a, b, 0.2 + 0.6 * double(any(100)) / 100.0)
                : kind == 1 ? surgery.propose_collapse(a, b)
                : kind == 2
                    ? surgery.propose_flip(a, b)
                    : surgery.propose_moves(
                          {{a, surgery.material(a) + 0.2 * (surgery.material(b) - surgery.material(a))}});
            if (surgery.commit(proposal) != Verdict::Done) continue;
            ++made;
            const SurgeryResult next = surgery.result();
            ASSERT_EQ(validate(next.mesh), "") << "round " << round << ", operation " << kind;
            ASSERT_NEAR(material_area(next.mesh), 2.0, 1e-12);
            // A surgery rebuilt from the result is the same one.
            const SurgeryResult again = rebuild(next).result();
            ASSERT_EQ(again.ids, next.ids);
            ASSERT_EQ(again.seam_ids, next.seam_ids);
            ASSERT_EQ(again.mesh.face_points, next.mesh.face_points);
            for (std::size_t p = 0; p < next.seam_ids.size(); ++p) {
                const int point = next.mesh.vertex_count() + static_cast<int>(p);
                ASSERT_EQ(surgery.world(next.seam_ids[p]), next.mesh.world[next.mesh.vertex_of(point)]);
            }
        }
    }
    EXPECT_GT(made, 300);
}

}  // namespace
}  // namespace arris
