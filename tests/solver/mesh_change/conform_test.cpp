// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh_change/conform.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/cloth/mesh_quality.h"
#include "geometry/cloth/mesh_topology.h"
#include "geometry/obstacle/feature_path.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "solver/advance.h"
#include "solver/contact/audit.h"
#include "solver/contact/contacts.h"
#include "solver/eol/eol_features.h"
#include "solver/mesh_change/mesh_transfer.h"
#include "solver/sites/feature_sites.h"
#include "solver/step.h"
#include "tests/solver/eol_cloth.h"

namespace arris {
namespace {

using testing::edges_of;
using testing::EolCloth;
using testing::kLyingCell;
using testing::kStep;
using testing::kThickness;
using testing::lying;
using testing::make_draped;
using testing::make_ridge;
using testing::press_edges;
using testing::take;

constexpr double kOnFeature = 1e-9;  // m: accuracy of crossings of straight lines of 1 m

/// Lets a point of the obstacle press on the face above it.
void press_point(EolCloth& cloth, int point)
{
    const Vec3& at = cloth.scene.obstacles[0].shape().mesh().points[point];
    for (const Face& f : cloth.state.mesh.faces) {
        const auto flat = [&](int i) -> Vec2 { return cloth.state.mesh.world[f[i]].head<2>(); };
        const Vec2 p = at.head<2>();
        if (twice_area(p, flat(1), flat(2)) < 0.0 || twice_area(flat(0), p, flat(2)) < 0.0 ||
            twice_area(flat(0), flat(1), p) < 0.0)
            continue;
        ContactVertexIds ids = {cloth.state.ids[f[0]], cloth.state.ids[f[1]], cloth.state.ids[f[2]]};
        std::sort(ids.begin(), ids.end());
        cloth.state.active.push_back({ids, ContactKind::Triangle, 0, point, Vec3::UnitZ(), 1e-6});
        return;
    }
}

/// Lets the corner at the ridge's end press.
void press_corner(EolCloth& cloth)
{
    const Obstacle& ridge = cloth.scene.obstacles[0].shape();
    press_point(cloth, ridge.features().corners[testing::end_of(ridge)].point);
}

std::optional<ConformedMesh> conform(const EolCloth& cloth, const FailedFlow& failed = {})
{
    return testing::conform_cloth(cloth, failed).mesh;
}

/// EOL vertices in their order along the ridge.
std::vector<int> along_ridge(const State& state)
{
    std::vector<int> row;
    for (const EolVertex& e : state.eol) row.push_back(state.index_of(e.vertex_id));
    std::sort(row.begin(), row.end(),
              [&](int a, int b) { return state.mesh.world[a].y() < state.mesh.world[b].y(); });
    return row;
}

bool has_edge(const State& state, int a, int b)
{
    const std::vector<MeshEdge> edges = edges_of(state);
    return std::any_of(edges.begin(), edges.end(),
                       [&](const MeshEdge& e) { return (e.a == a && e.b == b) || (e.a == b && e.b == a); });
}

void expect_sound(const State& state, double area)
{
    EXPECT_EQ(validate(state.mesh), "");
    EXPECT_NEAR(material_area(state.mesh), area, 1e-12);
    EXPECT_TRUE(std::is_sorted(state.ids.begin(), state.ids.end()));
    for (std::size_t k = 0; k < state.eol.size(); ++k) {
        EXPECT_GE(state.index_of(state.eol[k].vertex_id), 0);
        if (k > 0) {
            EXPECT_LT(state.eol[k - 1].vertex_id, state.eol[k].vertex_id);
        }
    }
}

TEST(Conform, RowsOnAnEdgeBecomeVerticesOnItWithEdgesAlongIt)
{
    for (const double turn : {0.0, 17.0, 40.0, -25.0, 45.0}) {
        EolCloth cloth = lying(turn);
        press_edges(cloth);
        ASSERT_GT(cloth.state.active.size(), 6u);
        const ConformedMesh made = take(cloth);
        const State& state = cloth.state;
        expect_sound(state, 0.16);
        EXPECT_GT(made.report.inserted, 4) << turn;
        const std::vector<int> row = along_ridge(state);
        ASSERT_GT(row.size(), 5u) << turn;
        for (const int v : row) {
            EXPECT_NEAR(state.mesh.world[v].x(), 0.0, kOnFeature);
            EXPECT_NEAR(state.mesh.world[v].z(), kThickness, kOnFeature);
        }
        for (std::size_t k = 1; k < row.size(); ++k)
            EXPECT_TRUE(has_edge(state, row[k - 1], row[k])) << turn << " after " << k;
        EXPECT_EQ(made.surgery.tagged_edges.size(), row.size() - 1) << "all of the trace is known as such";
        for (const EolVertex& e : state.eol) {
            EXPECT_EQ(e.on.index, testing::tip_of(cloth.scene.obstacles[0].shape()));
            EXPECT_FALSE(e.on.is_corner());
            EXPECT_EQ(e.idle, 0);
        }
        // The trace reaches from border to border, except near a corner of the cloth.
        EXPECT_GT(state.mesh.world[row.back()].y() - state.mesh.world[row.front()].y(),
                  0.4 - 2.2 * kLyingCell);
        EXPECT_GT(least_material_angle(state.mesh), 5.0);
    }
}

/// Flat cloth one thickness above wires, with rows where its edges cross them.
EolCloth lying_on(const MovingObstacle& wires, double turn)
{
    EolCloth cloth(wires, make_draped({7, turn, 180.0}));
    cloth.scene.eol = uniform_target(kLyingCell, 10.0);
    for (Vec3& x : cloth.state.mesh.world) x += Vec3(0.003, 0.004, kThickness);
    const State& state = cloth.state;
    const Obstacle& obstacle = cloth.scene.obstacles[0].shape();
    for (const MeshEdge& edge : edges_of(state))
        for (const FeatureEdge& feature : obstacle.features().edges) {
            const auto& ends = obstacle.topology().edges[feature.edge].points;
            const Vec2 p = obstacle.mesh().points[ends[0]].head<2>(),
                       q = obstacle.mesh().points[ends[1]].head<2>();
            const Vec2 a = state.mesh.world[edge.a].head<2>(), b = state.mesh.world[edge.b].head<2>();
            if (!(twice_area(a, b, p) * twice_area(a, b, q) < 0.0 &&
                  twice_area(p, q, a) * twice_area(p, q, b) < 0.0))
                continue;
            ContactVertexIds ids = {state.ids[edge.a], state.ids[edge.b]};
            std::sort(ids.begin(), ids.end());
            cloth.state.active.push_back({ids, ContactKind::Edge, 0, feature.edge, Vec3::UnitZ(), 1e-6});
        }
    return cloth;
}

TEST(Conform, AWireOfManySegmentsBecomesOneTrace)
{
    std::vector<Vec3> points;
    for (int k = 0; k <= 60; ++k) points.emplace_back(0.0, -0.3 + 0.01 * k, 0.0);
    for (const double turn : {0.0, 20.0}) {
        EolCloth cloth = lying_on(MovingObstacle("wire", make_wire(points, false), {}, {}, 30.0), turn);
        take(cloth);
        expect_sound(cloth.state, 0.16);
        EXPECT_GE(cloth.state.eol.size(), 8u);
        const std::vector<int> row = along_ridge(cloth.state);
        for (std::size_t k = 1; k < row.size(); ++k)
            EXPECT_TRUE(has_edge(cloth.state, row[k - 1], row[k])) << k;
        for (const EolVertex& eol : cloth.state.eol) {
            const Vec3& x = cloth.state.mesh.world[cloth.state.index_of(eol.vertex_id)];
            const Vec3 nearest = place_on_feature(cloth.scene.obstacles[0].shape(), eol.on.index, x).point;
            EXPECT_NEAR((x - nearest).norm(), kThickness, kOnFeature) << "each is on the segment below it";
        }
    }
}

TEST(Conform, AWireThatBendsWithinACellHasATrace)
{
    for (const double radius : {0.12, 30.0}) {
        std::vector<Vec3> points;
        for (int k = -40; k <= 40; ++k) {
            const double angle = 0.005 * k / radius;
            points.emplace_back(radius * (1.0 - std::cos(angle)), radius * std::sin(angle), 0.0);
        }
        EolCloth cloth = lying_on(MovingObstacle("arc", make_wire(points, false), {}, {}, 30.0), 10.0);
        take(cloth);
        expect_sound(cloth.state, 0.16);
        EXPECT_GT(cloth.state.eol.size(), 5u) << radius;
        for (const EolVertex& eol : cloth.state.eol) {
            const Vec3& x = cloth.state.mesh.world[cloth.state.index_of(eol.vertex_id)];
            const Vec3 nearest = place_on_feature(cloth.scene.obstacles[0].shape(), eol.on.index, x).point;
            EXPECT_NEAR((x - nearest).norm(), kThickness, kOnFeature);
        }
    }
}

/// Least distance from `place` of a vertex that is locked at a bend; 1 m if there is none.
double held_off(const State& state, const Vec3& place)
{
    double nearest = 1.0;
    for (const EolVertex& e : state.eol)
        if (e.on.is_bend())
            nearest = std::min(nearest, (state.mesh.world[state.index_of(e.vertex_id)] - place).norm());
    return nearest;
}

/// A wire under the cloth's middle with a bend of `degrees` at (0, `y`, 0).
MovingObstacle make_turning(double y, double degrees)
{
    const double aside = -0.3 * std::tan(degrees * M_PI / 360.0);
    return MovingObstacle("wire", make_wire({{aside, y - 0.3, 0}, {0, y, 0}, {aside, y + 0.3, 0}}, false), {},
                          {}, 30.0);
}

TEST(Conform, WhereAWireTurnsItsTraceHasAVertexThatIsHeldThere)
{
    // No contact presses at the bend, but the chord would pass it by more than a thickness.
    for (const double degrees : {15.0, 30.0, 45.0})
        for (const double turn : {0.0, 10.0, 20.0, 33.0, 45.0}) {
            const double y = 0.01;
            EolCloth cloth = lying_on(make_turning(y, degrees), turn);
            take(cloth);
            expect_sound(cloth.state, 0.16);
            EXPECT_LT(held_off(cloth.state, Vec3(0, y, kThickness)), kOnFeature) << degrees << ", " << turn;
            const std::vector<int> row = along_ridge(cloth.state);
            for (std::size_t k = 1; k < row.size(); ++k)
                EXPECT_TRUE(has_edge(cloth.state, row[k - 1], row[k])) << degrees << ", " << turn;
            EXPECT_GT(least_material_angle(cloth.state.mesh), 3.0) << degrees << ", " << turn;
            // Clean-up must not merge this vertex.
            cloth.state.active.clear();
            const std::optional<ConformedMesh> again = conform(cloth);
            EXPECT_FALSE(again && !again->events.empty()) << degrees << ", " << turn;
        }
}

TEST(Conform, WhereAWireHardlyTurnsItsTraceSlides)
{
    EolCloth cloth = lying_on(make_turning(0.01, 0.5), 10.0);
    take(cloth);
    EXPECT_GT(cloth.state.eol.size(), 5u);
    EXPECT_EQ(held_off(cloth.state, Vec3::Zero()), 1.0);
}

TEST(Conform, OnAWireOfShortEdgesItsTraceSlides)
{
    // An arc of edges, each a third of a cell long, with bends of 12 degrees.
    std::vector<Vec3> points;
    Vec3 at(-0.06, -0.18, 0);
    for (int k = -9; k <= 9; ++k, at += 0.02 * Vec3(-std::sin(0.1 * k), std::cos(0.1 * k), 0))
        points.push_back(at);
    EolCloth cloth = lying_on(MovingObstacle("wire", make_wire(points, false), {}, {}, 30.0), 10.0);
    take(cloth);
    EXPECT_GT(cloth.state.eol.size(), 3u);
    EXPECT_EQ(held_off(cloth.state, Vec3::Zero()), 1.0);
}

TEST(Conform, ATurnThatPressesTakesTheVertexThatSlidesBesideIt)
{
    const double y = 0.01;
    EolCloth cloth = lying_on(make_turning(y, 15.0), 10.0);
    take(cloth);
    for (EolVertex& e : cloth.state.eol) e.on = FeatureId::edge(e.on.obstacle, e.on.index);
    const std::size_t count = cloth.state.eol.size();
    cloth.state.active.clear();
    for (Vec3& x : cloth.state.mesh.world) x.y() += 0.01;  // the cloth has slid along the wire
    press_point(cloth, 1);
    ASSERT_EQ(cloth.state.active.size(), 1u);
    take(cloth);
    expect_sound(cloth.state, 0.16);
    EXPECT_LT(held_off(cloth.state, Vec3(0, y, kThickness)), 1e-4);
    EXPECT_LE(cloth.state.eol.size(), count + 1);
    const auto held = std::count_if(cloth.state.eol.begin(), cloth.state.eol.end(),
                                    [](const EolVertex& e) { return e.on.is_bend(); });
    EXPECT_EQ(held, 1);
}

TEST(Conform, ANewVertexOnAWireIsOnTheSideOfTheTraceBesideIt)
{
    for (const int side : {1, -1}) {
        EolCloth cloth = lying_on(make_turning(0.01, 0.5), 10.0);
        const std::vector<ActiveContact> pressing = cloth.state.active;
        cloth.state.active.resize(pressing.size() / 2);
        take(cloth);
        ASSERT_FALSE(cloth.state.eol.empty());
        for (EolVertex& e : cloth.state.eol) e.side = side;
        const std::size_t before = cloth.state.eol.size();
        cloth.state.active = pressing;
        take(cloth);
        ASSERT_GT(cloth.state.eol.size(), before);
        int near = 0;
        for (const EolVertex& e : cloth.state.eol) near += e.side == side ? 1 : 0;
        EXPECT_GT(near, static_cast<int>(before));
    }
}

TEST(Conform, WhereAWireEndsInTheMiddleOfTheClothTheTraceDoes)
{
    EolCloth cloth =
        lying_on(MovingObstacle("wire", make_wire({{0, -0.3, 0}, {0, 0.021, 0}}, false), {}, {}, 30.0), 0.0);
    take(cloth);
    expect_sound(cloth.state, 0.16);
    ASSERT_FALSE(cloth.state.eol.empty());
    for (const EolVertex& eol : cloth.state.eol)
        EXPECT_LT(cloth.state.mesh.world[cloth.state.index_of(eol.vertex_id)].y(), 0.021 + kOnFeature);
}

TEST(Conform, WhatIsNotOnTheSideToWhichAWirePressesIsNoVertexOfIt)
{
    // Cloth hangs beside a wire, which presses it aside just above one of its vertices. That vertex is near
    // enough, but below the wire. As an EOL vertex it would be pressed down, against the contact above.
    for (const double below : {0.0, 0.5, 2.0}) {
        EolCloth cloth(MovingObstacle("wire", make_wire({{0, -0.5, 0}, {0, 0.5, 0}}, false), {}, {}, 30.0),
                       make_draped({7, 0.0, 180.0}));
        cloth.scene.eol = uniform_target(kLyingCell, 10.0);
        State& state = cloth.state;
        const int v = cloth.vertex_at(0.2 + 0.5 * kLyingCell, 0.2 + 0.5 * kLyingCell);
        const double height = state.mesh.world[v].x() + below * kThickness;
        for (Vec3& x : state.mesh.world) x = Vec3(kThickness, x.y(), x.x() - height);
        for (const MeshEdge& e : edges_of(state)) {
            const int w = e.a == v ? e.b : e.a;
            if ((e.a != v && e.b != v) || state.mesh.world[w].z() > state.mesh.world[v].z() - 1e-9) continue;
            state.active.push_back({{state.ids[e.a], state.ids[e.b]},
                                    ContactKind::Edge,
                                    0,
                                    cloth.scene.obstacles[0].shape().features().edges[0].edge,
                                    Vec3::UnitX(),
                                    1e-6});
        }
        ASSERT_FALSE(state.active.empty());
        const ConformOutcome made = conform_cloth(cloth);
        EXPECT_EQ(made.mesh ? made.mesh->eol.empty() : true, below > 1.0) << below;
        for (const RefusedContact& refused : made.refused) {
            EXPECT_TRUE(below < 1.0 || refused.cause == ConstraintCause::OffPlane) << below;
        }
    }
}

TEST(Conform, NeighboursOnTheFeatureAreJoinedAcrossAnEdgeThatDidNotPress)
{
    EolCloth cloth = lying(0.0);
    press_edges(cloth);
    std::erase_if(cloth.state.active, [&](const ActiveContact& contact) {
        const Vec2 way = cloth.state.mesh.material[cloth.state.index_of(contact.vertex_ids[1])] -
                         cloth.state.mesh.material[cloth.state.index_of(contact.vertex_ids[0])];
        return std::abs(way.x() * way.y()) > 1e-9;  // removes the diagonals
    });
    ASSERT_EQ(cloth.state.active.size(), 8u);
    const ConformedMesh made = take(cloth);
    expect_sound(cloth.state, 0.16);
    const std::vector<int> row = along_ridge(cloth.state);
    ASSERT_GE(row.size(), 8u);
    for (std::size_t k = 1; k < row.size(); ++k) EXPECT_TRUE(has_edge(cloth.state, row[k - 1], row[k])) << k;
    EXPECT_EQ(made.surgery.tagged_edges.size(), row.size() - 1);
}

TEST(Conform, WhereNothingHasChangedTheSecondTimeChangesNothing)
{
    for (const double turn : {0.0, 17.0, 40.0}) {
        EolCloth cloth = lying(turn);
        press_edges(cloth);
        take(cloth);
        cloth.state.active.clear();
        for (const EolVertex& e : cloth.state.eol)
            cloth.state.active.push_back(
                {{e.vertex_id}, ContactKind::Vertex, 0, e.on.index, Vec3::UnitZ(), 1e-6});
        EXPECT_FALSE(conform(cloth)) << "nothing flows";
        // Rows beside the trace press again where EOL vertices already are.
        press_edges(cloth);
        const std::optional<ConformedMesh> again = conform(cloth);
        EXPECT_FALSE(again) << turn << ": " << (again ? again->events.size() : 0) << " operations, "
                            << (again ? again->report.inserted : 0) << " inserted";
        // A small flow may have its way cleared once in each direction, but not again.
        int passes = 0;
        for (int k = 0; k < 12; ++k) {
            for (const EolVertex& e : cloth.state.eol)
                cloth.state.material_velocity[cloth.state.index_of(e.vertex_id)] =
                    (k % 2 == 0 ? 1e-7 : -1e-7) * Vec2(1, -1);
            cloth.state.active.clear();
            const std::optional<ConformedMesh> flowing = conform(cloth);
            if (!flowing) continue;
            EXPECT_LT(k, 4) << turn << ": " << flowing->events.size();
            EXPECT_EQ(flowing->report.released + flowing->report.inserted, 0);
            ++passes;
            TransferReport report;
            cloth.state = transfer(cloth.scene, cloth.state, cloth.stars(), *flowing,
                                   testing::stars_of(flowing->surgery.mesh), report);
        }
        EXPECT_LE(passes, 2) << turn;
    }
}

TEST(Conform, NearABorderThatRunsAlongARowStaysARow)
{
    for (const double cells : {0.1, 0.28, 0.32, 0.6}) {  // cells from the border x = -0.2 of the cloth
        EolCloth cloth = lying(0.0, 0.2 - cells * kLyingCell);
        press_edges(cloth);
        ASSERT_GT(cloth.state.active.size(), 6u);
        const std::optional<ConformedMesh> made = conform(cloth);
        ASSERT_EQ(made.has_value(), cells > 0.3) << cells;
        if (made) {
            EXPECT_GT(made->eol.size(), 4u);
        }
    }
}

TEST(Conform, WhereTheClothComesFastItWouldHaveToGoAtOnce)
{
    // 0.6 cells (34 mm) of material are left; one step uses up 5 mm for each m/s.
    for (const double speed : {0.0, 0.1, 2.0, 20.0}) {
        EolCloth cloth = lying(0.0, 0.2 - 0.6 * kLyingCell);
        for (Vec3& v : cloth.state.velocity) v = Vec3(speed, 0, 0);
        press_edges(cloth);
        EXPECT_EQ(conform(cloth).has_value(), speed < 1.0) << speed;
    }
}

TEST(Conform, WhereTheBorderComesAtOnceTheTraceGoesAndTheBorderStays)
{
    EolCloth cloth = lying(0.0, 0.2 - 0.6 * kLyingCell);
    press_edges(cloth);
    take(cloth);
    State& state = cloth.state;
    ASSERT_GT(state.eol.size(), 5u);
    for (const EolVertex& e : state.eol)
        state.material_velocity[state.index_of(e.vertex_id)] = Vec2(-3.0, 0.0);
    const auto on_border = [](const ClothMesh& mesh) {
        return std::count_if(mesh.material.begin(), mesh.material.end(),
                             [](const Vec2& X) { return X.x() <= 0.0; });
    };
    const std::optional<ConformedMesh> made = conform(cloth);
    ASSERT_TRUE(made);
    EXPECT_TRUE(made->eol.empty());
    EXPECT_EQ(on_border(made->surgery.mesh), on_border(state.mesh));
    EXPECT_EQ(validate(made->surgery.mesh), "");
}

/// Cloth folded along a mesh line, moved 1.5 mm off the ridge along one of its sides. Near the fold its edges
/// press on the ridge.
EolCloth folded_beside(double speed)
{
    EolCloth cloth(make_ridge(60.0), make_draped({8, 0.0, 110.0}));
    cloth.scene.eol = uniform_target(0.05, 10.0);
    cloth.scene.materials[0].youngs_modulus = 2000.0;
    const double half = 55.0 * M_PI / 180.0;
    const Vec3 way(std::sin(half), 0.0, std::cos(half));  // upwards along the left side
    for (std::size_t v = 0; v < cloth.state.ids.size(); ++v) {
        Vec3& x = cloth.state.mesh.world[v];
        cloth.state.velocity[v] =
            speed * (x.x() > 1e-9 ? Vec3(way.x(), 0.0, -way.z()) : Vec3(way.x(), 0.0, way.z()));
        x += 1.5e-3 * way + Vec3(0.0, 0.0, kThickness / std::sin(half));
    }
    press_edges(cloth);
    return cloth;
}

TEST(Conform, BesideAFoldThatHasLeftTheFeatureAVertexIsPutWhereTheFoldGoesOn)
{
    // The cloth slides on: the fold is behind the ridge and left in place.
    const EolCloth leaving = folded_beside(0.3);
    ASSERT_GT(leaving.state.active.size(), 5u);
    const std::optional<ConformedMesh> on = conform(leaving);
    ASSERT_TRUE(on);
    EXPECT_GE(on->eol.size(), 7u);
    const auto world_of = [&](VertexId id) {
        const auto& ids = on->surgery.ids;
        return on->surgery.mesh.world[std::lower_bound(ids.begin(), ids.end(), id) - ids.begin()];
    };
    for (const EolVertex& e : on->eol) EXPECT_LT(std::abs(world_of(e.vertex_id).x()), 0.1 * kThickness);
    for (std::size_t v = 0; v < leaving.state.ids.size(); ++v) {
        if (std::abs(leaving.state.mesh.material[v].x() - 0.2) > 1e-9) continue;
        EXPECT_EQ(leaving.state.mesh.world[v], world_of(leaving.state.ids[v]));
    }
    EXPECT_EQ(validate(on->surgery.mesh), "");

    // The cloth slides back: the old fold would reach the ridge at once, and it leaves no room for a new
    // vertex.
    EolCloth returning = folded_beside(-0.3);
    const std::optional<ConformedMesh> made = conform(returning);
    EXPECT_TRUE(!made || made->eol.empty());
}

/// Flat cloth whose trace has moved some cells off the ridge while material flows through it. Rows with the
/// given normal press where cloth edges cross the ridge.
EolCloth flown_off(double cells, const Vec3& normal)
{
    constexpr double kFlow = 2.0;  // m/s: too fast for a fold to stay on its edge
    EolCloth cloth = lying(0.0);
    press_edges(cloth);
    take(cloth);
    for (Vec3& x : cloth.state.mesh.world) x.x() += cells * kLyingCell;
    for (Vec3& v : cloth.state.velocity) v = Vec3(kFlow, 0, 0);
    for (const EolVertex& e : cloth.state.eol) {
        const int v = cloth.state.index_of(e.vertex_id);
        cloth.state.velocity[v].setZero();
        cloth.state.material_velocity[v] = Vec2(-kFlow, 0);
    }
    cloth.state.active.clear();
    press_edges(cloth);
    for (ActiveContact& contact : cloth.state.active) contact.normal = normal;
    return cloth;
}

TEST(Conform, BehindAFoldThatHasFlownOffWhatLiesFlatOnAFaceGetsNoTrace)
{
    for (const double cells : {0.2, 0.8, 1.5}) {
        const MovingObstacle ridge = make_ridge(60.0);
        const Vec3 along = ridge.shape().features().edges[testing::tip_of(ridge.shape())].normals[0];
        const EolCloth cloth = flown_off(cells, along);
        ASSERT_GT(cloth.state.active.size(), 5u) << cells;
        const ConformOutcome outcome = conform_cloth(cloth);
        EXPECT_TRUE(!outcome.mesh || outcome.mesh->eol.size() == cloth.state.eol.size()) << cells;
        EXPECT_GT(
            std::count_if(outcome.refused.begin(), outcome.refused.end(),
                          [](const RefusedContact& r) { return r.cause == ConstraintCause::FlatBehind; }),
            5)
            << cells;
    }
}

TEST(Conform, BehindAFoldThatHasFlownOffWhatIsFoldedGetsATraceOfItsOwnWhereThereIsRoom)
{
    for (const double cells : {0.2, 0.8, 1.2, 1.5}) {
        const EolCloth cloth = flown_off(cells, Vec3::UnitZ());
        ASSERT_GT(cloth.state.active.size(), 5u) << cells;
        const std::optional<ConformedMesh> made = conform(cloth);
        ASSERT_TRUE(made) << cells;
        std::vector<VertexId> on, off;
        const std::vector<Vec3>& x = made->surgery.mesh.world;
        const std::vector<VertexId>& ids = made->surgery.ids;
        for (const EolVertex& e : made->eol) {
            const auto v = std::lower_bound(ids.begin(), ids.end(), e.vertex_id) - ids.begin();
            (std::abs(x[v].x()) < kThickness ? on : off).push_back(e.vertex_id);
        }
        EXPECT_GE(off.size(), cloth.state.eol.size()) << cells << ": the fold stays";
        if (cells < 1.0)
            EXPECT_EQ(on.size(), 0u) << cells;
        else
            EXPECT_GT(on.size(), 5u) << cells;
        for (const SurgeryResult::TaggedEdge& edge : made->surgery.tagged_edges)
            EXPECT_NEAR(x[edge.a].x(), x[edge.b].x(), kThickness) << cells << ": two traces are joined";
        EXPECT_EQ(validate(made->surgery.mesh), "");
    }
}

TEST(Conform, ACornerBecomesANodeAtWhichTheTraceEnds)
{
    EolCloth cloth = lying(12.0, 0.003, 0.1);
    press_edges(cloth);
    press_corner(cloth);
    ASSERT_EQ(cloth.state.active.back().kind, ContactKind::Triangle);
    take(cloth);
    expect_sound(cloth.state, 0.16);
    const Obstacle& ridge = cloth.scene.obstacles[0].shape();
    const std::vector<int> row = along_ridge(cloth.state);
    ASSERT_GT(row.size(), 2u);
    const EolVertex& last = cloth.state.eol[cloth.state.eol_entry(cloth.state.ids[row.back()])];
    EXPECT_TRUE(last.on.is_corner());
    EXPECT_EQ(last.on.index, testing::end_of(ridge));
    EXPECT_LT((cloth.state.mesh.world[row.back()] - Vec3(0, 0.1, kThickness)).norm(), kOnFeature);
    for (std::size_t k = 1; k < row.size(); ++k) EXPECT_TRUE(has_edge(cloth.state, row[k - 1], row[k])) << k;
}

TEST(Conform, ACornerGoesWithATraceThatComesToItAsTheClothSlides)
{
    for (const double speed : {0.0, 1.0}) {
        EolCloth cloth = lying(0.0, 0.003, 0.1);
        press_edges(cloth);
        take(cloth);
        State& state = cloth.state;
        for (std::size_t v = 0; v < state.ids.size(); ++v) {
            const bool is_eol = state.eol_entry(state.ids[v]) >= 0;
            state.velocity[v] = Vec3(is_eol ? 0.0 : speed, 0.0, 0.0);
            state.material_velocity[v] = Vec2(is_eol ? -speed : 0.0, 0.0);
        }
        state.active.clear();
        press_corner(cloth);
        ASSERT_EQ(state.active.size(), 1u);
        const auto made = conform(cloth);
        const bool has_corner = made && std::any_of(made->eol.begin(), made->eol.end(),
                                                    [](const EolVertex& e) { return e.on.is_corner(); });
        EXPECT_TRUE(has_corner) << speed;
    }
}

TEST(Conform, WhatHasNotPressedForThreeStepsIsReleased)
{
    EolCloth cloth = lying(17.0);
    press_edges(cloth);
    take(cloth);
    cloth.state.active.clear();
    const std::size_t count = cloth.state.eol.size();
    for (EolVertex& e : cloth.state.eol) e.idle = 2;
    EXPECT_FALSE(conform(cloth)) << "two steps are not for long";

    // An idle vertex in the middle stays, so that the trace gets no hole. The last one along the ridge may be
    // released.
    std::vector<std::pair<double, std::size_t>> along;
    for (std::size_t k = 0; k < count; ++k) {
        const int v = cloth.state.index_of(cloth.state.eol[k].vertex_id);
        along.emplace_back(cloth.state.mesh.world[v].y(), k);
    }
    std::sort(along.begin(), along.end());
    EolCloth one = cloth;
    one.state.eol[along[count / 2].second].idle = 3;
    EXPECT_FALSE(conform(one));
    one = cloth;
    one.state.eol[along.back().second].idle = 3;
    const VertexId idle = one.state.eol[along.back().second].vertex_id;
    const ConformedMesh released = take(one);
    EXPECT_EQ(released.report.released, 1);
    EXPECT_EQ(one.state.eol_entry(idle), -1);
    EXPECT_LT(one.state.eol.size(), count);
    expect_sound(one.state, 0.16);

    for (EolVertex& e : cloth.state.eol) e.idle = 3;
    EXPECT_EQ(take(cloth).report.released, static_cast<int>(count));
    EXPECT_TRUE(cloth.state.eol.empty());
    expect_sound(cloth.state, 0.16);
    EXPECT_FALSE(conform(cloth));
}

TEST(Conform, WhatHasLeftItsStretchOfTheFeatureIsReleased)
{
    for (const double beyond : {-0.02, 0.02}) {
        EolCloth cloth = lying(0.0, 0.0, 0.3);
        press_edges(cloth);
        take(cloth);
        cloth.state.active.clear();
        const std::vector<int> row = along_ridge(cloth.state);
        const double move = 0.3 + beyond - cloth.state.mesh.world[row.back()].y();
        for (Vec3& x : cloth.state.mesh.world) x.y() += move;
        const std::optional<ConformedMesh> made = conform(cloth);
        ASSERT_EQ(made.has_value(), beyond > 0.0);
        if (made) {
            EXPECT_GE(made->report.released, 1);
        }
    }
}

TEST(Conform, AVertexThatIsGivenUpIsReleasedTheOthersOfItsTraceStayAndNothingIsInserted)
{
    EolCloth cloth = lying(17.0);
    press_edges(cloth);
    take(cloth);
    const std::size_t count = cloth.state.eol.size();
    ASSERT_GT(count, 5u);
    for (const EolVertex& e : cloth.state.eol)
        cloth.state.material_velocity[cloth.state.index_of(e.vertex_id)] = Vec2(1e-3, 0);
    const int given_up = along_ridge(cloth.state)[3];
    cloth.state.active.clear();
    press_edges(cloth);
    const EolVertex released = cloth.state.eol[cloth.state.eol_entry(cloth.state.ids[given_up])];
    const std::optional<ConformedMesh> made = conform(cloth, {{}, {released.vertex_id}});
    ASSERT_TRUE(made);
    EXPECT_EQ(made->eol.size(), count - 1);
    for (const EolVertex& e : made->eol) EXPECT_NE(e.vertex_id, released.vertex_id);
    EXPECT_EQ(made->report.inserted, 0);
    EXPECT_EQ(made->report.released, 1);
    EXPECT_EQ(validate(made->surgery.mesh), "");
}

TEST(Conform, WhereANewVertexHadNotEnoughMaterialNoneIsMadeAndOthersAre)
{
    EolCloth cloth = lying(17.0);
    press_edges(cloth);
    const std::optional<ConformedMesh> first = conform(cloth);
    ASSERT_TRUE(first);
    const auto nearest = [](const ConformedMesh& made, const Vec2& at) {
        double least = 1.0;
        for (const EolVertex& e : made.eol) {
            const auto& ids = made.surgery.ids;
            const auto v = std::lower_bound(ids.begin(), ids.end(), e.vertex_id) - ids.begin();
            least = std::min(least, (made.surgery.mesh.material[static_cast<std::size_t>(v)] - at).norm());
        }
        return least;
    };
    const std::uint32_t failed = first->eol[first->eol.size() / 2].vertex_id;
    const auto& ids = first->surgery.ids;
    const auto v = std::lower_bound(ids.begin(), ids.end(), failed) - ids.begin();
    const Vec2 at = first->surgery.mesh.material[static_cast<std::size_t>(v)];
    FailedFlow flow;
    flow.made_at = {at};
    const std::optional<ConformedMesh> second = conform(cloth, flow);
    ASSERT_TRUE(second);
    EXPECT_EQ(nearest(*first, at), 0.0);
    EXPECT_GT(nearest(*second, at), 0.45 * kLyingCell);
    EXPECT_GT(second->eol.size(), first->eol.size() / 2);
    EXPECT_EQ(validate(second->surgery.mesh), "");
}

/// Conforms cloth whose trace flows towards held vertices, by `share` of the distance to them in a step.
std::optional<ConformedMesh> flow_at_held(EolCloth cloth, double share)
{
    take(cloth);
    State& state = cloth.state;
    double ahead = 1.0, trace = 0.0;
    for (const EolVertex& e : state.eol) trace = state.mesh.material[state.index_of(e.vertex_id)].x();
    for (int v = 0; v < state.mesh.vertex_count(); ++v) {
        const double way = state.mesh.material[v].x() - trace;
        if (state.eol_entry(state.ids[v]) >= 0) continue;
        if (way > 0.0) ahead = std::min(ahead, way);
        const Vec2& X = state.mesh.material[v];
        cloth.scene.pins.push_back({{X - Vec2(1e-6, 1e-6), X + Vec2(1e-6, 1e-6)}, {}});
    }
    for (const EolVertex& e : state.eol)
        state.material_velocity[state.index_of(e.vertex_id)] = Vec2(share * ahead / kStep, 0.0);
    return conform(cloth);
}

TEST(Conform, WhatCannotBeClearedIsLetGoFourStepsAheadOnAnEdgeAndWhereTheNextIsNotClearOnAWire)
{
    const auto wire =
        lying_on(MovingObstacle("wire", make_wire({{0, -0.3, 0}, {0, 0.3, 0}}, false), {}, {}, 30.0), 0.0);
    EolCloth ridge = lying(0.0, 0.003);
    press_edges(ridge);
    const auto released = [](const std::optional<ConformedMesh>& made) {
        return made ? made->report.released : 0;
    };
    EXPECT_GT(released(flow_at_held(ridge, 0.4)), 0);
    EXPECT_EQ(released(flow_at_held(wire, 0.4)), 0);
    EXPECT_GT(released(flow_at_held(wire, 0.8)), 0);
    EXPECT_EQ(released(flow_at_held(ridge, 0.2)), 0);
}

TEST(Conform, WithoutATargetOrWithoutContactsThereIsNothingToDo)
{
    EolCloth cloth = lying(17.0);
    EXPECT_FALSE(conform(cloth));
    press_edges(cloth);
    cloth.scene.eol.reset();
    EXPECT_FALSE(conform(cloth));
}

/// Height of a point above the cloth, m; 0 if no cloth is above or below the point.
double height_over(const ClothMesh& mesh, const Vec3& point)
{
    for (const Face& f : mesh.faces) {
        const Vec3 &a = mesh.world[f[0]], &b = mesh.world[f[1]], &c = mesh.world[f[2]];
        const Vec2 p = point.head<2>(), q = a.head<2>(), r = b.head<2>(), s = c.head<2>();
        const double area = twice_area(q, r, s);
        const double of_a = twice_area(p, r, s) / area, of_b = twice_area(q, p, s) / area;
        if (of_a < 0.0 || of_b < 0.0 || of_a + of_b > 1.0) continue;
        return point.z() - (of_a * a.z() + of_b * b.z() + (1.0 - of_a - of_b) * c.z());
    }
    return 0.0;
}

TEST(Conform, NothingOfAnObstacleGetsThroughTheCloth)
{
    // Wavy, very soft cloth, so that no strain prevents mesh changes. Nails are 10 micrometres from its
    // faces.
    EolCloth cloth = lying(17.0);
    cloth.scene.gravity = Gravity{};
    cloth.scene.materials[0].youngs_modulus = 1e-3;
    for (Vec3& x : cloth.state.mesh.world)
        x.z() += 0.001 + 0.002 * std::sin(40.0 * x.x()) * std::sin(20.0 * x.y());
    press_edges(cloth);
    const State& state = cloth.state;
    std::vector<Vec3> nails;
    for (const Face& f : state.mesh.faces) {
        const Vec3 middle = (state.mesh.world[f[0]] + state.mesh.world[f[1]] + state.mesh.world[f[2]]) / 3.0;
        nails.push_back(middle + Vec3(0, 0, nails.size() % 2 == 0 ? 1e-5 : -1e-5));
    }
    const auto count_passed = [&](const ClothMesh& mesh) {
        return std::count_if(nails.begin(), nails.end(), [&](const Vec3& nail) {
            return height_over(state.mesh, nail) * height_over(mesh, nail) < 0.0;
        });
    };
    const std::optional<ConformedMesh> unhindered = conform(cloth);
    ASSERT_TRUE(unhindered);
    EXPECT_GT(count_passed(unhindered->surgery.mesh), 3);

    cloth.scene.obstacles.push_back(MovingObstacle("nails", make_points(nails), {}, {}, 30.0));
    const std::optional<ConformedMesh> made = conform(cloth);
    ASSERT_TRUE(made);
    EXPECT_GT(made->report.inserted, 0) << "splits pass nothing";
    EXPECT_EQ(count_passed(made->surgery.mesh), 0);
}

/// Complete steps with gravity: cloth falls on a ridge and hangs down on both sides.
TEST(ConformedSteps, ClothThatFallsOnARidgeBendsOnVerticesOfIt)
{
    for (const double turn : {0.0, 17.0}) {
        EolCloth cloth = lying(turn);
        cloth.scene.materials[0].thickness = kThickness;
        cloth.scene.gravity = Gravity{};
        State& state = cloth.state;
        for (Vec3& x : state.mesh.world) x.z() += 2e-3;
        Workspace work;
        int steps_with_eol = 0, most = 0;
        for (int k = 0; k < 30 && !::testing::Test::HasFailure(); ++k) {
            const auto accept = [&](const StepReport& report, bool) {
                EXPECT_EQ(report.crossings, 0);
                expect_sound(state, 0.16);
                EXPECT_EQ(audit(cloth.scene, state.mesh, state.time).obstacle, -1) << state.time;
                for (std::size_t v = 0; v < state.ids.size(); ++v)
                    if (state.eol_entry(state.ids[v]) < 0) {
                        EXPECT_TRUE(state.material_velocity[v].isZero());
                    }
                return true;
            };
            ASSERT_FALSE(advance(cloth.scene, Settings(), state.time + kStep, state, work, accept));
            steps_with_eol += state.eol.empty() ? 0 : 1;
            most = std::max(most, static_cast<int>(state.eol.size()));
            for (const EolVertex& e : state.eol) {
                const Vec3& x = state.mesh.world[state.index_of(e.vertex_id)];
                // The vertex may move in the plane x = 0.
                EXPECT_NEAR(x.x(), 0.0, 0.1 * kThickness) << state.time;
            }
        }
        EXPECT_GT(steps_with_eol, 15) << turn;
        EXPECT_GT(most, 5) << turn;
    }
}

TEST(Conform, OnARimWhatSlidesBesideABendThatPressesGoesThere)
{
    int tried = 0;
    for (int point = 0; point < 32; ++point) {
        EolCloth cloth = testing::make_disk_cloth(1.0);
        const Obstacle& disk = cloth.scene.obstacles[0].shape();
        if (disk.mesh().points[point].z() < -0.05) continue;
        testing::press_faces_on(point, cloth.state);
        take(cloth);
        ASSERT_GE(cloth.state.eol.size(), 1u) << point;
        const EolVertex made = cloth.state.eol[0];
        const std::size_t count = cloth.state.eol.size();
        // The cloth moves along the vertex's edge, away from the bend.
        const auto [a, b] = feature_segment(disk, made.on.index);
        const bool is_from = (a - disk.mesh().points[point]).norm() < 1e-9;
        const Vec3 way = (is_from ? b - a : a - b).normalized();
        for (Vec3& x : cloth.state.mesh.world) x += 0.2 * testing::kLyingCell * way;
        testing::press_faces_on(point, cloth.state);
        const std::vector<FeatureSite> sites = find_feature_sites(cloth.scene, cloth.state, cloth.stars());
        ASSERT_GE(sites.size(), 1u) << point;
        take(cloth);
        EXPECT_EQ(cloth.state.eol.size(), count) << point;
        const int v = cloth.state.index_of(made.vertex_id);
        ASSERT_GE(cloth.state.eol_entry(made.vertex_id), 0) << point;
        const auto distance_to = [&](const FeatureSite& site) {
            return (cloth.state.mesh.material[v] - site.material).norm();
        };
        double least = distance_to(sites[0]);
        for (const FeatureSite& site : sites) least = std::min(least, distance_to(site));
        EXPECT_LT(least, 1e-12) << point;
        expect_sound(cloth.state, 0.16);
        ++tried;
    }
    EXPECT_EQ(tried, 16);
}

TEST(ConformedSteps, WhatOverrunsInEveryAttemptBecomesRowsInAFew)
{
    EolCloth cloth = lying(17.0);
    press_edges(cloth);
    take(cloth);
    State& state = cloth.state;
    const std::size_t count = state.eol.size();
    ASSERT_GT(count, 5u);
    // The present flow is zero, so no way is blocked. The history extrapolates to a flow of metres in the
    // next step.
    state.previous_dt = kStep;
    state.previous_world = state.mesh.world;
    state.previous_velocity = state.velocity;
    state.previous_material = state.mesh.material;
    for (std::size_t v = 0; v < state.ids.size(); ++v)
        state.previous_material_velocity[v] =
            state.eol_entry(state.ids[v]) < 0 ? Vec2::Zero() : Vec2(-1e4, 0.0);
    Workspace work;
    int attempts = 0;
    StepReport report;
    do {
        report = step(cloth.scene, Settings(), state.time + kStep, state, work);
        ++attempts;
    } while (report.status == StepStatus::Overrun && attempts < 20);
    EXPECT_EQ(report.status, StepStatus::Done);
    EXPECT_GT(attempts, 2);
    EXPECT_LE(attempts, RetryPolicy::kMostOverruns + 2);
    EXPECT_LT(state.eol.size(), count);
    expect_sound(state, 0.16);
    EXPECT_TRUE(work.retry.flow().empty());
}

}  // namespace
}  // namespace arris
