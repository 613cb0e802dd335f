// SPDX-License-Identifier: GPL-3.0-or-later
// A free fold moves on in the direction of the arriving cloth, and returns to the place where it left its
// edge.
#include "solver/eol/free_fold.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <random>

namespace arris {
namespace {

constexpr double kThickness = 1e-3;  // m
constexpr double kFlow = 2.0;        // m/s
constexpr double kRoundOff =
    1e-12;  // for unit vectors, except for edges through `far`, 1e3 m from the origin

/// A convex edge through a random `point`, with the angle `tip` (rad) between its faces.
struct Edge {
    Mat3 turn;
    Vec3 point;
    FeatureEdge feature;
    FeatureFrame frame;
    std::array<Vec3, 2> onward;  ///< along each face, beyond the edge

    Edge(double tip, unsigned seed, double far = 0.0)
    {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> any(-1.0, 1.0);
        turn = Eigen::Quaterniond(any(random), any(random), any(random), any(random)).normalized().matrix();
        point = Vec3(any(random), any(random), any(random)) + Vec3::Constant(far);
        for (const int k : {0, 1}) {
            const double side = k == 0 ? -1.0 : 1.0;
            feature.normals[k] = at(side * std::cos(0.5 * tip), std::sin(0.5 * tip));
            onward[k] = at(-side * std::sin(0.5 * tip), std::cos(0.5 * tip));
        }
        feature.kind = FeatureKind::Convex;
        frame = {point, turn.col(1), at(0.0, 1.0), std::min(1.0 / std::sin(0.5 * tip), 2.0)};
    }
    /// A vector perpendicular to the edge, from its components along the bisector and perpendicular to it.
    Vec3 at(double aside, double out) const { return turn * Vec3(aside, 0.0, out); }
    Vec3 held() const { return point + frame.mitre * kThickness * frame.outward; }

    FeatureFrame free(const Vec3& place, const Vec3& arriving, double flow = kFlow) const
    {
        return turn_to_free_fold(feature, {arriving, flow}, place, kThickness, frame);
    }
};

const double kTips[] = {0.1, 1.0, 0.5 * M_PI, 2.0, 2.5};  // rad, from a knife to a very blunt edge

TEST(FreeFold, OnItsEdgeIsNotTurned)
{
    const Edge edge(0.5 * M_PI, 1);
    for (const double share : {-1.0, 0.0, 0.5, 1.0}) {
        const Vec3 place = edge.point + share * edge.frame.mitre * kThickness * edge.frame.outward;
        const FeatureFrame free = edge.free(place, -edge.onward[0]);
        EXPECT_EQ(free.outward, edge.frame.outward);
        EXPECT_EQ(free.mitre, edge.frame.mitre);
    }
}

TEST(FreeFold, GoesOnAlongTheFaceOnWhichArrivingClothLies)
{
    for (const double tip : kTips)
        for (unsigned seed = 0; seed < 5; ++seed)
            for (const int k : {0, 1}) {
                const Edge edge(tip, seed);
                for (const double out : {0.01, 0.1}) {
                    const FeatureFrame free = edge.free(
                        edge.held() + out * edge.onward[k] + 0.3 * edge.frame.tangent, -edge.onward[k]);
                    const double both = tip < 0.4 ? tip : 0.0;  // a knife's two faces are almost one
                    EXPECT_LT((free.outward - edge.onward[k]).norm(), both + kRoundOff) << tip << " " << k;
                }
            }
}

TEST(FreeFold, ComesBackToWhereTheEdgeHeldIt)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(0.0, 1.0);
    for (const double tip : kTips)
        for (int k = 0; k < 20; ++k) {
            const Edge edge(tip, static_cast<unsigned>(k));
            const Vec3 way = (any(random) * edge.onward[0] + any(random) * edge.onward[1]).normalized();
            const double out = 0.02 + 0.1 * any(random);
            // Cloth that lies along neither face, or does not flow, selects no face.
            for (const auto& [arriving, flow] :
                 {std::pair(Vec3(-edge.frame.outward), kFlow), std::pair(Vec3(-edge.onward[0]), 0.0)}) {
                if (tip < 0.8 && flow > 0.0) continue;  // a knife's bisector is nearly along its faces
                const FeatureFrame free = edge.free(edge.held() + out * way, arriving, flow);
                EXPECT_LT((free.outward - way).norm(), 1e3 * kRoundOff) << tip;
            }
        }
}

TEST(FreeFold, HoldsItsVertexNowhereElseThanTheEdgeDoes)
{
    for (const double tip : kTips)
        for (const int k : {0, 1})
            for (const double out : {1e-4, 1e-3, 0.1}) {
                const Edge edge(tip, 7);
                const FeatureFrame free = edge.free(edge.held() + out * edge.frame.outward, -edge.onward[k]);
                EXPECT_NEAR(free.outward.dot(edge.held() - edge.point), free.mitre * kThickness,
                            kRoundOff * kThickness);
            }
}

TEST(FreeFold, NeverMovesTowardsAFace)
{
    std::mt19937 random(11);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    for (const double far : {0.0, 1e3})
        for (int k = 0; k < 2000; ++k) {
            const Edge edge(kTips[k % 5], static_cast<unsigned>(k), far);
            const double scale = std::pow(10.0, -4.0 + 4.0 * (k % 7) / 6.0);
            const Vec3 place = edge.point + scale * Vec3(any(random), any(random), any(random));
            const Vec3 arriving =
                k % 9 == 0 ? Vec3::Zero() : Vec3(edge.at(any(random), any(random)).normalized());
            const FeatureFrame free = edge.free(place, arriving, 3.0 * std::abs(any(random)));
            EXPECT_NEAR(free.outward.norm(), 1.0, kRoundOff);
            // The edge's point may be 1e3 m away, known to 1e-13 relative.
            EXPECT_NEAR(free.outward.dot(free.tangent), 0.0, 1e-9);
            EXPECT_GT(free.mitre, -kRoundOff);
            for (const Vec3& normal : edge.feature.normals) EXPECT_GT(free.outward.dot(normal), -1e-9) << k;
        }
}

// A jump of the direction would project velocities onto other coordinates and dissipate energy wherever flow
// oscillates.
TEST(FreeFold, TurnsEvenlyAsItLeavesAndAsFlowTurns)
{
    const Edge edge(0.5 * M_PI, 5);
    const auto outward = [&](double out, double flow, double tilt) {
        const Vec3 arriving = -(std::cos(tilt) * edge.onward[0] + std::sin(tilt) * edge.onward[1]);
        return edge.free(edge.held() + out * edge.at(0.3, 1.0), arriving, flow).outward;
    };
    const auto expect_even = [](const auto& turned, double from, double to, double step, double steepest) {
        for (double x = from; x < to; x += step)
            ASSERT_LT((turned(x + step) - turned(x)).norm(), steepest * step) << x;
    };
    // The direction turns by 45 degrees over half a stand-off, over a change of flow by kFreeFlow, and over 6
    // degrees of tilt.
    expect_even([&](double out) { return outward(out, kFlow, 0.0); }, -2e-3, 4e-3, 1e-6, 3e3);
    expect_even([&](double flow) { return outward(0.02, flow, 0.0); }, 0.0, 1.5, 1e-3, 3.0);
    expect_even([&](double tilt) { return outward(0.02, kFlow, tilt); }, -0.6, 0.6, 1e-3, 30.0);
}

// Along the bisector the fold's bound would hold the fold above the face, and the cloth between fold and edge
// would stay slack.
TEST(FreeFold, ComesDownOnTheFaceOverWhichItHasComeBack)
{
    for (const double tip : {0.5 * M_PI, 2.0, 2.5})
        for (const int k : {0, 1})
            for (const double inside : {0.002, 0.005}) {  // m, less than its height
                const Edge edge(tip, 9);
                const Vec3& normal = edge.feature.normals[k];
                const Vec3 place = edge.point + 0.008 * normal - inside * edge.onward[k];
                const FeatureFrame free = edge.free(place, -edge.onward[k], 0.0);
                const double down = free.outward.dot(place - edge.point) - free.mitre * kThickness;
                const double height = normal.dot(place - down * free.outward - edge.point);
                EXPECT_GT(height, 0.0) << tip << " " << inside;
                EXPECT_LT(height, 1.01 * kThickness) << tip << " " << inside;
            }
    const Edge edge(0.5 * M_PI, 9);
    const auto outward = [&](double aside) {
        return edge.free(edge.point + edge.at(aside, 0.008), -edge.onward[0], 0.0).outward;
    };
    for (double aside = -0.03; aside < 0.03; aside += 1e-5)
        ASSERT_LT((outward(aside + 1e-5) - outward(aside)).norm(), 3e2 * 1e-5) << aside;
}

TEST(FreeFold, HasLeftOnlyBeyondWhatAnyMitreKeeps)
{
    for (const double tip : kTips) {
        const Edge edge(tip, 2);
        const Vec3 along = 5.0 * edge.frame.tangent;
        EXPECT_FALSE(has_left_feature(edge.frame.point + along, edge.held() + along, kThickness));
        EXPECT_TRUE(has_left_feature(edge.frame.point, edge.held() + 0.01 * edge.onward[0], kThickness));
    }
}

}  // namespace
}  // namespace arris
