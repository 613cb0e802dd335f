// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/eol/eol_features.h"

#include <limits>
#include <optional>

#include "geometry/sort_unique.h"

namespace arris {

int fixed_point(const Obstacle& obstacle, const EolVertex& eol)
{
    if (eol.on.is_corner()) return obstacle.features().corners[eol.on.index].point;
    return eol.on.is_bend() ? point_at(obstacle, {eol.on.index, eol.on.end}) : -1;
}

Vec3 feature_tangent(const Obstacle& obstacle, const EolVertex& eol)
{
    if (eol.on.is_corner()) return Vec3::Zero();
    if (eol.on.is_bend()) return tangent_at(obstacle, {eol.on.index, eol.on.end});
    const auto& ends = obstacle.topology().edges[obstacle.features().edges[eol.on.index].edge].points;
    return (obstacle.mesh().points[ends[1]] - obstacle.mesh().points[ends[0]]).normalized();
}

bool is_on_convex_edge(const Obstacle& obstacle, const EolVertex& eol)
{
    return !eol.on.is_corner() && obstacle.features().edges[eol.on.index].kind == FeatureKind::Convex;
}

bool is_of_one_strand(const Obstacle& obstacle, const PlacedEol& a, const PlacedEol& b)
{
    constexpr double kSteepest = 0.7;  // tangent: a fold runs off its edge at less than 35 degrees
    const bool is_one_edge = a.eol.on.is_corner() == b.eol.on.is_corner() && a.eol.on.index == b.eol.on.index;
    if (!is_one_edge || !is_on_convex_edge(obstacle, a.eol)) return true;
    const Vec3 on_a = place_on_feature(obstacle, a.eol.on.index, a.place).point;
    const Vec3 on_b = place_on_feature(obstacle, b.eol.on.index, b.place).point;
    return ((a.place - on_a) - (b.place - on_b)).norm() <= kSteepest * (on_a - on_b).norm();
}

namespace {

Vec3 point_on_feature(const Obstacle& obstacle, const PlacedEol& at)
{
    return at.eol.on.is_corner() ? obstacle.mesh().points[obstacle.features().corners[at.eol.on.index].point]
                                 : place_on_feature(obstacle, at.eol.on.index, at.place).point;
}

/// Whether one feature joins two corners by a length of at most `most`, m.
bool are_corners_joined(const Obstacle& obstacle, int a, int b, double most)
{
    const ObstacleFeatures& features = obstacle.features();
    const ObstacleTopology& topology = obstacle.topology();
    const int point = features.corners[a].point;
    for (int k = 0; k < topology.edge_count_at(point); ++k) {
        const int edge = topology.edge_at(point, k);
        const int feature = feature_of_edge(features, edge);
        if (feature < 0) continue;
        const double s = topology.edges[edge].points[0] == point ? 0.0 : 1.0;
        if (distance_to_corner(obstacle, {feature, s}, b, most)) return true;
    }
    return false;
}

/// Whether one polyline, with its ends, joins two vertices by a length of at most `most`, m.
bool are_joined(const Obstacle& obstacle, const PlacedEol& a, const PlacedEol& b, double most)
{
    const auto on = [&](const PlacedEol& at) {
        return FeaturePlace{at.eol.on.index, place_on_feature(obstacle, at.eol.on.index, at.place).s};
    };
    if (a.eol.on.is_corner() && b.eol.on.is_corner())
        return are_corners_joined(obstacle, a.eol.on.index, b.eol.on.index, most);
    if (a.eol.on.is_corner()) return distance_to_corner(obstacle, on(b), a.eol.on.index, most).has_value();
    if (b.eol.on.is_corner()) return distance_to_corner(obstacle, on(a), b.eol.on.index, most).has_value();
    return distance_along(obstacle, on(a), on(b), most).has_value();
}

}  // namespace

bool is_trace_edge(const Obstacle& obstacle, const PlacedEol& a, const PlacedEol& b)
{
    constexpr double kLongestWay = 1.2;  // length over distance of an arc that bends by 120 degrees
    if (a.eol.on.obstacle != b.eol.on.obstacle || !is_of_one_strand(obstacle, a, b)) return false;
    const bool is_one_edge =
        !a.eol.on.is_corner() && !b.eol.on.is_corner() && a.eol.on.index == b.eol.on.index;
    const double most =
        is_one_edge ? std::numeric_limits<double>::infinity()
                    : kLongestWay * (point_on_feature(obstacle, a) - point_on_feature(obstacle, b)).norm();
    return are_joined(obstacle, a, b, most);
}

std::vector<std::array<int, 2>> find_trace_edges(const std::vector<MovingObstacle>& obstacles,
                                                 const State& state, const ClothStars& stars)
{
    std::vector<std::array<int, 2>> found;
    std::vector<int> later;  // neighbours
    const auto add_from = [&](int a) {
        const int v = state.index_of(state.eol[a].vertex_id);
        const ObstaclePose obstacle =
            obstacles[static_cast<std::size_t>(state.eol[a].on.obstacle)].at(state.time);
        later.clear();
        for (const int f : stars.faces[v])
            for (const int w : state.mesh.faces[f])
                if (w > v) later.push_back(w);
        sort_unique(later);
        std::optional<Placement> now;
        for (const int w : later) {
            const int b = state.eol_entry(state.ids[w]);
            if (b < 0) continue;
            if (!now) now = obstacle.placement;
            if (is_trace_edge(obstacle, {state.eol[a], now->inverse(state.mesh.world[v])},
                              {state.eol[b], now->inverse(state.mesh.world[w])}))
                found.push_back({a, b});
        }
    };
    for (int a = 0; a < static_cast<int>(state.eol.size()); ++a) add_from(a);
    return found;
}

void follow_features(const std::vector<MovingObstacle>& obstacles, State& state)
{
    for (EolVertex& eol : state.eol) {
        if (eol.on.is_fixed()) continue;
        const ObstaclePose obstacle = obstacles[eol.on.obstacle].at(state.time);
        const Vec3& world = state.mesh.world[state.index_of(eol.vertex_id)];
        eol.on.index = follow_polyline(obstacle, eol.on.index, obstacle.placement.inverse(world)).feature;
    }
}

}  // namespace arris
