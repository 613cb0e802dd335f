// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/eol/eol_coordinates.h"
#include "solver/eol/eol_features.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "geometry/cloth/cloth_cone.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "tests/solver/eol_cloth.h"

namespace arris {
namespace {

using testing::Drape;
using testing::EolCloth;
using testing::kThickness;
using testing::make_draped;
using testing::make_ridge;

constexpr double kRoundOff = 1e-12;  // of unit vectors, through a few products of 2 x 2 matrices

double radians(double degrees)
{
    return degrees * std::numbers::pi / 180.0;
}

/// Cloth of the given shape on a ridge of `tip` degrees.
EolCloth on_ridge(const Drape& shape, double tip = 60.0)
{
    return EolCloth(make_ridge(tip), make_draped(shape));
}

EolCloth on_wire(const Drape& shape)
{
    return EolCloth(MovingObstacle("wire", make_wire({{0, -1, 0}, {0, 1, 0}}, false), {}, {}, 30.0),
                    make_draped(shape));
}

/// Makes the vertex in the middle EOL on the ridge's tip (or the wire) and places it.
EolPlacing place_middle(EolCloth cloth, bool is_wire = false)
{
    const int v = cloth.vertex_at(0.2, 0.2);
    cloth.add_eol(v, false, is_wire ? 0 : testing::tip_of(cloth.scene.obstacles[0].shape()));
    return cloth.place(v);
}

void expect_parallel(const Vec2& a, const Vec2& b)
{
    EXPECT_NEAR(a.norm(), 1.0, kRoundOff);
    EXPECT_NEAR(std::abs(a.dot(b)), 1.0, kRoundOff) << a.transpose() << " and " << b.transpose();
}

/// Kinetic energy when the vertex alone moves, with its coordinates changing at this rate.
double energy_of(EolCloth cloth, const EolCoordinates& at, const Vec3& u)
{
    cloth.state.velocity[at.vertex] = at.basis * u;
    cloth.state.material_velocity[at.vertex] = at.material_basis * u;
    return testing::kinetic_energy_of(cloth.scene, cloth.state);
}

TEST(EolCoordinates, OnAnEdgeAreOutwardAlongAndTheFlowAcross)
{
    for (const double tip : {5.0, 60.0, 120.0})  // 5 degrees: a knife
        for (const double fold : {tip, 180.0}) {
            const EolPlacing placing = place_middle(on_ridge({8, 0.0, fold}, tip));
            ASSERT_TRUE(placing.coordinates) << tip;
            const EolCoordinates& at = *placing.coordinates;
            EXPECT_LT((at.basis.col(0) - Vec3::UnitZ()).norm(), kRoundOff);
            EXPECT_NEAR(std::abs(at.basis.col(1).y()), 1.0, kRoundOff);
            EXPECT_TRUE(at.basis.col(2).isZero()) << "flow leaves the vertex where it is";
            EXPECT_TRUE(at.material_basis.leftCols<2>().isZero()) << "moving it carries its material along";
            expect_parallel(at.material_basis.col(2), Vec2::UnitX());
            EXPECT_EQ(at.opening[0], 1.0);
        }
}

TEST(EolCoordinates, OnAWireAreOutwardWhereTheClothIs)
{
    for (const double side : {1.0, -1.0}) {
        EolCloth cloth = on_wire({8, 0.0, 150.0});
        const int v = cloth.vertex_at(0.2, 0.2);
        cloth.state.eol[cloth.add_eol(v, false, 0)].outward = Vec3(0, 0, side);
        const EolPlacing placing = cloth.place(v);
        ASSERT_TRUE(placing.coordinates);
        EXPECT_LT((placing.coordinates->basis.col(0) - Vec3(0, 0, side)).norm(), kRoundOff);
        expect_parallel(placing.coordinates->material_basis.col(2), Vec2::UnitX());
    }
    // Where the cloth is folded over the wire by more than a right angle, the fold itself decides the side.
    EolCloth hanging = on_wire({8, 0.0, 20.0});
    const int v = hanging.vertex_at(0.2, 0.2);
    hanging.state.eol[hanging.add_eol(v, false, 0)].outward = Vec3(0, 0, -1);
    const EolPlacing placing = hanging.place(v);
    ASSERT_TRUE(placing.coordinates);
    EXPECT_LT((placing.coordinates->basis.col(0) - Vec3::UnitZ()).norm(), kRoundOff);
}

TEST(EolCoordinates, OnAWireOutwardTurnsEvenlyAndDoesNotDependOnTheMesh)
{
    // For any direction of the mesh relative to the wire, from flat to completely folded cloth.
    for (const double turn : {0.0, 17.0, 30.0, 45.0})
        for (const double fold : {180.0, 150.0, 100.0, 95.0, 90.0, 85.0, 80.0, 30.0, 2.0}) {
            EolCloth cloth = on_wire({8, turn, fold});
            const int v = cloth.vertex_at(0.2, 0.2);
            cloth.add_eol(v, false, 0);
            const EolPlacing placing = cloth.place(v);
            ASSERT_TRUE(placing.coordinates) << turn << ' ' << fold;
            const double off = std::acos(std::min(placing.coordinates->basis(2, 0), 1.0));
            // A turned mesh has faces cut by the wire's line; they belong to neither side.
            EXPECT_LT(off, turn == 0.0 ? 1e-6 : radians(12.0)) << turn << ' ' << fold;
        }
}

TEST(EolCoordinates, OnAWireTheSideIsRememberedWhereTheFoldDoesNotShowIt)
{
    for (const int side : {1, -1}) {
        EolCloth flat = on_wire({8, 0.0, 0.0});  // completely folded: the normals cancel
        const int v = flat.vertex_at(0.2, 0.2);
        flat.state.eol[flat.add_eol(v, false, 0)].side = side;
        const EolPlacing placing = flat.place(v);
        ASSERT_TRUE(placing.coordinates);
        EXPECT_EQ(placing.coordinates->side, side);
        EXPECT_LT((placing.coordinates->basis.col(0) - Vec3::UnitZ()).norm(), kRoundOff);
    }
    EolCloth open = on_wire({8, 0.0, 120.0});
    const int v = open.vertex_at(0.2, 0.2);
    open.add_eol(v, false, 0);
    EXPECT_EQ(open.place(v).coordinates->side, 1) << "the grid's normals point up";
}

TEST(EolCoordinates, OnAWireTheVertexFollowsIntoTheOutwardPlane)
{
    EolCloth cloth = on_wire({8, 0.0, 90.0});
    const int v = cloth.vertex_at(0.2, 0.2);
    cloth.add_eol(v, false, 0);
    cloth.state.mesh.world[v] += Vec3(1e-4, 0.0, 1e-3);
    const auto place_in = [&](double dt) {
        return place_eol_vertex(cloth.scene.obstacles[0].shape(), cloth.scene.materials.thickness(),
                                cloth.state, 0, cloth.stars(), cloth.state.mesh.world, {}, dt);
    };
    const EolPlacing placing = place_in(1.0);
    ASSERT_TRUE(placing.coordinates);
    EXPECT_LT(std::abs(placing.coordinates->carried.x()), 0.6e-4);
    EXPECT_NEAR(placing.coordinates->carried.y(), cloth.state.mesh.world[v].y(), kRoundOff);
    EXPECT_NEAR(placing.coordinates->carried.z(), 1e-3, 1e-5);
    // In a step of length 0 the vertex stays, and outward points from the wire to the vertex.
    EXPECT_LT((place_in(0.0).coordinates->carried - cloth.state.mesh.world[v]).norm(), kRoundOff);
    EXPECT_LT(place_in(0.0).coordinates->basis.col(0).cross(Vec3(0.1, 0.0, 1.0)).norm(), kRoundOff);
}

TEST(EolCoordinates, WhatHasLeftAWireIsNotCarriedRoundIt)
{
    for (const double thicknesses : {1.0, 2.0, 4.0, 40.0}) {
        EolCloth cloth = on_wire({8, 0.0, 90.0});
        const int v = cloth.vertex_at(0.2, 0.2);
        cloth.add_eol(v, false, 0);
        cloth.state.mesh.world[v] += thicknesses * kThickness * Vec3(0.1, 0.0, 1.0);
        const EolPlacing placing = place_eol_vertex(cloth.scene.obstacles[0].shape(), kThickness, cloth.state,
                                                    0, cloth.stars(), cloth.state.mesh.world, {}, 1.0);
        ASSERT_TRUE(placing.coordinates);
        const double carried = (placing.coordinates->carried - cloth.state.mesh.world[v]).norm();
        if (thicknesses > kOnFeature) {
            EXPECT_LT(carried, kRoundOff) << thicknesses;
        } else {
            EXPECT_GT(carried, 0.01 * thicknesses * kThickness) << thicknesses;
        }
    }
}

TEST(EolCoordinates, WhereAWireTurnsAreOutwardAndFlowBothWays)
{
    // The vertex is held at the bend, with a frame halfway between those of the two edges. The cloth is
    // folded as over a straight wire.
    for (const double fold : {180.0, 90.0, 20.0}) {
        EolCloth cloth(
            MovingObstacle("wire", make_wire({{0.1, -1, 0}, {0, 0, 0}, {0.1, 1, 0}}, false), {}, {}, 30.0),
            make_draped({8, 0.0, fold}));
        const int v = cloth.vertex_at(0.2, 0.2);
        const std::optional<FeatureBend> turn = find_bend(cloth.scene.obstacles[0].shape(), 1);
        ASSERT_TRUE(turn);
        EolVertex& eol = cloth.state.eol[cloth.add_eol(v, false, turn->feature)];
        eol.outward = Vec3::UnitZ();
        eol.on = FeatureId::bend(eol.on.obstacle, eol.on.index, turn->end);
        const EolPlacing placing = cloth.place(v);
        ASSERT_TRUE(placing.coordinates) << fold;
        const EolCoordinates& at = *placing.coordinates;
        EXPECT_LT((at.basis.col(0) - Vec3::UnitZ()).norm(), kRoundOff) << fold;
        EXPECT_TRUE(at.basis.rightCols(2).isZero(0.0)) << "it stays where the wire turns";
        EXPECT_LT((at.frame.point - Vec3::Zero()).norm(), kRoundOff);
        EXPECT_NEAR(std::abs(at.frame.tangent.y()), 1.0, kRoundOff);
        expect_parallel(at.material_basis.col(1), Vec2::UnitY());
        expect_parallel(at.material_basis.col(2), Vec2::UnitX());
        follow_features(cloth.scene.obstacles, cloth.state);
        EXPECT_EQ(cloth.state.eol[0].on.index, turn->feature);
        EXPECT_EQ(cloth.state.eol[0].on.end, turn->end);
    }
}

TEST(EolCoordinates, OnACornerAreOutwardAndAnyFlow)
{
    EolCloth cloth(make_ridge(60.0, 0.0001 + 0.2), make_draped({8, 0.0, 60.0}));
    const int v = cloth.vertex_at(0.2, 0.35);
    cloth.add_eol(v, true, testing::end_of(cloth.scene.obstacles[0].shape()));
    const EolPlacing placing = cloth.place(v);
    ASSERT_TRUE(placing.coordinates);
    const EolCoordinates& at = *placing.coordinates;
    EXPECT_NEAR(at.basis.col(0).norm(), 1.0, kRoundOff);
    EXPECT_NEAR(at.basis.col(0).x(), 0.0, kRoundOff) << "the ridge is symmetric";
    EXPECT_GT(at.basis.col(0).y(), 0.1);
    EXPECT_GT(at.basis.col(0).z(), 0.1);
    EXPECT_TRUE(at.basis.rightCols<2>().isZero());
    EXPECT_TRUE(at.material_basis.col(0).isZero());
    const Mat2 flow = at.material_basis.rightCols<2>();
    EXPECT_GT(std::abs(flow.determinant()), 0.5) << "the material flows any way";
}

/// A tent on a nail. Its top is a thickness from the nail in the direction `top`; all but one of its sides
/// are steep.
EolCloth on_nail(const Vec3& top)
{
    EolCloth cloth(MovingObstacle("nail", make_points({Vec3::Zero()}), {}, {}, 30.0),
                   make_draped({8, 0.0, 180.0}));
    for (Vec3& x : cloth.state.mesh.world)
        x.z() = -1.5 * std::hypot(x.x(), x.y()) + 0.5 * std::max(x.x(), 0.0);
    const int v = cloth.vertex_at(0.2, 0.2);
    for (Vec3& x : cloth.state.mesh.world) x += kThickness * top;
    cloth.add_eol(v, true, 0);
    return cloth;
}

/// Sine of the angle between the faces around the vertex and the direction from `place` to the nail's tip.
double room_at(const EolCloth& cloth, int v, const Vec3& place)
{
    const ClothStars stars = cloth.stars();
    double room = 1.0;
    for (const int f : stars.faces[v]) {
        FaceSector sector;
        int k = 0;
        for (const int w : cloth.state.mesh.faces[f])
            if (w != v) sector[k++] = (cloth.state.mesh.world[w] - cloth.state.mesh.world[v]).normalized();
        room = std::min(room, sine_to_sector(sector, -place.normalized()));
    }
    return room;
}

TEST(EolCoordinates, OnANailTheVertexGoesRoundItToWhereItsClothHasRoomForIt)
{
    constexpr double kStep = 5e-3;  // s: half a thickness at 0.1 m/s
    for (const Vec3& top : {Vec3(0.0, 0.0, 1.0), Vec3(0.1, 0.4, 0.9), Vec3(-0.3, -0.1, 0.9)}) {
        EolCloth cloth = on_nail(top.normalized());
        const int v = cloth.vertex_at(0.2, 0.2);
        const Vec3 before = cloth.state.mesh.world[v];
        const double room = room_at(cloth, v, before);
        Vec3 place = before;
        for (int step = 0; step < 10; ++step) {
            const EolPlacing placing =
                place_eol_vertex(cloth.scene.obstacles[0].shape(), kThickness, cloth.state, 0, cloth.stars(),
                                 cloth.state.mesh.world, {}, kStep);
            ASSERT_TRUE(placing.coordinates);
            const EolCoordinates& at = *placing.coordinates;
            EXPECT_NEAR(at.carried.norm(), kThickness, kRoundOff) << "as far from the tip as it was";
            EXPECT_LT((at.carried - place).norm(), 0.1 * kStep);
            EXPECT_NEAR((at.basis.col(0) - at.carried.normalized()).norm(), 0.0, 1e-9);
            EXPECT_TRUE(at.basis.rightCols<2>().isZero());
            place = at.carried;
            for (Vec3& x : cloth.state.mesh.world)
                x += place - cloth.state.mesh.world[v];  // translated, so that its cone keeps its shape
        }
        EXPECT_GT(room_at(cloth, v, place), 1.05 * room);
        EXPECT_GT((place - before).norm(), 0.1 * kThickness);
    }
}

TEST(EolCoordinates, OnANailTheVertexStaysWhereItsClothHasMostRoomAndInNoTime)
{
    EolCloth cloth(MovingObstacle("nail", make_points({Vec3::Zero()}), {}, {}, 30.0),
                   make_draped({8, 0.0, 180.0}));
    for (Vec3& x : cloth.state.mesh.world)
        x.z() = kThickness - 0.8 * std::max(std::abs(x.x()), std::abs(x.y()));
    const int v = cloth.vertex_at(0.2, 0.2);
    cloth.add_eol(v, true, 0);
    for (const double step : {5e-3, 5e-5}) {
        const EolPlacing placing = place_eol_vertex(cloth.scene.obstacles[0].shape(), kThickness, cloth.state,
                                                    0, cloth.stars(), cloth.state.mesh.world, {}, step);
        ASSERT_TRUE(placing.coordinates);
        EXPECT_LT((placing.coordinates->carried - cloth.state.mesh.world[v]).norm(), kRoundOff);
    }
    EolCloth beside = on_nail(Vec3(0.1, 0.4, 0.9).normalized());
    const EolPlacing placing = beside.place(v);
    ASSERT_TRUE(placing.coordinates);
    EXPECT_LT((placing.coordinates->carried - beside.state.mesh.world[v]).norm(), kRoundOff);
}

TEST(EolCoordinates, OnTheClothsBorderFlowAlongTheBorder)
{
    for (const double turn : {0.0, 30.0, -40.0, 60.0}) {
        EolCloth cloth = on_ridge({8, turn, 180.0});
        const int v = cloth.vertex_at(0.2, 0.0);
        cloth.add_eol(v, false, testing::tip_of(cloth.scene.obstacles[0].shape()));
        const EolPlacing placing = cloth.place(v);
        ASSERT_TRUE(placing.coordinates) << turn;
        EXPECT_EQ(std::abs(placing.coordinates->material_basis(0, 2)), 1.0) << "not off the border";
        EXPECT_EQ(placing.coordinates->material_basis(1, 2), 0.0);
    }
}

TEST(EolCoordinates, TraceIsWhatTheDeformationMapsToTheTangentWhereNoNeighbourTells)
{
    for (const double turn : {10.0, 45.0, -70.0}) {
        const EolPlacing flat = place_middle(on_ridge({8, turn, 180.0}));
        ASSERT_TRUE(flat.coordinates);
        // The material direction (sin, cos) is along the ridge, so material flows over the ridge along (cos,
        // -sin).
        expect_parallel(flat.coordinates->material_basis.col(2),
                        Vec2(std::cos(radians(turn)), -std::sin(radians(turn))));
    }
    // Sheared and stretched: F = [[1, 0.5], [0, 2]] maps (-1, 2) / ... to y.
    EolCloth cloth = on_ridge({8, 0.0, 180.0});
    for (std::size_t v = 0; v < cloth.state.mesh.world.size(); ++v) {
        const Vec2 X = cloth.state.mesh.material[v] - Vec2(0.2, 0.2);
        cloth.state.mesh.world[v] = Vec3(X.x() + 0.5 * X.y(), 2.0 * X.y(), 0.0);
    }
    const EolPlacing sheared = place_middle(cloth);
    ASSERT_TRUE(sheared.coordinates);
    expect_parallel(sheared.coordinates->material_basis.col(2), Vec2(2.0, 1.0).normalized());
}

TEST(EolCoordinates, TraceFollowsTheEdgesToNeighboursOnTheFeature)
{
    // The mesh's edges along the ridge differ by 10 degrees from the direction given by F.
    for (const int neighbours : {1, 2}) {
        EolCloth cloth = on_ridge({8, 10.0, 180.0});
        const int tip = testing::tip_of(cloth.scene.obstacles[0].shape());
        const int v = cloth.vertex_at(0.2, 0.2);
        cloth.add_eol(v, false, tip);
        cloth.add_eol(cloth.vertex_at(0.2, 0.25), false, tip);
        if (neighbours == 2) cloth.add_eol(cloth.vertex_at(0.2, 0.15), false, tip);
        const EolPlacing placing = cloth.place(v);
        ASSERT_TRUE(placing.coordinates);
        expect_parallel(placing.coordinates->material_basis.col(2), Vec2::UnitX());
    }
    // A bent trace: the mean of both directions, each taken in the same sense. One edge goes up, the other
    // down a diagonal.
    EolCloth cloth = on_ridge({8, 20.0, 180.0});
    const int tip = testing::tip_of(cloth.scene.obstacles[0].shape());
    const int v = cloth.vertex_at(0.2, 0.2);
    cloth.add_eol(v, false, tip);
    Vec2 way = Vec2(0.0, 0.05);
    cloth.add_eol(cloth.vertex_at(0.2, 0.25), false, tip);
    const ClothMesh& mesh = cloth.state.mesh;
    const ClothStars stars = cloth.stars();
    for (const int f : stars.faces[v])
        for (const int w : mesh.faces[f]) {
            const Vec2 to = mesh.material[w] - mesh.material[v];
            if (to.norm() < 0.06 || to.y() > 0.0) continue;
            if (cloth.state.eol_entry(cloth.state.ids[w]) < 0) {
                cloth.add_eol(w, false, tip);
                way -= to;
            }
        }
    ASSERT_GT(std::abs(way.x()), 0.04) << "there is a diagonal";
    const EolPlacing placing = cloth.place(v);
    ASSERT_TRUE(placing.coordinates);
    expect_parallel(placing.coordinates->material_basis.col(2), Vec2(way.y(), -way.x()).normalized());
}

TEST(EolCoordinates, NeighboursOnAnotherFeatureTellNothing)
{
    EolCloth cloth = on_ridge({8, 10.0, 180.0});
    const Obstacle& ridge = cloth.scene.obstacles[0].shape();
    const int tip = testing::tip_of(ridge);
    const int v = cloth.vertex_at(0.2, 0.2);
    cloth.add_eol(v, false, tip);
    cloth.add_eol(cloth.vertex_at(0.2, 0.25), false, tip == 0 ? 1 : 0);
    const EolPlacing placing = cloth.place(v);
    ASSERT_TRUE(placing.coordinates);
    expect_parallel(placing.coordinates->material_basis.col(2),
                    Vec2(std::cos(radians(10.0)), -std::sin(radians(10.0))));
}

TEST(EolCoordinates, OpeningHasTheLeastKineticEnergy)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> shift(-0.005, 0.005);
    for (int k = 0; k < 24; ++k) {
        const double fold = k % 3 == 0 ? 180.0 : k % 3 == 1 ? 90.0 : 20.0;
        EolCloth cloth = on_ridge({8, 5.0 * k, fold, 1.0 + 0.03 * k}, 15.0);
        for (Vec3& x : cloth.state.mesh.world) x += Vec3(shift(random), shift(random), shift(random));
        const int v = cloth.vertex_at(0.2, 0.2);
        const Obstacle& ridge = cloth.scene.obstacles[0].shape();
        const bool is_corner = k % 4 == 3;
        cloth.add_eol(v, is_corner, is_corner ? testing::end_of(ridge) : testing::tip_of(ridge));
        const EolPlacing placing = cloth.place(v);
        ASSERT_TRUE(placing.coordinates) << k;
        const EolCoordinates& at = *placing.coordinates;
        EXPECT_EQ(at.opening[0], 1.0);
        const double least = energy_of(cloth, at, at.opening);
        ASSERT_GT(least, 0.0);
        for (const int i : {1, 2})
            for (const double size : {1e-3, 0.1, 10.0}) {
                Vec3 change = Vec3::Zero();
                change[i] = size;
                const double up = energy_of(cloth, at, at.opening + change);
                const double down = energy_of(cloth, at, at.opening - change);
                EXPECT_GT(std::min(up, down), least);
                // The energy is a parabola with its minimum at the opening.
                EXPECT_NEAR(up, down, 1e-9 * (up + down)) << k << " by " << size << " in " << i;
            }
    }
}

TEST(EolCoordinates, AreTurnedToWhereTheObstacleWillBe)
{
    EolCloth cloth = on_ridge({8, 0.0, 60.0});
    const int v = cloth.vertex_at(0.2, 0.2);
    cloth.add_eol(v, false, testing::tip_of(cloth.scene.obstacles[0].shape()));
    const Placement end = {rotation_about(Vec3(1, 2, 3), 40.0), Vec3(5, -6, 7)};
    const EolPlacing here = cloth.place(v), there = cloth.place(v, end);
    ASSERT_TRUE(here.coordinates && there.coordinates);
    EXPECT_LT((there.coordinates->basis - end.rotation * here.coordinates->basis).norm(), kRoundOff);
    EXPECT_EQ(there.coordinates->material_basis, here.coordinates->material_basis);
    EXPECT_LT((there.coordinates->carried - end(cloth.state.mesh.world[v])).norm(), kRoundOff);
    EXPECT_LT((there.coordinates->opening - here.coordinates->opening).norm(), kRoundOff);
    EXPECT_EQ(there.coordinates->frame.outward, here.coordinates->frame.outward) << "in the frame, at begin";
}

TEST(EolPlacing, AtTheClothsOwnCorners)
{
    for (const Vec2& corner : {Vec2(0, 0), Vec2(0.4, 0), Vec2(0, 0.4), Vec2(0.4, 0.4)}) {
        EolCloth cloth = on_ridge({8, 45.0, 180.0});
        const int v = cloth.vertex_at(corner.x(), corner.y());
        cloth.add_eol(v, false, testing::tip_of(cloth.scene.obstacles[0].shape()));
        const EolPlacing placing = cloth.place(v);
        ASSERT_FALSE(placing.coordinates);
        EXPECT_EQ(placing.refusal, ConstraintCause::ClothCorner);
    }
}

TEST(EolPlacing, WhereTheTraceMeetsTheBorderAtLessThan20Degrees)
{
    for (const double turn : {-19.0, 0.0, 19.0, 21.0, -21.0}) {
        EolCloth cloth = on_ridge({8, turn, 180.0});
        const int v = cloth.vertex_at(0.0, 0.2);  // the ridge meets this border at `turn` degrees
        cloth.add_eol(v, false, testing::tip_of(cloth.scene.obstacles[0].shape()));
        const EolPlacing placing = cloth.place(v);
        ASSERT_EQ(placing.coordinates.has_value(), std::abs(turn) > 20.0) << turn;
        if (!placing.coordinates) {
            EXPECT_EQ(placing.refusal, ConstraintCause::AlongBorder);
        }
    }
}

// Cloth has left the ridge and turned. In the material its trace crosses the border, but in the world the
// border is parallel to the ridge. There the vertex could flow along the border at any speed without moving
// cloth.
TEST(EolPlacing, WhereTheBorderHasTurnedAlongTheFeature)
{
    for (const double turned : {0.0, 69.0, 71.0, 90.0, -90.0}) {
        EolCloth cloth = on_ridge({8, 90.0, 180.0});
        const int v = cloth.vertex_at(0.0, 0.2), beside = cloth.vertex_at(0.05, 0.2);
        for (const int on_tip : {v, beside})
            cloth.add_eol(on_tip, false, testing::tip_of(cloth.scene.obstacles[0].shape()));
        const Vec3 about = cloth.state.mesh.world[v];
        const Mat3 rotation = Eigen::AngleAxisd(radians(turned), Vec3::UnitZ()).toRotationMatrix();
        for (Vec3& x : cloth.state.mesh.world) x = about + rotation * (x - about);
        const EolPlacing placing = cloth.place(v);
        ASSERT_EQ(placing.coordinates.has_value(), std::abs(turned) < 70.0) << turned;
        if (!placing.coordinates) {
            EXPECT_EQ(placing.refusal, ConstraintCause::AlongBorder);
        }
    }
}

// On both sides of an almost closed fold the border leads along the wire, up on one side and down on the
// other. The border therefore crosses the wire, although the two directions cancel in the sum.
TEST(EolPlacing, IsNoneWhereTheBorderOfAFoldCrossesAWireObliquely)
{
    for (const double shift : {0.05, 0.1, 0.15})  // position along the border at which the fold crosses it
        for (const double fold : {2.0, 30.0, 90.0}) {
            EolCloth cloth = on_wire({8, std::atan2(shift, 0.2) * 180.0 / std::numbers::pi, fold});
            const int v = cloth.vertex_at(0.2 + shift, 0.4);
            cloth.add_eol(v, false, 0);
            EXPECT_TRUE(cloth.place(v).coordinates) << shift << ", folded by " << fold;
        }
}

TEST(EolPlacing, OfACornerOnTheBorder)
{
    EolCloth cloth = on_ridge({8, 0.0, 60.0});
    const int v = cloth.vertex_at(0.2, 0.4);
    cloth.add_eol(v, true, testing::end_of(cloth.scene.obstacles[0].shape()));
    const EolPlacing placing = cloth.place(v);
    ASSERT_FALSE(placing.coordinates);
    EXPECT_EQ(placing.refusal, ConstraintCause::AlongBorder);
}

TEST(EolPlacing, OfFlatClothThatAllButContainsTheOutwardDirection)
{
    for (const double lean : {0.0, 9.0, 11.0, 45.0}) {  // angle from cloth that stands upright on the ridge
        EolCloth cloth = on_ridge({8, 0.0, 180.0});
        const Mat3 turn = rotation_about(Vec3::UnitY(), 90.0 - lean);
        for (Vec3& x : cloth.state.mesh.world) x = turn * x;
        const EolPlacing placing = place_middle(cloth);
        ASSERT_EQ(placing.coordinates.has_value(), lean > 10.0) << lean;
        if (!placing.coordinates) {
            EXPECT_EQ(placing.refusal, ConstraintCause::EdgeOn);
        }
    }
    // Cloth that is folded at the ridge is never edge-on.
    EXPECT_TRUE(place_middle(on_ridge({8, 0.0, 1.0}, 0.5)).coordinates);
}

TEST(EolPlacing, OfCollapsedClothAndOfAWireWhoseClothTellsNoSide)
{
    EolCloth wire = on_wire({8, 0.0, 180.0});
    for (Vec3& x : wire.state.mesh.world) x = Vec3(0, x.y(), 0);  // all cloth collapsed to the wire's line
    EXPECT_EQ(place_middle(wire, true).refusal, ConstraintCause::NoDirection);
    EXPECT_FALSE(place_middle(wire, true).coordinates);

    EolCloth point = on_ridge({8, 0.0, 180.0});
    for (Vec3& x : point.state.mesh.world) x.setZero();
    EXPECT_FALSE(place_middle(point).coordinates);

    EolCloth broken = on_ridge({8, 0.0, 180.0});
    for (Vec3& x : broken.state.mesh.world) x.setConstant(std::nan(""));
    EXPECT_FALSE(place_middle(broken).coordinates);
}

/// Places the vertex at the corner, or at the middle of the feature's edge.
PlacedEol placed_on(const Obstacle& obstacle, const EolVertex& eol)
{
    const ObstacleFeatures& features = obstacle.features();
    const std::vector<Vec3>& points = obstacle.mesh().points;
    if (eol.on.is_corner()) return {eol, points[features.corners[eol.on.index].point]};
    const auto& ends = obstacle.topology().edges[features.edges[eol.on.index].edge].points;
    return {eol, 0.5 * (points[ends[0]] + points[ends[1]])};
}

bool is_joined(const Obstacle& obstacle, const EolVertex& a, const EolVertex& b)
{
    const bool is_so = is_trace_edge(obstacle, placed_on(obstacle, a), placed_on(obstacle, b));
    EXPECT_EQ(is_trace_edge(obstacle, placed_on(obstacle, b), placed_on(obstacle, a)), is_so);
    return is_so;
}

TEST(TraceEdge, JoinsVerticesOfOneStretchAndItsEnds)
{
    const MovingObstacle whole = make_ridge(60.0);
    const Obstacle& ridge = whole.shape();
    const int tip = testing::tip_of(ridge), end = testing::end_of(ridge);
    const EolVertex on_tip{0, FeatureId::edge(0, tip), Vec3::UnitZ(), 0},
        at_end{1, FeatureId::corner(0, end), Vec3::UnitZ(), 0};
    EXPECT_TRUE(is_joined(ridge, on_tip, on_tip));
    EXPECT_TRUE(is_joined(ridge, on_tip, at_end));
    EXPECT_TRUE(is_joined(ridge, at_end, on_tip));
    EolVertex elsewhere = on_tip;
    elsewhere.on.obstacle = 1;
    EXPECT_FALSE(is_trace_edge(ridge, placed_on(ridge, on_tip), {elsewhere, Vec3::Zero()}));
    const auto& features = ridge.features();
    for (int f = 0; f < static_cast<int>(features.edges.size()); ++f) {
        const EolVertex other{2, FeatureId::edge(0, f), Vec3::UnitZ(), 0};
        EXPECT_EQ(is_joined(ridge, on_tip, other), f == tip);
        const auto& ends = ridge.topology().edges[features.edges[f].edge].points;
        const int point = features.corners[end].point;
        EXPECT_EQ(is_joined(ridge, at_end, other), ends[0] == point || ends[1] == point);
        // If both ends of the edge are corners, they are joined too.
        for (int c = 0; c < static_cast<int>(features.corners.size()); ++c) {
            const int at = features.corners[c].point;
            if (at == point) continue;
            if ((ends[0] == at && ends[1] == point) || (ends[1] == at && ends[0] == point)) {
                EXPECT_TRUE(is_joined(ridge, at_end, {3, FeatureId::corner(0, c), Vec3::UnitZ(), 0}));
            }
        }
    }
}

/// A closed loop around the origin in z = 0, of radius 1.
MovingObstacle make_loop(int count)
{
    std::vector<Vec3> points;
    for (int k = 0; k < count; ++k)
        points.emplace_back(std::cos(2.0 * M_PI * k / count), std::sin(2.0 * M_PI * k / count), 0.0);
    return MovingObstacle("loop", make_wire(points, true), {}, {}, 30.0);
}

/// A vertex on the loop's wire at this angle.
PlacedEol on_loop(const EolVertex& eol, double degrees)
{
    const Vec3 at(std::cos(radians(degrees)), std::sin(radians(degrees)), 0.0);
    return {eol, at};
}

int edge_at(const Obstacle& loop, double degrees)
{
    const PlacedEol at = on_loop({0, FeatureId::edge(0, 0), Vec3::UnitZ(), 0}, degrees);
    int nearest = 0;
    for (int f = 0; f < static_cast<int>(loop.features().edges.size()); ++f) {
        const auto distance = [&](int g) {
            return (place_on_feature(loop, g, at.place).point - at.place).norm();
        };
        if (distance(f) < distance(nearest)) nearest = f;
    }
    return nearest;
}

TEST(TraceEdge, FollowsAPolylineOfManySegmentsButNotAcrossIt)
{
    const MovingObstacle whole = make_loop(40);
    const Obstacle& loop = whole.shape();
    for (const auto& [from, to, is_along] : {std::tuple(5.0, 50.0, true),
                                             {350.0, 20.0, true},
                                             {20.0, 350.0, true},
                                             {3.0, 100.0, true},
                                             {0.0, 180.0, false},
                                             {10.0, 170.0, false},
                                             {100.0, 240.0, false}}) {
        const EolVertex a{0, FeatureId::edge(0, edge_at(loop, from)), Vec3::UnitZ(), 0};
        const EolVertex b{1, FeatureId::edge(0, edge_at(loop, to)), Vec3::UnitZ(), 0};
        EXPECT_EQ(is_trace_edge(loop, on_loop(a, from), on_loop(b, to)), is_along) << from << " to " << to;
    }
}

TEST(FollowFeatures, VerticesPassOnFromSegmentToSegment)
{
    EolCloth cloth(make_loop(40), make_draped({8, 0.0, 180.0}));
    const Obstacle& loop = cloth.scene.obstacles[0].shape();
    const int v = cloth.vertex_at(0.2, 0.2);
    cloth.add_eol(v, false, edge_at(loop, 4.5));
    for (double degrees = 5.3; degrees < 400.0; degrees += 7.0) {
        cloth.state.mesh.world[v] = on_loop(cloth.state.eol[0], degrees).place * 1.001;
        follow_features(cloth.scene.obstacles, cloth.state);
        EXPECT_EQ(cloth.state.eol[0].on.index, edge_at(loop, degrees)) << degrees;
    }
    // At the wire's end the vertex stays on the last segment.
    EolCloth open(MovingObstacle("wire", make_wire({{0, 0, 0}, {1, 0, 0}, {2, 0.1, 0}}, false), {}, {}, 30.0),
                  make_draped({8, 0.0, 180.0}));
    open.add_eol(v, false, 0);
    for (const auto& [x, feature] : {std::pair(-0.5, 0), {0.5, 0}, {1.5, 1}, {3.0, 1}, {0.9, 0}}) {
        open.state.mesh.world[v] = Vec3(x, 0.0, 0.001);
        follow_features(open.scene.obstacles, open.state);
        EXPECT_EQ(open.state.eol[0].on.index, feature) << x;
    }
}

}  // namespace
}  // namespace arris
