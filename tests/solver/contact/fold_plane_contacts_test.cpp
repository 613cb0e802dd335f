// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/contact/fold_plane_contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/check/penetration.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "solver/advance.h"
#include "solver/contact/audit.h"
#include "solver/eol/eol_coordinates.h"
#include "solver/step.h"
#include "tests/solver/eol_cloth.h"

namespace arris {
namespace {

using testing::EolCloth;
using testing::kThickness;
using testing::make_draped;

constexpr int kCells = 16;
constexpr double kCell = 0.4 / kCells;  // m
constexpr double kSame = 1e-9;          // m, of material coordinates

MovingObstacle make_line(const std::vector<Vec3>& points = {{0, -1, 0}, {0, 1, 0}},
                         const RigidMotion& motion = {})
{
    return MovingObstacle("wire", make_wire(points, false), {}, motion, 30.0);
}

/// Cloth folded over a wire to the angle `fold` (degrees, 180 is flat), at its stand-off above the wire.
/// Vertices on the wire are EOL if their material coordinate along the wire is less than `end`.
EolCloth make_folded(double fold, double end = 1.0, MovingObstacle wire = make_line())
{
    EolCloth cloth(std::move(wire), make_draped({kCells, 0.0, fold}));
    cloth.scene.eol = uniform_target(kCell, 10.0);
    for (Vec3& x : cloth.state.mesh.world) x.z() += kThickness;
    for (int v = 0; v < cloth.state.mesh.vertex_count(); ++v)
        if (std::abs(cloth.state.mesh.material[v].x() - 0.2) < kSame &&
            cloth.state.mesh.material[v].y() < end)
            cloth.add_eol(v, false, 0);
    return cloth;
}

std::vector<FoldPlaneContact> find(const EolCloth& cloth)
{
    const ClothStars stars = cloth.stars();
    std::vector<EolCoordinates> eol;
    for (const EolVertex& vertex : cloth.state.eol)
        if (const EolPlacing placing = cloth.place(cloth.state.index_of(vertex.vertex_id));
            placing.coordinates)
            eol.push_back(*placing.coordinates);
    const std::vector<const std::vector<Vec3>*> positions(cloth.scene.obstacles.size(),
                                                          &cloth.state.mesh.world);
    return find_fold_plane_contacts(cloth.scene.obstacles, cloth.state, stars, eol, positions);
}

double along_x(const EolCloth& cloth, const FoldPlaneContact& contact)
{
    return cloth.state.mesh.material[contact.vertex].x() - 0.2;
}

TEST(FoldPlaneContacts, KeepEachSideOfAFoldOnItsSide)
{
    const EolCloth cloth = make_folded(20.0);
    const std::vector<FoldPlaneContact> found = find(cloth);
    std::vector<int> vertices;
    for (const FoldPlaneContact& contact : found) {
        EXPECT_GT(contact.bound.normal.x() * along_x(cloth, contact),
                  0.9 * std::abs(along_x(cloth, contact)));
        EXPECT_GT(contact.bound.least_gap, 0.0);
        EXPECT_GT(std::abs(along_x(cloth, contact)), kSame) << "what is on the wire";
        EXPECT_LT(std::abs(along_x(cloth, contact)), 6.0 * kCell) << "what is far away";
        vertices.push_back(contact.vertex);
    }
    EXPECT_TRUE(std::is_sorted(vertices.begin(), vertices.end()));
    EXPECT_EQ(std::adjacent_find(vertices.begin(), vertices.end()), vertices.end()) << "twice";
    for (int v = 0; v < cloth.state.mesh.vertex_count(); ++v) {
        const double away = std::abs(cloth.state.mesh.material[v].x() - 0.2);
        if (away < kSame || away > 3.5 * kCell) continue;
        EXPECT_TRUE(std::binary_search(vertices.begin(), vertices.end(), v)) << v;
    }
}

TEST(FoldPlaneContacts, AreNoneOfAVertexThatIsHeldElsewhere)
{
    // The vertex is EOL on a nail beside the fold.
    EolCloth cloth = make_folded(20.0);
    const auto is_of = [&](int v) {
        const std::vector<FoldPlaneContact> found = find(cloth);
        return std::any_of(found.begin(), found.end(),
                           [&](const FoldPlaneContact& c) { return c.vertex == v; });
    };
    const int beside = cloth.vertex_at(0.2 + kCell, 0.2), other = cloth.vertex_at(0.2 - kCell, 0.2);
    ASSERT_TRUE(is_of(beside));
    ASSERT_TRUE(is_of(other));
    cloth.scene.obstacles.push_back(MovingObstacle(
        "nail", make_points({cloth.state.mesh.world[beside] - Vec3(0.0, 0.0, kThickness)}), {}, {}, 30.0));
    cloth.state.eol[static_cast<std::size_t>(cloth.add_eol(beside, true, 0))].on.obstacle = 1;
    EXPECT_FALSE(is_of(beside));
    EXPECT_TRUE(is_of(other));
}

TEST(FoldPlaneContacts, AreNoneWhereTheClothIsFarFromThePlane)
{
    EXPECT_TRUE(find(make_folded(180.0)).empty());
    EXPECT_TRUE(find(make_folded(20.0, -1.0)).empty()) << "no vertex is on the wire";
    // There are no fold contacts beyond the end of a trace, on the fold's line.
    const EolCloth ending = make_folded(20.0, 0.2);
    for (const FoldPlaneContact& contact : find(ending)) EXPECT_GT(std::abs(along_x(ending, contact)), kSame);
}

TEST(FoldPlaneContacts, AreNoneOfWhatHangsDownPastTheWiresEnd)
{
    // The fold continues past the wire's end. There its line hangs down in the fold plane of the vertices on
    // the wire.
    EolCloth cloth = make_folded(20.0, 0.2 - 0.5 * kCell, make_line({{0, -1, 0}, {0, 0, 0}}));
    for (int v = 0; v < cloth.state.mesh.vertex_count(); ++v) {
        const Vec2 past = cloth.state.mesh.material[v] - Vec2(0.2, 0.2);
        if (past.y() > kSame) cloth.state.mesh.world[v] = Vec3(0.3 * past.x(), 0.1 * past.y(), -past.y());
    }
    const std::vector<FoldPlaneContact> found = find(cloth);
    ASSERT_FALSE(found.empty());
    for (const FoldPlaneContact& contact : found)
        EXPECT_LT(cloth.state.mesh.material[contact.vertex].y(), 0.2 + kSame);
}

TEST(FoldPlaneContacts, DoNotLearnTheirSideFromWhatIsHeldAtTheWiresEnd)
{
    // Offset of the held vertex, m; this vertex is on neither side of the fold.
    for (const double aside : {-1e-5, 1e-5}) {
        EolCloth cloth = make_folded(20.0, 0.2 - 0.5 * kCell, make_line({{0, -1, 0}, {0, 0.3 * kCell, 0}}));
        const int held = cloth.vertex_at(0.2, 0.2);
        cloth.state.mesh.world[held].x() += aside;
        const Obstacle& obstacle = cloth.scene.obstacles[0].shape();
        for (std::size_t c = 0; c < obstacle.features().corners.size(); ++c)
            if (obstacle.mesh().points[obstacle.features().corners[c].point].y() > 0.0)
                cloth.add_eol(held, true, static_cast<int>(c));
        const std::vector<FoldPlaneContact> found = find(cloth);
        for (int v = 0; v < cloth.state.mesh.vertex_count(); ++v) {
            const Vec2 from = cloth.state.mesh.material[v] - Vec2(0.2, 0.2);
            if (std::abs(from.x()) < kSame || std::abs(from.x()) > 2.5 * kCell || from.y() > kSame) continue;
            const auto of = std::find_if(found.begin(), found.end(),
                                         [&](const FoldPlaneContact& c) { return c.vertex == v; });
            ASSERT_NE(of, found.end()) << from.transpose();
            EXPECT_GT(of->bound.normal.x() * from.x(), 0.9 * std::abs(from.x())) << from.transpose();
        }
    }
}

TEST(FoldPlaneContacts, ReachAsFarAsFlowBringsClothSoonOnAWireAtRest)
{
    RigidMotion turning;
    turning.angular_velocity = Vec3(0.0, 0.0, 1.0);
    for (const auto& [motion, time] : {std::pair(RigidMotion(), 1.0), {turning, 0.2}}) {  // time in s
        EolCloth cloth = make_folded(20.0, 1.0, make_line({{0, -1, 0}, {0, 1, 0}}, motion));
        const auto farthest = [&] {
            double most = 0.0;
            for (const FoldPlaneContact& contact : find(cloth))
                most = std::max(most, std::abs(along_x(cloth, contact)));
            return most;
        };
        const double resting = farthest();
        const double flow = 0.06 / time;  // m/s
        for (const EolVertex& eol : cloth.state.eol)
            cloth.state.material_velocity[cloth.state.index_of(eol.vertex_id)] = Vec2(flow, 0.0);
        EXPECT_GT(farthest(), resting + 0.9 * 0.06 - kCell);
        EXPECT_LT(farthest(), resting + 1.1 * 0.06 + kCell);
    }
}

/// Makes one step, halved where necessary. An independent penetration check follows each part. Returns the
/// number of parts.
int advance(EolCloth& cloth, Workspace& work, double dt, int steps)
{
    int parts = 0;
    const auto accept = [&](const StepReport& report, bool) {
        ++parts;
        EXPECT_EQ(report.crossings, 0);
        EXPECT_EQ(report.rewound, 0);
        EXPECT_TRUE(find_penetrations(cloth.scene, cloth.state).empty()) << "at " << cloth.state.time << " s";
        return !::testing::Test::HasFailure();
    };
    for (int k = 0; k < steps && !::testing::Test::HasFailure(); ++k)
        EXPECT_FALSE(
            arris::advance(cloth.scene, Settings(), cloth.state.time + dt, cloth.state, work, accept));
    return parts;
}

TEST(FoldPlaneContacts, SidesThrownAtEachOtherDoNotGetPastTheWire)
{
    constexpr int kSteps = 20;
    for (const double speed : {1.0, 5.0, 20.0})
        for (const bool are_both : {true, false}) {
            SCOPED_TRACE(::testing::Message() << speed << " m/s, both " << are_both);
            EolCloth cloth = make_folded(40.0);
            for (std::size_t v = 0; v < cloth.state.mesh.world.size(); ++v) {
                const double across = cloth.state.mesh.material[v].x() - 0.2;
                if (across < -kSame || (are_both && across > kSame))
                    cloth.state.velocity[v] = Vec3(across < 0.0 ? speed : -speed, 0.0, 0.0);
            }
            Workspace work;
            EXPECT_LE(advance(cloth, work, 0.005, kSteps), 2 * kSteps) << "the check had to do it alone";
        }
}

TEST(FoldPlaneContacts, AreToldFromWhatPressesOnTheObstacle)
{
    EolCloth cloth = make_folded(40.0);
    for (std::size_t v = 0; v < cloth.state.mesh.world.size(); ++v)
        if (cloth.state.mesh.material[v].x() < 0.2 - kSame) cloth.state.velocity[v] = Vec3(5.0, 0.0, 0.0);
    Workspace work;
    int planes = 0;
    for (int k = 0; k < 10; ++k) {
        const StepReport report = step(cloth.scene, Settings(), cloth.state.time + 0.005, cloth.state, work);
        int count = 0;
        for (const ActiveContact& contact : cloth.state.active) {
            if (!is_fold_plane(contact)) continue;
            ++count;
            EXPECT_LT(cloth.state.eol_entry(contact.vertex_ids[0]), 0);
        }
        EXPECT_EQ(report.contacts, static_cast<int>(cloth.state.active.size()) - count);
        planes += count;
    }
    EXPECT_GT(planes, 0);
}

TEST(FoldPlaneContacts, ClothFallsOnWiresThatAreNearerThanAStandOffOrBend)
{
    const auto fall_on = [](const ObstacleMesh& wires) {
        EolCloth cloth(MovingObstacle("wires", wires, {}, {}, 30.0), make_draped({8, 0.0, 180.0}));
        cloth.scene.gravity = Gravity{};
        for (std::size_t v = 0; v < cloth.state.mesh.world.size(); ++v) {
            cloth.state.mesh.world[v] += Vec3(0.007, 0.0, 0.004);
            cloth.state.velocity[v] = Vec3(0.0, 0.0, -1.0);
        }
        Workspace work;
        advance(cloth, work, 0.005, 30);
        return static_cast<int>(cloth.state.eol.size());
    };
    for (const double apart : {0.3, 0.9}) {  // stand-offs
        SCOPED_TRACE(apart);
        ObstacleMesh wires = make_wire({{0, -1, 0}, {0, 1, 0}}, false);
        for (const Vec3& p : {Vec3(apart * kThickness, -1, 0), Vec3(apart * kThickness, 1, 0)})
            wires.points.push_back(p);
        wires.segments.push_back({2, 3});
        EXPECT_GT(fall_on(wires), 0);
    }
    for (const double bend : {0.3, 3.0, 30.0}) {  // stand-offs, in the middle
        SCOPED_TRACE(bend);
        EXPECT_GE(fall_on(make_wire({{0, -1, 0}, {0, 0, bend * kThickness}, {0, 1, 0}}, false)), 0);
    }
}

}  // namespace
}  // namespace arris
