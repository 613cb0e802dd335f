// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/contact/continuous_collision.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <string>

namespace arris {
namespace {

enum class Kind { VertexFace, EdgeEdge, FacePoint };
constexpr std::array<Kind, 3> kKinds{Kind::VertexFace, Kind::EdgeEdge, Kind::FacePoint};

/// A pair of any kind, with the corresponding numbers of cloth and obstacle points.
struct Case {
    Kind kind;
    std::array<Vec3, 3> begin, end, obstacle;

    int cloth_points() const { return kind == Kind::VertexFace ? 1 : kind == Kind::EdgeEdge ? 2 : 3; }
    int obstacle_points() const { return 4 - cloth_points(); }
};

std::optional<SweepHit> sweep(const Case& c, double distance)
{
    switch (c.kind) {
        case Kind::VertexFace:
            return sweep_vertex_face(c.begin[0], c.end[0], c.obstacle, distance);
        case Kind::EdgeEdge:
            return sweep_edge_edge({c.begin[0], c.begin[1]}, {c.end[0], c.end[1]},
                                   {c.obstacle[0], c.obstacle[1]}, distance);
        case Kind::FacePoint:
            return sweep_face_point(c.begin, c.end, c.obstacle[0], distance);
    }
    return std::nullopt;
}

Case mapped(const Case& c, double scale, const Vec3& shift)
{
    Case result = c;
    for (int k = 0; k < 3; ++k) {
        result.begin[k] = scale * (c.begin[k] + shift);
        result.end[k] = scale * (c.end[k] + shift);
        result.obstacle[k] = scale * (c.obstacle[k] + shift);
    }
    return result;
}

std::string describe(const Case& c)
{
    std::ostringstream out;
    out.precision(17);
    out << "kind " << static_cast<int>(c.kind);
    for (int k = 0; k < c.cloth_points(); ++k)
        out << "\n " << c.begin[k].transpose() << " -> " << c.end[k].transpose();
    for (int k = 0; k < c.obstacle_points(); ++k) out << "\n at " << c.obstacle[k].transpose();
    return out.str();
}

// ---- Pairs that touch at a known time, in integers, so that no rounding occurs.

using Generator = std::mt19937_64;

int draw(Generator& random, int least, int most)
{
    return std::uniform_int_distribution<int>(least, most)(random);
}

/// Coordinates with magnitudes from 0 to 1000, so that flat, thin and degenerate elements are frequent.
Vec3 draw_vector(Generator& random)
{
    constexpr std::array<int, 5> kSizes{0, 1, 2, 30, 1000};
    Vec3 v;
    for (int k = 0; k < 3; ++k) {
        const int size = kSizes[draw(random, 0, 4)];
        v[k] = draw(random, -size, size);
    }
    return v;
}

/// `count` points whose convex hull contains the origin.
std::array<Vec3, 3> draw_around_origin(Generator& random, int count)
{
    std::array<Vec3, 3> points{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    const Vec3 p = draw_vector(random);
    const Vec3 q = draw_vector(random);
    const int i = draw(random, 0, 4);
    const int j = draw(random, 0, 4 - i);
    const int k = 4 - i - j;
    if (count == 2) points = {Vec3(-i * p), Vec3((4 - i) * p), Vec3::Zero()};
    // i (k p) + j (k q) - k (i p + j q) = 0
    if (count == 3) points = {Vec3(k * p), Vec3(k * q), Vec3(-(i * p + j * q))};
    if (count == 3 && k == 0) points = {Vec3(j * p), Vec3(-i * p), q};
    return points;
}

struct KnownTouch {
    Case pair;
    double time;
};

KnownTouch draw_touch(Generator& random, Kind kind)
{
    KnownTouch touch{{kind, {}, {}, {}}, 0.0};
    Case& c = touch.pair;
    const std::array<Vec3, 3> cloth = draw_around_origin(random, c.cloth_points());
    c.obstacle = draw_around_origin(random, c.obstacle_points());
    constexpr int kParts = 16;
    const int parts = draw(random, 0, kParts);
    touch.time = static_cast<double>(parts) / kParts;
    const Vec3 shared = draw_vector(random);
    const bool translates = draw(random, 0, 2) == 0;
    for (int k = 0; k < c.cloth_points(); ++k) {
        const Vec3 motion = translates ? shared : draw_vector(random);
        c.begin[k] = cloth[k] - parts * motion;
        c.end[k] = cloth[k] + (kParts - parts) * motion;
    }
    return touch;
}

TEST(ContinuousCollision, NeverMissesAKnownTouch)
{
    Generator random(1);
    const std::array<double, 3> scales{1.0, std::ldexp(1.0, -20), std::ldexp(1.0, 20)};
    const std::array<Vec3, 2> shifts{Vec3::Zero(), Vec3(1 << 20, -(1 << 21), 1 << 20)};
    for (int trial = 0; trial < 300000; ++trial) {
        const KnownTouch touch = draw_touch(random, kKinds[trial % 3]);
        const double scale = scales[draw(random, 0, 2)];
        const Case c = mapped(touch.pair, scale, shifts[draw(random, 0, 1)]);
        const std::optional<SweepHit> hit = sweep(c, 1e-12 * scale);
        ASSERT_TRUE(hit) << "trial " << trial << ", at " << touch.time << ": " << describe(c);
        ASSERT_LE(hit->time, touch.time + 1e-12) << describe(c);
        ASSERT_GE(hit->time, 0.0);
    }
}

// A known touch rotated to general position. Rounding may remove the touch, which `distance` covers.
TEST(ContinuousCollision, NeverMissesATouchInGeneralPosition)
{
    Generator random(2);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int trial = 0; trial < 100000; ++trial) {
        const KnownTouch touch = draw_touch(random, kKinds[trial % 3]);
        const Vec3 axis(uniform(random), uniform(random), uniform(random));
        const Mat3 turn = Eigen::AngleAxisd(3.0 * uniform(random), axis.normalized()).toRotationMatrix();
        Case c = touch.pair;
        for (int k = 0; k < 3; ++k) {
            c.begin[k] = turn * c.begin[k];
            c.end[k] = turn * c.end[k];
            c.obstacle[k] = turn * c.obstacle[k];
        }
        // Coordinates are below 2e5, where an ulp is 3e-11.
        const std::optional<SweepHit> hit = sweep(c, 1e-9);
        ASSERT_TRUE(hit) << "trial " << trial << ", at " << touch.time << ": " << describe(c);
        ASSERT_LE(hit->time, touch.time + 1e-9) << describe(c);
    }
}

// ---- Independent oracle: distances in long double, and bisection by the greatest speed.

using Real = long double;
using Real3 = Eigen::Matrix<Real, 3, 1>;

Real distance_to_segment(const Real3& p, const Real3& a, const Real3& b)
{
    const Real3 side = b - a;
    const Real square = side.squaredNorm();
    const Real s = square > 0 ? std::min<Real>(1, std::max<Real>(0, (p - a).dot(side) / square)) : 0;
    return (p - a - s * side).norm();
}

Real distance_to_triangle(const Real3& p, const std::array<Real3, 3>& t)
{
    Real least = std::numeric_limits<Real>::infinity();
    for (int k = 0; k < 3; ++k) least = std::min(least, distance_to_segment(p, t[k], t[(k + 1) % 3]));
    const Real3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
    bool is_over = normal.norm() > 0;
    for (int k = 0; k < 3; ++k) {
        const Real3 inward = normal.cross(t[(k + 1) % 3] - t[k]);
        is_over = is_over && inward.dot(p - t[k]) >= 0;
    }
    return is_over ? std::min(least, std::abs(normal.dot(p - t[0])) / normal.norm()) : least;
}

Real distance_of_segments(const Real3& a, const Real3& b, const Real3& c, const Real3& d)
{
    Real least = std::min(std::min(distance_to_segment(a, c, d), distance_to_segment(b, c, d)),
                          std::min(distance_to_segment(c, a, b), distance_to_segment(d, a, b)));
    const Real3 normal = (b - a).cross(d - c);
    if (!(normal.norm() > 0)) return least;
    // The ends of each segment are on either side of the plane through the other segment and the normal.
    const Real3 across_ab = normal.cross(b - a);
    const Real3 across_cd = normal.cross(d - c);
    const bool is_crossed =
        across_ab.dot(c - a) * across_ab.dot(d - a) <= 0 && across_cd.dot(a - c) * across_cd.dot(b - c) <= 0;
    return is_crossed ? std::min(least, std::abs(normal.dot(c - a)) / normal.norm()) : least;
}

Real distance_at(const Case& c, Real time)
{
    std::array<Real3, 3> x, o;
    for (int k = 0; k < 3; ++k) {
        x[k] = (1 - time) * c.begin[k].cast<Real>() + time * c.end[k].cast<Real>();
        o[k] = c.obstacle[k].cast<Real>();
    }
    if (c.kind == Kind::VertexFace) return distance_to_triangle(x[0], o);
    if (c.kind == Kind::FacePoint) return distance_to_triangle(o[0], x);
    return distance_of_segments(x[0], x[1], o[0], o[1]);
}

/// The first time at which the distance is at most `least`, to 1e-9 of the step; empty if that never happens.
std::optional<Real> first_within(const Case& c, Real least, Real from, Real to)
{
    Real speed = 0;
    for (int k = 0; k < c.cloth_points(); ++k) speed = std::max<Real>(speed, (c.end[k] - c.begin[k]).norm());
    const Real middle = (from + to) / 2;
    const Real half = (to - from) / 2;
    if (distance_at(c, middle) > least + speed * half) return std::nullopt;
    if (half < 1e-9L) return from;
    const std::optional<Real> left = first_within(c, least, from, middle);
    return left ? left : first_within(c, least, middle, to);
}

double motion_size(const Case& c)
{
    double size = 0.0;
    for (int k = 0; k < c.cloth_points(); ++k) size = std::max(size, (c.end[k] - c.begin[k]).norm());
    return size;
}

void expect_meeting_point(const Case& c, const SweepHit& hit, double tolerance)
{
    Vec3 meeting = Vec3::Zero();
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) {
        EXPECT_GE(hit.weights[k], 0.0);
        sum += hit.weights[k];
        if (k < c.cloth_points())
            meeting += hit.weights[k] * (c.begin[k] + hit.time * (c.end[k] - c.begin[k]));
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
    EXPECT_LT((meeting - hit.point).norm(), tolerance) << describe(c);
    EXPECT_NEAR(hit.normal.norm(), 1.0, 1e-12) << describe(c);
}

/// Compares with the oracle and returns whether the pair met. Coordinates of the pair are of order 1.
bool expect_oracle_agrees(const Case& c, double distance)
{
    constexpr Real kApart = 1e-7L;     // within this distance either result is accepted
    constexpr double kMeeting = 1e-8;  // rounding of the meeting point, plus `distance`
    const std::optional<SweepHit> hit = sweep(c, distance);
    const std::optional<Real> approach = first_within(c, kApart, 0, 1);
    if (!approach) {
        EXPECT_FALSE(hit) << describe(c);
        return false;
    }
    if (!hit) {
        EXPECT_FALSE(first_within(c, 0, 0, 1) && distance_at(c, *first_within(c, 0, 0, 1)) < 1e-12L)
            << "missed: " << describe(c);
        return false;
    }
    EXPECT_GE(hit->time, *approach - 1e-8) << describe(c);
    const double before = static_cast<double>(distance_at(c, hit->time));
    EXPECT_LT(before, kMeeting) << "at " << hit->time << ": " << describe(c);
    expect_meeting_point(c, *hit, kMeeting * (1.0 + motion_size(c)));
    return true;
}

Case draw_case(Generator& random, Kind kind, double motion, double thinness)
{
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const auto vector = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
    Case c{kind, {}, {}, {}};
    const Vec3 shared = vector();
    for (int k = 0; k < 3; ++k) {
        c.begin[k] = vector();
        c.obstacle[k] = vector();
        c.end[k] = c.begin[k] + motion * (shared + 0.3 * vector());
    }
    // Slivers: the last corner is nearly on the line of the others.
    if (thinness > 0.0 && kind == Kind::VertexFace)
        c.obstacle[2] = 0.3 * c.obstacle[0] + 0.7 * c.obstacle[1] + thinness * c.obstacle[2];
    if (thinness > 0.0 && kind == Kind::FacePoint) {
        c.begin[2] = 0.3 * c.begin[0] + 0.7 * c.begin[1] + thinness * c.begin[2];
        c.end[2] = 0.3 * c.end[0] + 0.7 * c.end[1] + thinness * c.end[2];
    }
    if (thinness > 0.0 && kind == Kind::EdgeEdge)  // nearly parallel
        c.obstacle[1] = c.obstacle[0] + c.begin[1] - c.begin[0] + thinness * c.obstacle[1];
    return c;
}

TEST(ContinuousCollision, AgreesWithAnOracleInGeneralPosition)
{
    Generator random(3);
    int hits = 0;
    for (int trial = 0; trial < 30000 && !HasFailure(); ++trial)
        hits += expect_oracle_agrees(draw_case(random, kKinds[trial % 3], 2.0, 0.0), 1e-10);
    EXPECT_GT(hits, 1000);
}

TEST(ContinuousCollision, AgreesWithAnOracleOnSliversAndParallels)
{
    Generator random(4);
    for (const double thinness : {1e-2, 1e-4, 1e-6, 1e-9}) {
        for (int trial = 0; trial < 3000 && !HasFailure(); ++trial)
            expect_oracle_agrees(draw_case(random, kKinds[trial % 3], 2.0, thinness), 1e-10);
    }
}

TEST(ContinuousCollision, AgreesWithAnOracleWhereTheMotionIsLong)
{
    Generator random(5);
    for (int trial = 0; trial < 3000 && !HasFailure(); ++trial) {
        Case c = draw_case(random, kKinds[trial % 3], 1e3, 0.0);
        for (int k = 0; k < 3; ++k) {  // aims near the obstacle
            c.begin[k] -= 0.4 * (c.end[0] - c.begin[0]);
            c.end[k] -= 0.4 * (c.end[0] - c.begin[0]);
        }
        expect_oracle_agrees(c, 1e-10);
    }
}

TEST(ContinuousCollision, ResultDoesNotChangeWithThePlace)
{
    Generator random(6);
    const Vec3 shift(1 << 20, 1 << 20, -(1 << 20));  // about 1e6 m
    for (int trial = 0; trial < 30000; ++trial) {
        Case c = draw_case(random, kKinds[trial % 3], 2.0, 0.0);
        // Coordinates in units of 2^-30, so that shifting them is exact.
        for (std::array<Vec3, 3>* points : {&c.begin, &c.end, &c.obstacle})
            for (Vec3& p : *points)
                for (int k = 0; k < 3; ++k) p[k] = std::ldexp(std::round(std::ldexp(p[k], 30)), -30);
        const std::optional<SweepHit> here = sweep(c, 1e-10);
        const std::optional<SweepHit> there = sweep(mapped(c, 1.0, shift), 1e-10);
        ASSERT_EQ(here.has_value(), there.has_value()) << describe(c);
        if (here) {
            ASSERT_EQ(here->time, there->time);
            ASSERT_EQ(here->weights, there->weights);
        }
        // The result does not depend on the size either, except for the unit.
        const std::optional<SweepHit> small =
            sweep(mapped(c, std::ldexp(1.0, -20), Vec3::Zero()), std::ldexp(1e-10, -20));
        ASSERT_EQ(here.has_value(), small.has_value());
        ASSERT_EQ(here ? here->time : 0.0, small ? small->time : 0.0);
    }
}

// ---- Cases known by hand

constexpr double kDistance = 1e-12;
const std::array<Vec3, 3> kTriangle{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};

TEST(SweepVertexFace, FallingMeetsTheFaceWhereAndWhenItShould)
{
    const auto hit = sweep_vertex_face({0.25, 0.5, 1.0}, {0.25, 0.5, -3.0}, kTriangle, kDistance);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->time, 0.25, 1e-9);
    EXPECT_LT((hit->point - Vec3(0.25, 0.5, 0.0)).norm(), 1e-9);
    EXPECT_LT((hit->normal - Vec3::UnitZ()).norm(), 1e-9);
    // From below the normal has the opposite sign.
    const auto below = sweep_vertex_face({0.25, 0.5, -1.0}, {0.25, 0.5, 3.0}, kTriangle, kDistance);
    ASSERT_TRUE(below);
    EXPECT_LT((below->normal + Vec3::UnitZ()).norm(), 1e-9);
}

TEST(SweepVertexFace, PassingBesideIsFree)
{
    EXPECT_FALSE(sweep_vertex_face({0.6, 0.6, 1.0}, {0.6, 0.6, -3.0}, kTriangle, kDistance));
    EXPECT_FALSE(sweep_vertex_face({0.5 + 1e-9, 0.5, 1.0}, {0.5 + 1e-9, 0.5, -3.0}, kTriangle, kDistance));
    EXPECT_TRUE(sweep_vertex_face({0.5 - 1e-9, 0.5, 1.0}, {0.5 - 1e-9, 0.5, -3.0}, kTriangle, kDistance));
}

TEST(SweepVertexFace, TouchingIsAHit)
{
    const Vec3 above(0.25, 0.25, 1.0), on(0.25, 0.25, 0.0);
    const auto at_end = sweep_vertex_face(above, on, kTriangle, kDistance);
    ASSERT_TRUE(at_end);
    EXPECT_NEAR(at_end->time, 1.0, 1e-9);
    const auto at_begin = sweep_vertex_face(on, above, kTriangle, kDistance);
    ASSERT_TRUE(at_begin);
    EXPECT_EQ(at_begin->time, 0.0);
    EXPECT_TRUE(sweep_vertex_face(on, on, kTriangle, kDistance));
    EXPECT_FALSE(sweep_vertex_face(above, above, kTriangle, kDistance));
    // Motion along the face in its plane, and to the face's corner.
    EXPECT_TRUE(sweep_vertex_face({-1, 0.25, 0}, {2, 0.25, 0}, kTriangle, kDistance));
    EXPECT_TRUE(sweep_vertex_face({1, 0, 1}, {1, 0, -1}, kTriangle, kDistance));
}

// A free motion is not a hit at any distance: `distance` must not stop it.
TEST(SweepVertexFace, SlidingAtATinyGapIsFree)
{
    for (const double gap : {1e-4, 1e-8, 1e-12, 1e-13}) {
        EXPECT_FALSE(sweep_vertex_face({0.1, 0.1, gap}, {0.6, 0.3, gap}, kTriangle, 1e-6)) << gap;
        EXPECT_FALSE(sweep_vertex_face({0.1, 0.1, gap}, {0.6, 0.3, 2.0}, kTriangle, 1e-6)) << gap;
        EXPECT_FALSE(sweep_vertex_face({0.1, 0.1, gap}, {0.1, 0.1, gap}, kTriangle, 1e-6)) << gap;
        EXPECT_TRUE(sweep_vertex_face({0.1, 0.1, gap}, {0.6, 0.3, -gap}, kTriangle, kDistance)) << gap;
    }
}

TEST(SweepVertexFace, SlidingBesideARimAtATinyGapIsFree)
{
    // In the face's plane signed volumes are zero and give no information.
    for (const double gap : {1e-8, 1e-10, 1e-12}) {
        EXPECT_FALSE(sweep_vertex_face({0.3, -gap, 0}, {0.6, -gap, 0}, kTriangle, 1e-6)) << gap;
        EXPECT_FALSE(sweep_vertex_face({0.3, -gap, 0}, {0.6, -3 * gap, 0}, kTriangle, 1e-6)) << gap;
        EXPECT_FALSE(sweep_vertex_face({0.3, -gap, 0.1}, {0.6, -gap, -0.1}, kTriangle, 0.5 * gap)) << gap;
        EXPECT_FALSE(sweep_vertex_face({0.3, -gap, 0}, {0.3, -gap, 0}, kTriangle, 1e-6)) << gap;
        EXPECT_TRUE(sweep_vertex_face({0.3, -gap, 0}, {0.6, gap, 0}, kTriangle, 1e-6)) << gap;
        // Around a corner no separating plane is valid for long.
        EXPECT_FALSE(sweep_vertex_face({1 + gap, -gap, 0}, {0.9, 0.5, 0}, kTriangle, 1e-6)) << gap;
    }
}

TEST(SweepVertexFace, DegenerateFacesAreSegmentsAndPoints)
{
    const Vec3 a(0, 0, 0), b(1, 0, 0);
    EXPECT_TRUE(sweep_vertex_face({0.5, 0, 1}, {0.5, 0, -1}, {a, b, a}, kDistance));
    EXPECT_TRUE(sweep_vertex_face({0.5, 0, 1}, {0.5, 0, -1}, {a, b, Vec3(0.25, 0, 0)}, kDistance));
    EXPECT_FALSE(sweep_vertex_face({0.5, 1e-9, 1}, {0.5, 1e-9, -1}, {a, b, a}, kDistance));
    EXPECT_TRUE(sweep_vertex_face({1, 0, 1}, {1, 0, -1}, {b, b, b}, kDistance));
    EXPECT_FALSE(sweep_vertex_face({1, 1e-9, 1}, {1, 1e-9, -1}, {b, b, b}, kDistance));
}

TEST(SweepEdgeEdge, CrossingInTheMiddle)
{
    const auto hit = sweep_edge_edge({Vec3(0, -1, 1), Vec3(0, 3, 1)}, {Vec3(0, -1, -1), Vec3(0, 3, -1)},
                                     {Vec3(-1, 0, 0), Vec3(1, 0, 0)}, kDistance);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->time, 0.5, 1e-9);
    EXPECT_NEAR(hit->weights[1], 0.25, 1e-9);
    EXPECT_LT(hit->point.norm(), 1e-9);
    EXPECT_LT((hit->normal - Vec3::UnitZ()).norm(), 1e-9);
}

// Over an edge at a small gap, one end moves 10 cm down and the other up. No separating plane is valid for
// long, but the edges never meet.
TEST(SweepEdgeEdge, PivotingOverAnEdgeAtATinyGapIsFree)
{
    const std::array<Vec3, 2> edge{Vec3(-1, 0, 0), Vec3(1, 0, 0)};
    for (const double gap : {1e-3, 1e-4, 1e-6}) {
        const std::array<Vec3, 2> begin{Vec3(0.01, -0.05, gap), Vec3(0.01, 0.05, gap)};
        EXPECT_FALSE(sweep_edge_edge(begin, {Vec3(0.01, -0.05, gap - 0.1), Vec3(0.01, 0.05, gap + 0.1)}, edge,
                                     kDistance));
        EXPECT_TRUE(sweep_edge_edge(begin,
                                    {Vec3(0.01, -0.05, gap - 0.1), Vec3(0.01, 0.05, gap + 0.0999 - 3 * gap)},
                                    edge, kDistance));
    }
}

TEST(SweepEdgeEdge, ParallelEdgesMeetAndPass)
{
    const std::array<Vec3, 2> edge{Vec3(-1, 0, 0), Vec3(1, 0, 0)};
    const std::array<Vec3, 2> begin{Vec3(-1, 0, 1), Vec3(1, 0, 1)};
    EXPECT_TRUE(sweep_edge_edge(begin, {Vec3(-1, 0, -1), Vec3(1, 0, -1)}, edge, kDistance));
    EXPECT_FALSE(sweep_edge_edge(begin, {Vec3(-1, 3, -1), Vec3(1, 3, -1)}, edge, kDistance));
    // Collinear edges that meet end to end.
    EXPECT_TRUE(
        sweep_edge_edge({Vec3(2, 0, 0), Vec3(3, 0, 0)}, {Vec3(1, 0, 0), Vec3(2, 0, 0)}, edge, kDistance));
    EXPECT_FALSE(
        sweep_edge_edge({Vec3(2, 0, 0), Vec3(3, 0, 0)}, {Vec3(1.001, 0, 0), Vec3(2, 0, 0)}, edge, kDistance));
}

// With all points in one plane the volume is 0 throughout and certifies nothing.
TEST(SweepEdgeEdge, PivotingInOnePlaneAtASmallGapIsFree)
{
    const std::array<Vec3, 2> edge{Vec3(-1, 0, 0), Vec3(0, 0, 0)};
    const std::array<Vec3, 2> begin{Vec3(1e-3, -0.05, 0), Vec3(1e-3, 0.05, 0)};
    EXPECT_FALSE(sweep_edge_edge(begin, {Vec3(-0.1, -0.05, 0), Vec3(0.102, 0.05, 0)}, edge, kDistance));
}

TEST(SweepFacePoint, FallsOnANail)
{
    const std::array<Vec3, 3> begin{Vec3(-1, -1, 1), Vec3(3, -1, 1), Vec3(-1, 3, 1)};
    const std::array<Vec3, 3> end{Vec3(-1, -1, -1), Vec3(3, -1, -1), Vec3(-1, 3, -1)};
    const auto hit = sweep_face_point(begin, end, Vec3::Zero(), kDistance);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->time, 0.5, 1e-9);
    EXPECT_NEAR(hit->weights[0], 0.5, 1e-9);
    EXPECT_LT((hit->normal - Vec3::UnitZ()).norm(), 1e-9);
    EXPECT_FALSE(sweep_face_point(begin, end, Vec3(1.01, 1.01, 0), kDistance));
}

TEST(SweepFacePoint, TurningThroughEdgeOnStillMeets)
{
    // The triangle flips over; at half time it is in the plane x = 0 with the point inside.
    const std::array<Vec3, 3> begin{Vec3(0, -1, 0), Vec3(0, 1, 0), Vec3(1, 0, 1)};
    const std::array<Vec3, 3> end{Vec3(0, -1, 0), Vec3(0, 1, 0), Vec3(-1, 0, 1)};
    const auto hit = sweep_face_point(begin, end, Vec3(0, 0, 0.5), kDistance);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->time, 0.5, 1e-9);
    EXPECT_LT((hit->normal - Vec3::UnitX()).norm(), 1e-6);
}

// A motion with NaN must be reported, as it proves nothing.
TEST(ContinuousCollision, NotANumberIsReported)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const Vec3& bad :
         {Vec3(nan, 5, 5), Vec3(5, 5, nan), Vec3(std::numeric_limits<double>::infinity(), 5, 5)}) {
        EXPECT_TRUE(sweep_vertex_face({5, 5, 5}, bad, kTriangle, kDistance));
        EXPECT_TRUE(sweep_vertex_face(bad, {5, 5, 5}, kTriangle, kDistance));
    }
}

}  // namespace
}  // namespace arris
