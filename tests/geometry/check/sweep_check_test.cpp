// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/check/sweep_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <random>
#include <set>

#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/contact/continuous_collision.h"
#include "geometry/obstacle/obstacle_touch.h"
#include "tests/geometry/sample_obstacles.h"

namespace arris {
namespace {

using ::testing::IsEmpty;
using ::testing::Not;

constexpr double kThickness = 1e-3;
using Map = std::function<Vec3(const Vec3&)>;

Obstacle make_obstacle(const ObstacleMesh& mesh)
{
    return Obstacle(mesh, 30.0);
}

/// A cloth mesh and its motion.
struct Cloth {
    std::vector<Face> faces;
    MeshTopology topology;
    ClothMotion motion;

    Cloth(std::vector<Vec3> begin, std::vector<Vec3> end, std::vector<Face> mesh_faces)
        : faces(std::move(mesh_faces)), topology(make_topology(static_cast<int>(begin.size()), faces))
    {
        motion = {&faces, &topology.edges, std::move(begin), std::move(end)};
    }
    Cloth(const Cloth&) = delete;

    SweepReport check(const Obstacle& obstacle) const { return check_sweep(obstacle, motion, kThickness); }
};

/// The square [0, 1]^2 in z = 0 with `cells` along each side.
ClothMesh square(int cells, GridPattern pattern = GridPattern::Alternating)
{
    ClothGrid grid;
    grid.resolution = {cells, cells};
    grid.pattern = pattern;
    return make_cloth_grid(grid);
}

std::vector<Vec3> mapped(std::vector<Vec3> points, const Map& map)
{
    for (Vec3& p : points) p = map(p);
    return points;
}

Cloth moving(const ClothMesh& mesh, const Map& begin, const Map& end)
{
    return Cloth(mapped(mesh.world, begin), mapped(mesh.world, end), mesh.faces);
}

Map at_height(double z)
{
    return [z](const Vec3& p) { return Vec3(p + z * Vec3::UnitZ()); };
}

Cloth falling(int cells, double from, double to)
{
    return moving(square(cells), at_height(from), at_height(to));
}

Vec3 cloth_point(const ObstacleContact& contact, const std::vector<Vec3>& positions)
{
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < 3; ++i)
        if (contact.vertices[i] >= 0) sum += contact.weights[i] * positions[contact.vertices[i]];
    return sum;
}

/// Checks that a contact excludes the step's end, allows its begin, and requires no larger gap than at the
/// begin.
void expect_mends(const ObstacleContact& c, const ClothMotion& motion)
{
    const double scale = (cloth_point(c, motion.begin) - c.point).norm() + 1e-12;
    const double before = c.normal.dot(cloth_point(c, motion.begin) - c.point);
    const double after = c.normal.dot(cloth_point(c, motion.end) - c.point);
    EXPECT_NEAR(c.normal.norm(), 1.0, 1e-12);
    EXPECT_GT(c.least_gap, 0.0);
    EXPECT_LE(c.least_gap, kThickness);
    EXPECT_LT(after, c.least_gap);
    EXPECT_GE(before, c.least_gap - 1e-9 * scale);  // rounding of the touching point
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) {
        EXPECT_GE(c.weights[i], 0.0);
        EXPECT_EQ(c.vertices[i] < 0 ? c.weights[i] : 0.0, 0.0);
        EXPECT_TRUE(i == 0 || c.vertices[i] < 0 || c.vertices[i - 1] < c.vertices[i]);
        sum += c.weights[i];
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
}

void expect_mended(const SweepReport& report, const Cloth& cloth)
{
    std::set<std::tuple<ContactKind, std::array<int, 3>, int>> keys;
    for (const ObstacleContact& contact : report.violations) {
        expect_mends(contact, cloth.motion);
        EXPECT_TRUE(keys.emplace(contact.kind, contact.vertices, contact.element).second);
    }
}

void expect_clean(const SweepReport& report)
{
    EXPECT_TRUE(report.is_clean());
    EXPECT_THAT(report.violations, IsEmpty());
    EXPECT_THAT(report.faces, IsEmpty());
    EXPECT_EQ(report.crossings, 0);
    EXPECT_EQ(report.intersections, 0);
}

// ---- Motions that must be reported

/// The cloth passes completely through the obstacle. At the end nothing intersects, but the motion must be
/// reported.
void expect_tunnel_is_seen(const ObstacleMesh& mesh)
{
    const Obstacle obstacle = make_obstacle(mesh);
    for (const int cells : {1, 3, 8}) {
        const Cloth cloth = falling(cells, 2.0, -2.0);
        const SweepReport report = cloth.check(obstacle);
        EXPECT_FALSE(report.is_clean());
        EXPECT_GE(report.crossings, 1);
        EXPECT_EQ(report.intersections, 0);
        EXPECT_THAT(report.violations, Not(IsEmpty()));
        expect_mended(report, cloth);
    }
}

/// Tilts the mesh so that it is not aligned with the cloth's mesh.
ObstacleMesh tilted(const ObstacleMesh& mesh)
{
    const Mat3 turn = Eigen::AngleAxisd(0.2, Vec3(1.0, 0.7, 0.3).normalized()).toRotationMatrix();
    return samples::moved(mesh, [turn](const Vec3& p) { return Vec3(turn * p + Vec3(0.01, 0.02, 0.0)); });
}

void expect_tunnels_are_seen(const ObstacleMesh& mesh)
{
    expect_tunnel_is_seen(mesh);
    expect_tunnel_is_seen(tilted(mesh));
}

TEST(SweepCheck, SeesATunnelThroughABox)
{
    expect_tunnels_are_seen(samples::box(Vec3(0.3, 0.3, -0.2), Vec3(0.6, 0.7, 0.2)));
}

TEST(SweepCheck, SeesATunnelThroughAPlateLargerThanTheCloth)
{
    expect_tunnels_are_seen(samples::box(Vec3(-1, -1, -1e-4), Vec3(2, 2, 1e-4)));
}

TEST(SweepCheck, SeesATunnelThroughAnOpenSheet)
{
    const ObstacleMesh sheet = samples::sheet(3, 3, [](int i, int j) { return 0.05 * ((i + j) % 2); });
    expect_tunnels_are_seen(
        samples::moved(sheet, [](const Vec3& p) { return Vec3(0.2 * p + Vec3(0.1, 0.2, 0)); }));
}

TEST(SweepCheck, OfAPlateAVertexIsHeldByTheSideItMetFirst)
{
    const Obstacle obstacle = make_obstacle(samples::box(Vec3(-1, -1, -1e-2), Vec3(2, 2, 1e-2)));
    const SweepReport report = falling(3, 2.0, -2.0).check(obstacle);
    ASSERT_THAT(report.violations, Not(IsEmpty()));
    for (const ObstacleContact& c : report.violations) {
        if (c.kind != ContactKind::Vertex) continue;
        EXPECT_NEAR(c.point.z(), 1e-2, 1e-9);
        EXPECT_LT((c.normal - Vec3::UnitZ()).norm(), 1e-12);
    }
}

TEST(SweepCheck, SeesATunnelThroughAWire)
{
    // The wire's ends are beside the cloth: only edges meet.
    expect_tunnels_are_seen(samples::wire({Vec3(-1, 0.4, 0), Vec3(2, 0.43, 0.1)}, false));
    expect_tunnels_are_seen(samples::wire({Vec3(-1, 0.4, 0), Vec3(0.5, 0.43, 0), Vec3(2, 0.4, 0.1)}, false));
    // A small ring inside one face: its edges meet no cloth edge, and its points meet the face.
    std::vector<Vec3> ring;
    for (int i = 0; i < 7; ++i)
        ring.push_back(Vec3(0.56 + 0.01 * std::cos(0.9 * i), 0.53 + 0.01 * std::sin(0.9 * i), 0.0));
    expect_tunnels_are_seen(samples::wire(ring, true));
}

TEST(SweepCheck, SeesATunnelThroughANail)
{
    expect_tunnels_are_seen(samples::nails({Vec3(0.41, 0.37, 0.0)}));
    // The nail is exactly at a vertex, on an edge, or on the cloth's border.
    expect_tunnel_is_seen(samples::nails({Vec3(1.0, 0.0, 0.0)}));
    expect_tunnel_is_seen(samples::nails({Vec3(0.5, 0.5, 0.0)}));
    expect_tunnel_is_seen(samples::nails({Vec3(0.75, 0.0, 0.0)}));
}

TEST(SweepCheck, SeesAFastNailInAThinStrip)
{
    // The cloth crosses a 1 cm wide strip edge-on at 20 m/s in 5 ms.
    const Obstacle obstacle = make_obstacle(samples::nails({Vec3(0.05, 0.5, 0.0)}));
    const Cloth flat = moving(
        square(4), [](const Vec3& p) { return Vec3(0.01 * p.x(), p.y(), 0.0); },
        [](const Vec3& p) { return Vec3(0.01 * p.x() + 0.1, p.y(), 0.0); });
    EXPECT_GE(flat.check(obstacle).crossings, 1);
}

TEST(SweepCheck, SeesWhereItEndsInside)
{
    const Obstacle obstacle = make_obstacle(samples::box(Vec3(-1, -1, -1), Vec3(2, 2, 0)));
    const Cloth cloth = falling(4, 0.1, -0.1);
    const SweepReport report = cloth.check(obstacle);
    EXPECT_EQ(report.intersections, 0);  // the cloth is completely inside
    EXPECT_EQ(report.faces.size(), cloth.faces.size());
    expect_mended(report, cloth);
    for (const ObstacleContact& c : report.violations) {
        if (c.kind != ContactKind::Vertex) continue;
        EXPECT_LT((c.normal - Vec3::UnitZ()).norm(), 1e-12);
        EXPECT_NEAR(c.point.z(), 0.0, 1e-12);
        EXPECT_EQ(c.least_gap, kThickness);
    }
    EXPECT_GE(std::count_if(report.violations.begin(), report.violations.end(),
                            [](const ObstacleContact& c) { return c.kind == ContactKind::Vertex; }),
              25);
}

TEST(SweepCheck, SeesATouchAtTheEnd)
{
    const Obstacle obstacle = make_obstacle(samples::box(Vec3(-1, -1, -1), Vec3(2, 2, 0)));
    const Cloth cloth = falling(4, 0.1, 0.0);
    const SweepReport report = cloth.check(obstacle);
    EXPECT_EQ(report.intersections, static_cast<int>(cloth.faces.size()));
    EXPECT_EQ(report.faces.size(), cloth.faces.size());
    EXPECT_GE(report.crossings, 25);
    expect_mended(report, cloth);
}

TEST(SweepCheck, SeesWhatStandsInTheWayAtRest)
{
    // Nothing moves, but the box, a wire or a nail cuts the cloth already at the begin.
    const ObstacleMesh box = samples::box(Vec3(0.2, 0.2, -0.1), Vec3(0.4, 0.4, 0.1));
    const ObstacleMesh wire = samples::wire({Vec3(0.7, 0.7, -1), Vec3(0.71, 0.72, 1)}, false);
    const ObstacleMesh nail = samples::nails({Vec3(0.9, 0.3, 0)});
    const Cloth cloth = falling(5, 0.0, 0.0);
    for (const ObstacleMesh& mesh : {box, wire, nail}) {
        const SweepReport report = cloth.check(make_obstacle(mesh));
        EXPECT_GE(report.intersections, 1);
        EXPECT_EQ(report.faces.size(), static_cast<std::size_t>(report.intersections));
        EXPECT_EQ(report.crossings, 0);
    }
}

TEST(SweepCheck, AContactAsksForNoMoreThanTheGapThereWas)
{
    const Obstacle obstacle = make_obstacle(samples::box(Vec3(-1, -1, -1), Vec3(2, 2, 0)));
    const Cloth cloth = falling(3, 1e-5, -0.1);
    const SweepReport report = cloth.check(obstacle);
    ASSERT_THAT(report.violations, Not(IsEmpty()));
    for (const ObstacleContact& c : report.violations) EXPECT_NEAR(c.least_gap, 1e-5, 1e-12);
}

TEST(SweepCheck, SheetsHaveTwoSides)
{
    const ObstacleMesh sheet = samples::sheet(1, 1, [](int, int) { return 0.0; });
    const Obstacle obstacle =
        make_obstacle(samples::moved(sheet, [](const Vec3& p) { return Vec3(3.0 * p - Vec3(1, 1, 0)); }));
    for (const double side : {1.0, -1.0}) {
        const Cloth cloth = falling(2, 0.1 * side, -0.1 * side);
        const SweepReport report = cloth.check(obstacle);
        ASSERT_THAT(report.violations, Not(IsEmpty()));
        for (const ObstacleContact& c : report.violations)
            EXPECT_TRUE(c.kind != ContactKind::Vertex || (c.normal - side * Vec3::UnitZ()).norm() < 1e-12);
    }
}

TEST(SweepCheck, OnAFineObstacleACoarseFaceKeepsItsDeepest)
{
    const ObstacleMesh ball = samples::sphere(40, 60);
    const Obstacle obstacle =
        make_obstacle(samples::moved(ball, [](const Vec3& p) { return Vec3(0.2 * p + Vec3(0.4, 0.3, 0)); }));
    const Cloth cloth = falling(1, 0.3, 0.15);
    const SweepReport report = cloth.check(obstacle);
    EXPECT_GE(report.violations.size(), 9U);
    EXPECT_LE(report.violations.size(), 18U);
    expect_mended(report, cloth);
    double deepest = 0.0;
    for (const ObstacleContact& c : report.violations)
        deepest = std::max(deepest, c.normal.dot(c.point - cloth_point(c, cloth.motion.end)));
    EXPECT_NEAR(deepest, 0.05, 1e-9);  // the ball's top, a mesh point
}

// ---- Motions that must not be reported

TEST(SweepCheck, PassingBesideIsClean)
{
    const ObstacleMesh box = samples::box(Vec3(1.0 + 1e-6, -1, -1), Vec3(2, 2, 1));
    const ObstacleMesh nail = samples::nails({Vec3(-1e-6, 0.3, 0), Vec3(0.5, 1.0 + 1e-6, 0)});
    const ObstacleMesh wire = samples::wire({Vec3(-1, -1e-6, 0), Vec3(3, -1e-6, 0)}, false);
    const Obstacle obstacle = make_obstacle(samples::together(samples::together(box, nail), wire));
    for (const int cells : {1, 7}) expect_clean(falling(cells, 2.0, -2.0).check(obstacle));
}

TEST(SweepCheck, RestingAndSlidingAtAnyGapIsClean)
{
    const Obstacle obstacle = make_obstacle(samples::together(samples::box(Vec3(-1, -1, -1), Vec3(2, 2, 0)),
                                                              samples::box(Vec3(5, 5, -1), Vec3(6, 6, 1))));
    for (const double gap : {1e-3, 1e-6, 1e-10, 1e-13}) {
        const auto slide = [](const Vec3& way) { return [way](const Vec3& p) { return Vec3(p + way); }; };
        const auto mesh = square(6);
        expect_clean(moving(mesh, at_height(gap), at_height(gap)).check(obstacle));
        expect_clean(moving(mesh, at_height(gap), slide(Vec3(0.3, -0.2, gap))).check(obstacle));
        expect_clean(moving(mesh, at_height(gap), slide(Vec3(0.3, -0.2, 0.5 * gap))).check(obstacle));
        expect_clean(moving(mesh, at_height(gap), slide(Vec3(0.0, 0.0, 10.0))).check(obstacle));
    }
}

TEST(SweepCheck, SlidingOverARimIsClean)
{
    // A strip bent over a box's edge, 0.1 mm off, slides around the edge: vertices pass from the top to the
    // side.
    const Obstacle obstacle = make_obstacle(samples::box(Vec3(-2, -1, -2), Vec3(0, 2, 0)));
    const auto bent = [](double slid) -> Map {
        return [slid](const Vec3& p) {
            constexpr double kGap = 1e-4;
            const double s = p.x() - 0.5 + slid;  // distance past the edge
            return s < 0.0 ? Vec3(s + kGap, p.y(), kGap) : Vec3(kGap, p.y(), kGap - s);
        };
    };
    // The mesh has lines at the edge at begin and at end, as EOL vertices on the edge would give.
    expect_clean(moving(square(10), bent(0.0), bent(0.0)).check(obstacle));
    const ClothMesh mesh = square(10);
    std::vector<Vec3> end = mapped(mesh.world, bent(0.05));
    for (int v = 0; v < mesh.vertex_count(); ++v)
        if (std::abs(mesh.world[v].x() - 0.5) < 1e-9) end[v] = bent(0.0)(mesh.world[v]);
    expect_clean(Cloth(mapped(mesh.world, bent(0.0)), end, mesh.faces).check(obstacle));
}

TEST(SweepCheck, EmptyClothIsClean)
{
    const Obstacle obstacle = make_obstacle(samples::box(Vec3(-1, -1, -1), Vec3(2, 2, 0)));
    expect_clean(Cloth({}, {}, {}).check(obstacle));
}

// ---- Comparison with all pairs

struct Pairs {
    std::set<int> vertices, edges, faces;  ///< cloth elements that met the obstacle
    int count() const { return static_cast<int>(vertices.size() + edges.size() + faces.size()); }
};

Pairs sweep_all_pairs(const Obstacle& obstacle, const ClothMotion& motion)
{
    constexpr double kDistance = 1e-11;
    const ObstacleMesh& mesh = obstacle.mesh();
    Pairs met;
    for (const Face& face : mesh.faces)
        for (std::size_t v = 0; v < motion.begin.size(); ++v)
            if (sweep_vertex_face(motion.begin[v], motion.end[v],
                                  {mesh.points[face[0]], mesh.points[face[1]], mesh.points[face[2]]},
                                  kDistance))
                met.vertices.insert(static_cast<int>(v));
    for (const ObstacleEdge& edge : obstacle.topology().edges)
        for (std::size_t e = 0; e < motion.edges->size(); ++e) {
            const auto [a, b, left, right] = (*motion.edges)[e];
            if (sweep_edge_edge({motion.begin[a], motion.begin[b]}, {motion.end[a], motion.end[b]},
                                {mesh.points[edge.points[0]], mesh.points[edge.points[1]]}, kDistance))
                met.edges.insert(static_cast<int>(e));
        }
    for (const Vec3& point : mesh.points)
        for (std::size_t f = 0; f < motion.faces->size(); ++f) {
            const Face& t = (*motion.faces)[f];
            if (sweep_face_point({motion.begin[t[0]], motion.begin[t[1]], motion.begin[t[2]]},
                                 {motion.end[t[0]], motion.end[t[1]], motion.end[t[2]]}, point, kDistance))
                met.faces.insert(static_cast<int>(f));
        }
    return met;
}

std::vector<int> unclean_faces(const Pairs& met, const std::set<int>& touching, const ClothMotion& motion)
{
    std::set<int> unclean = touching;
    unclean.insert(met.faces.begin(), met.faces.end());
    for (const int e : met.edges) {
        unclean.insert((*motion.edges)[e].face_left);
        if ((*motion.edges)[e].face_right >= 0) unclean.insert((*motion.edges)[e].face_right);
    }
    for (std::size_t f = 0; f < motion.faces->size(); ++f)
        for (const int v : (*motion.faces)[f])
            if (met.vertices.contains(v)) unclean.insert(static_cast<int>(f));
    return {unclean.begin(), unclean.end()};
}

/// Cloth faces that touch the obstacle at `time` (a fraction of the step), by exact predicates.
std::set<int> touching_at(const Obstacle& obstacle, const ClothMotion& motion, double time)
{
    std::set<int> touching;
    ObstacleTouch found;
    for (std::size_t f = 0; f < motion.faces->size(); ++f) {
        std::array<Vec3, 3> x;
        for (int k = 0; k < 3; ++k) {
            const int v = (*motion.faces)[f][k];
            x[k] = time >= 1.0 ? motion.end[v]
                               : Vec3(motion.begin[v] + time * (motion.end[v] - motion.begin[v]));
        }
        find_touches(obstacle, x, found);
        if (found.is_any()) touching.insert(static_cast<int>(f));
    }
    return touching;
}

using Generator = std::mt19937_64;

/// Crumpled cloth near a mixture of obstacles that moves by about `motion`, free of them at begin.
Cloth draw_cloth(Generator& random, const Obstacle& obstacle, double motion)
{
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const auto vector = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
    const ClothMesh mesh = square(3, GridPattern::Cross);
    while (true) {
        const Vec3 place = 0.8 * vector(), way = motion * vector();
        const Mat3 turn = Eigen::AngleAxisd(3.0 * uniform(random), vector().normalized()).toRotationMatrix();
        std::vector<Vec3> begin = mapped(mesh.world, [&](const Vec3& p) {
            return Vec3(turn * (p - Vec3(0.5, 0.5, 0)) + place + 0.05 * vector());
        });
        std::vector<Vec3> end =
            mapped(begin, [&](const Vec3& p) { return Vec3(p + way + 0.3 * motion * vector()); });
        Cloth probe(begin, begin, mesh.faces);
        if (touching_at(obstacle, probe.motion, 1.0).empty())
            return Cloth(std::move(begin), std::move(end), mesh.faces);
    }
}

ObstacleMesh mixture()
{
    const ObstacleMesh solids = samples::together(samples::box(Vec3(-0.6, -0.5, -0.3), Vec3(-0.1, 0.5, 0.2)),
                                                  samples::moved(samples::sphere(6, 8), [](const Vec3& p) {
                                                      return Vec3(0.3 * p + Vec3(0.5, 0.4, 0.2));
                                                  }));
    const ObstacleMesh sheet =
        samples::moved(samples::sheet(2, 2, [](int i, int j) { return 0.2 * i * j; }),
                       [](const Vec3& p) { return Vec3(0.2 * p + Vec3(0.2, -0.8, 0)); });
    const ObstacleMesh thin =
        samples::together(samples::wire({Vec3(0, -1, 0.5), Vec3(0.1, 0, 0.6), Vec3(0.9, 0.8, -0.4)}, false),
                          samples::nails({Vec3(0, 0.7, 0.3), Vec3(0.7, -0.1, -0.3)}));
    return samples::together(samples::together(solids, sheet), thin);
}

TEST(SweepCheck, AgreesWithAllPairsOnRandomMotions)
{
    Generator random(1);
    const Obstacle obstacle = make_obstacle(mixture());
    int clean = 0, through = 0;
    for (int trial = 0; trial < 600 && !HasFailure(); ++trial) {
        const double way = std::array{0.02, 0.2, 1.0}[trial % 3];
        const Cloth cloth = draw_cloth(random, obstacle, way);
        const Pairs met = sweep_all_pairs(obstacle, cloth.motion);
        const std::set<int> touching = touching_at(obstacle, cloth.motion, 1.0);
        const SweepReport report = cloth.check(obstacle);
        EXPECT_EQ(report.crossings, met.count()) << "trial " << trial;
        EXPECT_EQ(report.intersections, static_cast<int>(touching.size())) << "trial " << trial;
        EXPECT_EQ(report.faces, unclean_faces(met, touching, cloth.motion)) << "trial " << trial;
        expect_mended(report, cloth);
        clean += report.is_clean();
        through += report.crossings > 0 && report.intersections == 0;
    }
    EXPECT_GT(clean, 50);
    EXPECT_GT(through, 20);
}

// An independent test: exact predicates at intermediate positions, not the sweeps' own result.
TEST(SweepCheck, WhatTouchesOnTheWayIsReported)
{
    Generator random(2);
    const Obstacle obstacle = make_obstacle(mixture());
    int touched = 0;
    for (int trial = 0; trial < 200 && !HasFailure(); ++trial) {
        const Cloth cloth = draw_cloth(random, obstacle, 0.5);
        const SweepReport report = cloth.check(obstacle);
        std::set<int> touching;
        for (int k = 1; k <= 64; ++k) touching.merge(touching_at(obstacle, cloth.motion, k / 64.0));
        const std::set<int> reported(report.faces.begin(), report.faces.end());
        for (const int f : touching)
            EXPECT_TRUE(reported.contains(f)) << "face " << f << " of trial " << trial;
        touched += !touching.empty();
    }
    EXPECT_GT(touched, 50);
}

// After all vertices are moved to the free sides of their contacts' planes, the check finds nothing. So rows
// from the check do resolve its violations.
TEST(SweepCheck, MovingViolatorsOutMendsAFallOnABox)
{
    const Obstacle obstacle = make_obstacle(samples::box(Vec3(-1, -1, -1), Vec3(2, 2, 0)));
    Cloth cloth = falling(4, 0.1, -0.1);
    for (const ObstacleContact& c : cloth.check(obstacle).violations) {
        if (c.kind != ContactKind::Vertex) continue;
        Vec3& end = cloth.motion.end[c.vertices[0]];
        end += (c.least_gap - c.normal.dot(end - c.point)) * c.normal;
    }
    expect_clean(cloth.check(obstacle));
}

// ---- Invariance

void expect_same(const SweepReport& a, const SweepReport& b, double scale = 1.0,
                 const Vec3& shift = Vec3::Zero())
{
    EXPECT_EQ(a.crossings, b.crossings);
    EXPECT_EQ(a.intersections, b.intersections);
    EXPECT_EQ(a.faces, b.faces);
    ASSERT_EQ(a.violations.size(), b.violations.size());
    for (std::size_t i = 0; i < a.violations.size(); ++i) {
        const ObstacleContact& c = a.violations[i];
        const ObstacleContact& d = b.violations[i];
        EXPECT_EQ(c.kind, d.kind);
        EXPECT_EQ(c.vertices, d.vertices);
        EXPECT_EQ(c.element, d.element);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(c.weights[k], d.weights[k], 1e-6);
        EXPECT_LT((c.normal - d.normal).norm(), 1e-6);
        EXPECT_LT((scale * (c.point + shift) - d.point).norm(), 1e-6 * scale);
    }
}

TEST(SweepCheck, IsTheSameWithAnyNumberOfThreads)
{
    const Obstacle obstacle = make_obstacle(tilted(samples::box(Vec3(0.3, 0.3, -0.2), Vec3(0.6, 0.7, 0.2))));
    const Cloth cloth = falling(40, 0.5, -0.1);
    std::vector<SweepReport> reports;
    for (const int threads : {1, 2, 4}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        reports.push_back(cloth.check(obstacle));
        EXPECT_THAT(reports.back().violations, Not(IsEmpty()));
        expect_same(reports.front(), reports.back());
        for (std::size_t i = 0; i < reports.back().violations.size(); ++i) {
            EXPECT_EQ(reports.front().violations[i].weights, reports.back().violations[i].weights);
            EXPECT_EQ(reports.front().violations[i].normal, reports.back().violations[i].normal);
            EXPECT_EQ(reports.front().violations[i].least_gap, reports.back().violations[i].least_gap);
        }
    }
}

TEST(SweepCheck, IsTheSameFarAwayAndAtAnySize)
{
    Generator random(3);
    // Coordinates are in units of 2^-30, so that a shift by 2^20 m, about 1e6, is exact.
    const auto snap = [](const Vec3& p) {
        return Vec3(Vec3(p * std::ldexp(1.0, 30)).array().round().matrix() * std::ldexp(1.0, -30));
    };
    const ObstacleMesh mesh = samples::moved(mixture(), snap);
    const Obstacle obstacle = make_obstacle(mesh);
    struct Place {
        double scale;
        Vec3 shift;
    };
    const Vec3 far(1 << 20, -(1 << 20), 1 << 20);
    for (const auto& [scale, shift] : {Place{1.0, far}, Place{std::ldexp(1.0, -20), Vec3::Zero()},
                                       Place{std::ldexp(1.0, 20), Vec3::Zero()}}) {
        const Map map = [s = scale, t = shift](const Vec3& p) { return Vec3(s * (p + t)); };
        const Obstacle elsewhere = make_obstacle(samples::moved(mesh, map));
        for (int trial = 0; trial < 60 && !HasFailure(); ++trial) {
            Cloth cloth = draw_cloth(random, obstacle, 0.3);
            cloth.motion.begin = mapped(cloth.motion.begin, snap);
            cloth.motion.end = mapped(cloth.motion.end, snap);
            const Cloth moved(mapped(cloth.motion.begin, map), mapped(cloth.motion.end, map), cloth.faces);
            const SweepReport here = check_sweep(obstacle, cloth.motion, kThickness);
            const SweepReport there = check_sweep(elsewhere, moved.motion, kThickness * scale);
            EXPECT_EQ(here.crossings, there.crossings);
            EXPECT_EQ(here.intersections, there.intersections);
            EXPECT_EQ(here.faces, there.faces);
            if (scale != 1.0) expect_same(here, there, scale);
        }
    }
}

}  // namespace
}  // namespace arris
