// SPDX-License-Identifier: GPL-3.0-or-later
// The sides of cloth over a wire keep off the fold plane behind the EOL vertex. Then no edge of that vertex
// meets the wire.
#include "solver/eol/wire_fold.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "geometry/closest_point.h"

namespace arris {
namespace {

constexpr double kHeight = 1e-3;     // m, of the vertex over the wire
constexpr double kSpeed = 0.1;       // m/s, of the vertex around it
constexpr double kLeast = 5e-3;      // rad, between a side and the plane
constexpr double kRoundOff = 1e-12;  // for lengths and angles of order 1

/// A wire through a random `point`, with a vertex straight outward of the wire. `at(angle, way, along)` is a
/// place behind that vertex.
struct Wire {
    Mat3 turn;
    Vec3 point;

    explicit Wire(unsigned seed, double far = 0.0)
    {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> any(-1.0, 1.0);
        turn = Eigen::Quaterniond(any(random), any(random), any(random), any(random)).normalized().matrix();
        point = Vec3(any(random), any(random), any(random)) + Vec3::Constant(far);
    }
    Vec3 tangent() const { return turn.col(1); }
    Vec3 outward(double angle = 0.0) const { return turn * Vec3(-std::sin(angle), 0.0, std::cos(angle)); }
    Vec3 at(double angle, double way, double along = 0.0) const
    {
        return point - way * outward(angle) + along * tangent();
    }
    FeatureFrame frame(double angle = 0.0) const { return {point, tangent(), outward(angle), 1.0}; }
    Vec3 vertex(double height = kHeight) const { return point + height * outward(); }
    double turned(const Vec3& to) const
    {
        return std::atan2(tangent().dot(outward().cross(to)), outward().dot(to));
    }
};

// The angles of two edges that leave the vertex are from the direction straight down to the wire.
TEST(IsFoldedAround, HoldsWhereBothSidesPassTheWireNearerThanTheVertex)
{
    struct Case {
        const char* name;
        double left, right;  // rad
        bool is_folded;
    };
    constexpr double kReach = 2.5 * kHeight, kHigh = 20.0 * kHeight;
    for (const auto& [height, cases] :
         {std::pair(kHeight, std::vector<Case>{{"nearly shut", 5e-3, 5e-3, true},
                                               {"right angle", M_PI / 4.0, M_PI / 4.0, true},
                                               {"uneven", 0.1, 1.5, true},
                                               {"nearly flat", 1.56, 1.56, true},
                                               {"flat, the vertex beside the wire", 1.4, M_PI - 1.4, false},
                                               {"upwards", 0.5, 2.0, false},
                                               {"both on one side", 0.3, -0.6, false}}),
          {kHigh, std::vector<Case>{{"nearly shut", 5e-3, 5e-3, true},
                                    {"one side beyond the reach", 5e-3, 0.5, false},
                                    {"right angle", M_PI / 4.0, M_PI / 4.0, false}}}})
        for (const Case& c : cases)
            for (unsigned seed = 0; seed < 20; ++seed) {
                const Wire wire(seed, 3.0);
                const std::array<Vec3, 2> segment = {wire.point - wire.tangent(),
                                                     wire.point + 2.0 * wire.tangent()};
                const Vec3 vertex = wire.vertex(height);
                const auto leaving = [&](double angle, double along) {
                    return Vec3(vertex + 0.1 * (wire.at(angle, 1.0) - wire.point) + along * wire.tangent());
                };
                // Edges along the fold are as far from the wire as the vertex, and on neither side.
                const Vec3 along = vertex + 0.1 * wire.tangent();
                for (const bool is_swapped : {false, true}) {
                    const double first = is_swapped ? -c.right : c.left,
                                 second = is_swapped ? c.left : -c.right;
                    EXPECT_EQ(is_folded_around(segment, vertex, leaving(first, 0.03),
                                               {along, leaving(second, -0.05)}, kReach),
                              c.is_folded)
                        << c.name << ", seed " << seed;
                    EXPECT_FALSE(
                        is_folded_around(segment, vertex, along, {leaving(first, 0.0), along}, kReach))
                        << c.name << ", seed " << seed;
                }
            }
}

// Edges along the fold are on neither side, also where the fold's next vertices are nearer to the wire.
TEST(IsFoldedAround, DoesNotTakeTheFoldForOneOfItsSides)
{
    for (unsigned seed = 0; seed < 20; ++seed) {
        const Wire wire(seed, 3.0);
        const std::array<Vec3, 2> segment = {wire.point - wire.tangent(), wire.point + wire.tangent()};
        const Vec3 vertex = wire.vertex();
        const Vec3 side = vertex + 0.1 * (wire.at(0.3, 1.0) - wire.point);
        std::vector<Vec3> around = {side};
        for (const double along : {-0.1, 0.1})
            around.push_back(wire.point + along * wire.tangent() + 0.9 * kHeight * wire.outward(0.05));
        EXPECT_FALSE(is_folded_around(segment, vertex, side, around, 2.5 * kHeight)) << "seed " << seed;
    }
}

// An angle of 0 is straight down; the wire is at 0 as seen from the vertex.
TEST(IsFoldedBeside, HoldsWhereAllSidesLeaveToOneSideOfTheWire)
{
    struct Case {
        const char* name;
        double first, second;  // rad
        bool is_beside;
    };
    for (const Case& c : {Case{"around", 0.01, -0.01, false},
                          {"flat", M_PI / 2.0, -M_PI / 2.0, false},
                          {"flat, the wire ahead", 0.3, 0.3 - M_PI + 1e-3, false},
                          {"beside", 0.2, 0.21, true},
                          {"beside, on the other side", -0.2, -0.7, true}})
        for (unsigned seed = 0; seed < 20; ++seed) {
            const Wire wire(seed, 3.0);
            const std::array<Vec3, 2> segment = {wire.point - wire.tangent(), wire.point + wire.tangent()};
            const Vec3 vertex = wire.vertex();
            std::vector<Vec3> around = {vertex + 0.1 * wire.tangent() + 0.01 * kHeight * wire.outward(1.0),
                                        vertex - 0.1 * wire.tangent() - 0.01 * kHeight * wire.outward(1.0)};
            for (const double angle : {c.first, c.second})
                around.push_back(vertex + 0.1 * (wire.at(angle, 1.0) - wire.point) + 0.03 * wire.tangent());
            EXPECT_EQ(is_folded_beside(segment, vertex, around), c.is_beside) << c.name << ", seed " << seed;
        }
}

TEST(AngleBehind, IsTheAngleAroundTheWireWhereverThatIs)
{
    for (unsigned seed = 0; seed < 20; ++seed) {
        const Wire wire(seed);
        const double sign = angle_behind(wire.frame(), wire.at(0.3, 1.0)) > 0.0 ? 1.0 : -1.0;
        for (const double angle : {-3.1, -1.6, -0.2, -1e-9, 0.0, 1e-9, 0.2, 1.6, 3.1})
            for (const double way : {1e-6, 0.1, 1e3})
                EXPECT_NEAR(sign * angle_behind(wire.frame(), wire.at(angle, way, 0.7)), angle,
                            kRoundOff / way);
    }
}

TEST(TurnOutward, GoesHalfOfWhatIsMissingAtABoundedSpeed)
{
    const Wire wire(1);
    for (const double angle : {-3.0, -0.4, -0.01, 0.0, 0.01, 0.4, 3.0})
        for (const double dt : {0.0, 1e-6, 1e-3, 1.0}) {
            const Vec3 turned = turn_outward(wire.frame(angle), wire.vertex(), {}, dt);
            const double wanted =
                std::min(0.5 * std::abs(wire.turned(wire.outward(angle))), kSpeed * dt / kHeight);
            EXPECT_NEAR(turned.norm(), 1.0, kRoundOff);
            EXPECT_NEAR(turned.dot(wire.tangent()), 0.0, kRoundOff);
            EXPECT_NEAR(std::abs(wire.turned(turned)), wanted, kRoundOff) << angle << ' ' << dt;
            EXPECT_GE(wire.turned(turned) * wire.turned(wire.outward(angle)), -kRoundOff);
        }
}

TEST(TurnOutward, OnTheWiresVeryLineIsWhatIsWanted)
{
    const Wire wire(2);
    EXPECT_EQ(turn_outward(wire.frame(0.4), wire.point, {}, 0.0), wire.outward(0.4));
    EXPECT_EQ(turn_outward(wire.frame(0.4), wire.point + wire.tangent(), {}, 0.0), wire.outward(0.4));
}

TEST(TurnOutward, StaysOffTheClothsSides)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    for (unsigned trial = 0; trial < 2000; ++trial) {
        const Wire wire(trial, trial % 3 == 0 ? 1e3 : 0.0);
        // Sides that are nearly closed, wide open, or nearer to the plane than allowed.
        const double width = std::pow(10.0, 4.0 * any(random) - 3.5);
        std::vector<Vec3> beside;
        for (int k = 0; k < 5; ++k)
            beside.push_back(wire.at(any(random) * std::min(width, 3.0), 0.1, any(random)));
        const double wanted = 3.0 * any(random);
        const Vec3 turned = turn_outward(wire.frame(wanted), wire.vertex(), beside, 1.0);
        const FeatureFrame before = wire.frame();
        FeatureFrame after = before;
        after.outward = turned;
        for (const Vec3& w : beside) {
            const double was = angle_behind(before, w), is = angle_behind(after, w);
            if (std::abs(was - is) > 3.0) continue;  // passed the discontinuity at the wire's front
            EXPECT_GE(was * is, 0.0) << "to the other side";
            EXPECT_GE(std::abs(is), std::min(std::abs(was), kLeast) - 1e-9) << was << " rad before";
        }
    }
}

/// Least distance between the wire and the edge from the vertex to the place `begin`, moved onto its bound;
/// over the vertex's height.
double find_nearest(const FoldPlaneBound& bound, const Wire& wire, const Vec3& begin, double height)
{
    const Vec3 kept = begin - (bound.normal.dot(begin - wire.point) - bound.least_gap) * bound.normal;
    const Vec3 reach = 10.0 * wire.tangent();
    const SegmentPair pair =
        closest_between_segments({wire.vertex(height), kept}, {wire.point - reach, wire.point + reach});
    return (pair.first - pair.second).norm() / height;
}

TEST(FoldPlaneBound, KeepsTheEdgeOffTheWire)
{
    std::mt19937 random(4);
    std::uniform_real_distribution<double> any(0.0, 1.0);
    for (unsigned trial = 0; trial < 1000; ++trial) {
        const Wire wire(trial);
        const double height = std::pow(10.0, -4.0 + 2.0 * any(random)), angle = kLeast + any(random);
        for (const int side : {1, -1}) {
            const Vec3 begin = wire.at(side * angle, 0.01 + any(random), any(random));
            const int told = angle_behind(wire.frame(), begin) > 0.0 ? 1 : -1;
            const FoldPlaneBound bound = find_fold_plane_bound(wire.frame(), begin, told);
            EXPECT_GT(bound.least_gap, 0.0);
            EXPECT_EQ(bound.least_gap, bound.wanted);
            const double below = -wire.outward().dot(begin - wire.point);
            EXPECT_GT(find_nearest(bound, wire, begin, height), 0.9 * kLeast * below / (below + height));
        }
    }
}

TEST(FoldPlaneBound, LetsWhatIsNearerGetNoNearer)
{
    const Wire wire(5);
    // Angles over the least angle; negative: on the wrong side.
    for (const double share : {0.5, 1e-3, -0.5, -20.0}) {
        const Vec3 begin = wire.at(share * kLeast, 0.1);
        const int side = angle_behind(wire.frame(), wire.at(0.1, 0.1)) > 0.0 ? 1 : -1;
        const FoldPlaneBound bound = find_fold_plane_bound(wire.frame(), begin, side);
        EXPECT_NEAR(bound.least_gap, 0.1 * std::sin(share * kLeast), kRoundOff);
        EXPECT_NEAR(bound.wanted, kLeast * 0.1 * std::cos(share * kLeast), kRoundOff);
    }
    // There is no fold plane in front of the wire.
    EXPECT_EQ(find_fold_plane_bound(wire.frame(), wire.at(2.0, 0.1), 1).wanted, 0.0);
}

}  // namespace
}  // namespace arris
