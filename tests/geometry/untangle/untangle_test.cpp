// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/untangle/untangle.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/check/penetration.h"
#include "geometry/self_contact/self_intersection.h"
#include "geometry/untangle/sheet_place.h"
#include "tests/geometry/sample_obstacles.h"
#include "tests/geometry/untangle/tangled_cloth.h"

namespace arris {
namespace {

using samples::TangledCloth;

constexpr double kThickness = samples::kTangleThickness;
constexpr double kGap = 0.95 * kThickness;  // of the thickness, which the last move reaches to some per cent

/// Untangles the cloth with itself, and expects that its pieces 0 and 1 come apart: within a displacement (m)
/// and a strain.
UntangleReport expect_apart(TangledCloth& cloth, double displacement, double strain)
{
    const UntangleReport report = untangle(samples::self_request(), cloth.mesh);
    EXPECT_GT(report.crossings_before, 0);
    EXPECT_TRUE(report.left.empty());
    EXPECT_TRUE(find_self_intersections(cloth.mesh.world, cloth.mesh.faces).empty());
    EXPECT_GE(samples::least_gap(cloth.mesh.world, cloth.piece(0), cloth.piece(1)), kGap);
    EXPECT_LE(report.greatest_displacement, displacement);
    EXPECT_LE(report.greatest_strain, strain);
    return report;
}

TEST(Untangle, ACornerGoesBackThroughTheSheet)
{
    TangledCloth cloth = samples::corner_through_sheet();
    expect_apart(cloth, 0.01, 0.08);  // the corner is 9.5 mm above the sheet
}

TEST(Untangle, TheCrestOfAFoldGoesBackThroughTheSheet)
{
    TangledCloth cloth = samples::fold_through_sheet();
    expect_apart(cloth, 0.011, 0.08);  // 10.3 mm
}

TEST(Untangle, ATubeWhoseRimDipsIntoAnotherComesOut)
{
    TangledCloth cloth = samples::tube_into_tube();
    expect_apart(cloth, 0.012, 0.15);
    // Not further in: the thin tube's rim was at x = -0.09, inside the wide one of radius 0.1.
    for (const Face& f : cloth.piece(1))
        for (const int v : f) EXPECT_LT(cloth.mesh.world[v].x(), -0.08);
}

TEST(Untangle, BordersThatOverlapSlideOutAlongTheContour)
{
    TangledCloth cloth = samples::crossed_borders();
    // The contour is 5.8 cm long; along the normals it were more than 8 cm.
    expect_apart(cloth, 0.035, 0.05);
}

TEST(Untangle, AStripGoesBackAlthoughItsContourKeepsItsLength)
{
    TangledCloth cloth = samples::strip_through_sheet();
    expect_apart(cloth, 0.035, 0.08);  // 3 cm beyond the sheet
}

TEST(Untangle, CoplanarPanelsPartAlongTheNormal)
{
    TangledCloth cloth = samples::coplanar_sliver();
    const UntangleReport report = expect_apart(cloth, kThickness, 0.001);
    EXPECT_LT(report.moves, 5);
    for (const Vec3& x : cloth.mesh.world) EXPECT_LE(std::abs(x.z()), kThickness);
}

TEST(Untangle, ClothThatDipsIntoASolidComesOut)
{
    for (const double depth : {0.001, 0.01, 0.03})
        for (const StartObstacle& obstacle : {samples::ball_of_15_cm(), samples::cube_of_20_cm()}) {
            const double top = obstacle.pose->bounds().max().z();
            TangledCloth cloth = samples::dipped_sheet(top, depth);
            const UntangleRequest request{StartRule::KeepApart, {obstacle}, {}, kThickness};
            const UntangleReport report = untangle(request, cloth.mesh);
            EXPECT_GT(report.crossings_before, 0);
            EXPECT_TRUE(report.left.empty());
            EXPECT_TRUE(report.still_inside.empty());
            EXPECT_FALSE(find_penetration(obstacle.pose, cloth.mesh.world, cloth.mesh.faces).is_any());
            EXPECT_LE(report.greatest_displacement, depth + 5.0 * kThickness);
            EXPECT_LE(report.greatest_strain, 0.1);
        }
}

TEST(Untangle, AClearStartIsLeftAsItIs)
{
    ClothMesh none;
    EXPECT_EQ(untangle(samples::self_request(), none).crossings_before, 0);

    TangledCloth cloth;
    for (const double z : {0.0, 1e-9})  // nearer than the thickness, but apart
        cloth.add({0.2, 0.2}, [&](const Vec2& X) { return Vec3(X.x(), X.y(), z); });
    const std::vector<Vec3> placed = cloth.mesh.world;
    UntangleRequest request = samples::self_request();
    request.obstacles = {samples::cube_of_20_cm()};
    request.obstacles.front().pose.placement.translation = {0.0, 0.0, 0.2};
    const UntangleReport report = untangle(request, cloth.mesh);
    EXPECT_EQ(report.crossings_before, 0);
    EXPECT_EQ(report.moves, 0);
    EXPECT_EQ(cloth.mesh.world, placed);
}

TEST(Untangle, OnlyCrossingsToUntangleComeApart)
{
    TangledCloth cloth = samples::dipped_sheet(0.1, 0.01);
    const std::vector<Vec3> placed = cloth.mesh.world;
    for (const StartRule rule : {StartRule::KeepApart, StartRule::Ignore}) {
        StartObstacle cube = samples::cube_of_20_cm();
        cube.rule = rule;
        EXPECT_EQ(untangle({StartRule::Untangle, {cube}, {}, kThickness}, cloth.mesh).crossings_before, 0);
        EXPECT_EQ(cloth.mesh.world, placed);
    }
}

TEST(Untangle, ALayerBehindIsPushedAlongAndNotPassed)
{
    // The corner goes down by 8 mm. A patch lies 2 mm below: a move that passed it would end clear of it.
    TangledCloth cloth = samples::corner_through_sheet();
    cloth.add({0.04, 0.04}, [](const Vec2& X) {
        return Vec3(X.x() + 0.251, X.y() + 0.253, 0.4 * std::max(0.0, X.x() + X.y() + 0.004) - 0.002);
    });
    const UntangleReport report = untangle(samples::self_request(), cloth.mesh);
    EXPECT_GT(report.crossings_before, 0);
    EXPECT_TRUE(report.left.empty());
    const CollisionMesh mesh(cloth.mesh, samples::self_request());
    for (const Face& f : cloth.piece(2))
        for (const int v : f) {
            const Vec3& x = mesh.positions[v];
            const SheetPlace above = walk_to_nearest(mesh, x, cloth.first_face[1] - 1);
            EXPECT_GT(above.normal.dot(above.point - x), 0.0);
        }
}

TEST(Untangle, NoMovePassesAnObstacleToKeepApart)
{
    // Between the sheet that dips into the cube and a free place above it: a plate, or a wire.
    const ObstacleMesh plate =
        samples::moved(samples::sheet(2, 2, [](int, int) { return 0.0; }),
                       [](const Vec3& p) { return Vec3(0.01 * (p.x() - 1.0), 0.01 * (p.y() - 1.0), 0.092); });
    const ObstacleMesh wire = samples::wire({{-0.3, 0.001, 0.0921}, {0.3, 0.002, 0.0922}}, false);
    for (const ObstacleMesh& mesh : {plate, wire}) {
        TangledCloth cloth = samples::dipped_sheet(0.1, 0.01);
        const StartObstacle cube = samples::cube_of_20_cm();
        const StartObstacle kept{{std::make_shared<Obstacle>(mesh, 30.0), Placement{}}};
        untangle({StartRule::KeepApart, {cube, kept}, {}, kThickness}, cloth.mesh);
        EXPECT_FALSE(find_penetration(kept.pose, cloth.mesh.world, cloth.mesh.faces).is_any());
        double highest_over = -1.0;  // of the cloth over the middle of the plate or wire
        for (const Vec3& x : cloth.mesh.world)
            if (x.head<2>().norm() < 0.009) highest_over = std::max(highest_over, x.z());
        EXPECT_LT(highest_over, 0.0922);
    }
}

TEST(Untangle, HeldVerticesStayAndWhatIsLeftIsNamed)
{
    TangledCloth cloth = samples::corner_through_sheet();
    const std::vector<Vec3> placed = cloth.mesh.world;
    const auto crossing = find_self_intersections(placed, cloth.mesh.faces);
    std::vector<int> held(placed.size());
    for (std::size_t v = 0; v < held.size(); ++v) held[v] = static_cast<int>(v);
    const UntangleReport all = untangle(samples::self_request(held), cloth.mesh);
    EXPECT_EQ(cloth.mesh.world, placed);
    ASSERT_EQ(all.left.size(), crossing.size());
    for (std::size_t i = 0; i < crossing.size(); ++i)
        EXPECT_EQ(all.left[i], (CrossingPair{crossing[i][0], -1, crossing[i][1]}));

    // The corner that pokes and the sheet around it are held, the rest may move.
    held.clear();
    for (std::size_t v = 0; v < placed.size(); ++v)
        if (placed[v].z() > 0.025 && (placed[v] - Vec3(0.3, 0.3, 0.03)).norm() < 0.09)
            held.push_back(static_cast<int>(v));
    const UntangleReport some = untangle(samples::self_request(held), cloth.mesh);
    EXPECT_FALSE(some.left.empty());
    EXPECT_LE(some.left.size(), crossing.size());
    EXPECT_LE(some.moves, 200);
    EXPECT_EQ(cloth.mesh.world, placed);  // no state on the way is better
}

TEST(Untangle, WhatCanComeApartDoesBesideWhatCannot)
{
    // Two corners. One is held; or the sheet above it is held, and a held patch or a wire blocks its way
    // down.
    enum class Obstruction { Held, Patch, Wire };
    for (const Obstruction by : {Obstruction::Held, Obstruction::Patch, Obstruction::Wire}) {
        TangledCloth cloth = samples::corner_through_sheet();
        int sheet = cloth.mesh.vertex_count();  // its first vertex
        for (const Face& f : cloth.piece(1)) sheet = std::min({sheet, f[0], f[1], f[2]});
        if (by == Obstruction::Patch)
            cloth.add({0.04, 0.04}, [](const Vec2& X) {
                return Vec3(X.x() + 0.251, X.y() + 0.253, 0.4 * std::max(0.0, X.x() + X.y() + 0.004) - 0.002);
            });
        const int first = cloth.mesh.vertex_count(), first_face = cloth.mesh.face_count();
        std::vector<int> held;
        for (int v = by == Obstruction::Held ? 0 : sheet; v < first; ++v) held.push_back(v);
        const TangledCloth second = samples::corner_through_sheet();
        for (const auto& [a, b, c] : second.mesh.faces)
            cloth.mesh.faces.push_back({a + first, b + first, c + first});
        for (const Vec2& X : second.mesh.material) cloth.mesh.material.push_back(X + Vec2(10.0, 0.0));
        for (const Vec3& x : second.mesh.world) cloth.mesh.world.push_back(x + Vec3(1.0, 0.0, 0.0));

        const std::vector<Vec3> placed = cloth.mesh.world;
        UntangleRequest request = samples::self_request(held);
        if (by == Obstruction::Wire) {
            const ObstacleMesh wire = samples::wire({{0.19, 0.4, 0.033}, {0.4, 0.19, 0.033}}, false);
            request.obstacles = {{{std::make_shared<Obstacle>(wire, 30.0), Placement{}}}};
        }
        const UntangleReport report = untangle(request, cloth.mesh);
        EXPECT_FALSE(report.left.empty());
        EXPECT_LE(2 * static_cast<int>(report.left.size()), report.crossings_before);
        for (const CrossingPair& pair : report.left) EXPECT_LT(pair.face, first_face);
        for (const Vec3& x : cloth.mesh.world) EXPECT_TRUE(x.allFinite());
        for (const int v : held) EXPECT_EQ(cloth.mesh.world[v], placed[v]);
    }
}

TEST(Untangle, ResultsDoNotDependOnTheNumberOfThreads)
{
    std::vector<std::vector<Vec3>> results;
    for (const int threads : {1, 8}) {
        const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism,
                                                static_cast<std::size_t>(threads));
        TangledCloth tubes = samples::tube_into_tube(), sheet = samples::dipped_sheet(0.15, 0.02);
        untangle(samples::self_request(), tubes.mesh);
        untangle({StartRule::KeepApart, {samples::ball_of_15_cm()}, {}, kThickness}, sheet.mesh);
        results.push_back(tubes.mesh.world);
        results.push_back(sheet.mesh.world);
    }
    EXPECT_EQ(results[0], results[2]);
    EXPECT_EQ(results[1], results[3]);
}

TEST(Untangle, TheResultScalesWithTheCloth)
{
    // Powers of two scale without rounding: a cell is 20 um, 2 cm or 10 m.
    for (const auto& make :
         {samples::corner_through_sheet, samples::crossed_borders, samples::coplanar_sliver}) {
        TangledCloth plain = make();
        const UntangleReport expected = untangle(samples::self_request(), plain.mesh);
        for (const double scale : {std::ldexp(1.0, -10), std::ldexp(1.0, 9)}) {
            TangledCloth scaled = make();
            for (Vec3& x : scaled.mesh.world) x *= scale;
            UntangleRequest request = samples::self_request();
            request.thickness *= scale;
            const UntangleReport report = untangle(request, scaled.mesh);
            EXPECT_EQ(report.moves, expected.moves);
            for (std::size_t v = 0; v < scaled.mesh.world.size(); ++v)
                EXPECT_EQ(scaled.mesh.world[v], scale * plain.mesh.world[v]);
        }
    }
}

}  // namespace
}  // namespace arris
