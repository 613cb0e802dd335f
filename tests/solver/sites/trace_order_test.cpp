// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/sites/trace_order.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "geometry/obstacle_input/obstacle_shapes.h"
#include "solver/eol/eol_features.h"

namespace arris {
namespace {

using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

struct Trace {
    std::vector<MovingObstacle> obstacles;
    std::vector<EolVertex> eol;
    std::vector<Vec3> places;

    void add(std::uint32_t id, bool is_corner, int feature, const Vec3& place, int obstacle = 0)
    {
        eol.push_back({id,
                       is_corner ? FeatureId::corner(obstacle, feature) : FeatureId::edge(obstacle, feature),
                       {0, 0, 1},
                       0});
        places.push_back(place);
    }

    /// Pairs of vertex ids, the lower id first.
    Pairs neighbours() const
    {
        std::vector<PlacedEol> placed;
        for (std::size_t k = 0; k < eol.size(); ++k) placed.push_back({eol[k], places[k]});
        Pairs found;
        for (const auto& [a, b] : find_trace_neighbours(obstacles, 0.0, placed))
            EXPECT_TRUE(found.insert(std::minmax(a->vertex_id, b->vertex_id)).second);
        return found;
    }
};

int corner_at_x(const Obstacle& obstacle, double x)
{
    const std::vector<FeatureCorner>& corners = obstacle.features().corners;
    for (std::size_t c = 0; c < corners.size(); ++c)
        if (obstacle.mesh().points[corners[c].point].x() == x) return static_cast<int>(c);
    ADD_FAILURE() << "no corner at " << x;
    return -1;
}

MovingObstacle wire(const std::vector<Vec3>& points, bool is_closed)
{
    return MovingObstacle("wire", make_wire(points, is_closed), {}, {}, 30.0);
}

TEST(TraceOrder, FollowsALineOfSegmentsFromCornerToCornerWhateverTheOrderTheyCameIn)
{
    Trace trace;
    trace.obstacles.push_back(wire({{0, 0, 0}, {1, 0, 0}, {2, 0.1, 0}, {3, 0.1, 0}}, false));
    trace.add(7, false, 2, {2.5, 0.1, 0});
    trace.add(3, false, 0, {0.9, 0, 0});
    trace.add(9, true, corner_at_x(trace.obstacles[0].shape(), 3.0), {3, 0.1, 0});
    trace.add(4, false, 0, {0.2, 0, 0});
    trace.add(1, true, corner_at_x(trace.obstacles[0].shape(), 0.0), {0, 0, 0});
    trace.add(8, false, 1, {1.4, 0.04, 0});
    EXPECT_EQ(trace.neighbours(), (Pairs{{1, 4}, {3, 4}, {3, 8}, {7, 8}, {7, 9}}));
}

TEST(TraceOrder, OfAClosedLineTheLastIsBesideTheFirst)
{
    std::vector<Vec3> points;
    for (int k = 0; k < 12; ++k) points.emplace_back(std::cos(M_PI * k / 6.0), std::sin(M_PI * k / 6.0), 0.0);
    Trace trace;
    trace.obstacles.push_back(wire(points, true));
    const auto add = [&](std::uint32_t id, int feature) {
        const auto& ends = trace.obstacles[0]
                               .shape()
                               .topology()
                               .edges[trace.obstacles[0].shape().features().edges[feature].edge]
                               .points;
        const std::vector<Vec3>& at = trace.obstacles[0].shape().mesh().points;
        trace.add(id, false, feature, 0.5 * (at[ends[0]] + at[ends[1]]));
    };
    add(1, 3);
    EXPECT_TRUE(trace.neighbours().empty());
    add(2, 8);
    EXPECT_EQ(trace.neighbours(), (Pairs{{1, 2}})) << "two are neighbours once";
    add(3, 10);
    EXPECT_EQ(trace.neighbours(), (Pairs{{1, 2}, {2, 3}, {1, 3}}));
}

TEST(TraceOrder, AFoldThatHasFlownOffAnEdgeAndTheTraceBehindItAreNotMixed)
{
    Trace trace;
    trace.obstacles.emplace_back("table", make_box(Vec3(2, 2, 2)), Placement{}, RigidMotion{}, 30.0);
    const ObstacleFeatures& features = trace.obstacles[0].shape().features();
    int along_y = -1;  // at x = z = 1
    for (std::size_t f = 0; f < features.edges.size(); ++f) {
        const auto& ends = trace.obstacles[0].shape().topology().edges[features.edges[f].edge].points;
        const std::vector<Vec3>& at = trace.obstacles[0].shape().mesh().points;
        if ((0.5 * (at[ends[0]] + at[ends[1]]) - Vec3(1, 0, 1)).norm() < 1e-9) along_y = static_cast<int>(f);
    }
    ASSERT_GE(along_y, 0);
    for (const double off : {0.0, 0.06, 0.5, 5.0}) {
        trace.eol.clear();
        trace.places.clear();
        for (const int k : {0, 1, 2, 3}) {
            trace.add(10 + k, false, along_y, {1, 0.1 * k, 1});
            trace.add(20 + k, false, along_y, {1 + off, 0.1 * k + 0.04, 1});
        }
        const Pairs one = {{10, 20}, {11, 20}, {11, 21}, {12, 21}, {12, 22}, {13, 22}, {13, 23}};
        const Pairs two = {{10, 11}, {11, 12}, {12, 13}, {20, 21}, {21, 22}, {22, 23}};
        EXPECT_EQ(trace.neighbours(), off > 0.0 ? two : one) << off;
    }
    // A fold that has partly left its edge, up to 31 degrees from it, is one strand.
    trace.eol.clear();
    trace.places.clear();
    for (const int k : {0, 1, 2, 3})
        trace.add(10 + k, false, along_y, {1 + 0.06 * std::max(k - 1, 0), 0.1 * k, 1});
    EXPECT_EQ(trace.neighbours(), (Pairs{{10, 11}, {11, 12}, {12, 13}}));
}

TEST(TraceOrder, LinesOfOneObstacleOrOfTwoAreNotMixed)
{
    Trace trace;
    for (const double y : {0.0, 1e-6}) trace.obstacles.push_back(wire({{0, y, 0}, {1, y, 0}}, false));
    for (int k = 0; k < 4; ++k) trace.add(k, false, 0, {0.2 + 0.2 * k, 0, 0}, k % 2);
    EXPECT_EQ(trace.neighbours(), (Pairs{{0, 2}, {1, 3}}));
    EXPECT_TRUE(Trace().neighbours().empty());
}

}  // namespace
}  // namespace arris
