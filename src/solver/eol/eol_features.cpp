// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/eol/eol_features.h"

#include <optional>

#include "geometry/sort_unique.h"

namespace arris {

bool is_fixed(const EolVertex& eol)
{
    return eol.is_corner || eol.turn >= 0;
}

int held_point(const Obstacle& obstacle, const EolVertex& eol)
{
    if (eol.is_corner) return obstacle.features().corners[eol.feature].point;
    return eol.turn >= 0 ? point_at(obstacle, {eol.feature, eol.turn}) : -1;
}

Vec3 feature_tangent(const Obstacle& obstacle, const EolVertex& eol)
{
    if (eol.is_corner) return Vec3::Zero();
    if (eol.turn >= 0) return tangent_at(obstacle, {eol.feature, eol.turn});
    const auto& ends = obstacle.topology().edges[obstacle.features().edges[eol.feature].edge].points;
    return (obstacle.mesh().points[ends[1]] - obstacle.mesh().points[ends[0]]).normalized();
}

bool is_on_convex_edge(const Obstacle& obstacle, const EolVertex& eol)
{
    return !eol.is_corner && obstacle.features().edges[eol.feature].kind == FeatureKind::Convex;
}

bool is_of_one_strand(const Obstacle& obstacle, const PlacedEol& a, const PlacedEol& b)
{
    constexpr double kSteepest = 0.7;  // a fold that runs off its edge does so at less than 35 degrees
    const bool is_one_edge = a.eol.is_corner == b.eol.is_corner && a.eol.feature == b.eol.feature;
    if (!is_one_edge || !is_on_convex_edge(obstacle, a.eol)) return true;
    const Vec3 on_a = place_on_feature(obstacle, a.eol.feature, a.place).point;
    const Vec3 on_b = place_on_feature(obstacle, b.eol.feature, b.place).point;
    return ((a.place - on_a) - (b.place - on_b)).norm() <= kSteepest * (on_a - on_b).norm();
}

bool is_trace_edge(const Obstacle& obstacle, const PlacedEol& a, const PlacedEol& b)
{
    if (a.eol.obstacle != b.eol.obstacle || !is_of_one_strand(obstacle, a, b)) return false;
    if (!a.eol.is_corner && !b.eol.is_corner && a.eol.feature == b.eol.feature) return true;
    constexpr double kLongestWay = 1.2;  // over the distance: an arc that turns by 120 degrees
    const ObstacleFeatures& features = obstacle.features();
    const auto place_of = [&](const PlacedEol& at) {
        return at.eol.is_corner ? obstacle.mesh().points[features.corners[at.eol.feature].point]
                                : place_on_feature(obstacle, at.eol.feature, at.place).point;
    };
    const double most = kLongestWay * (place_of(a) - place_of(b)).norm();
    const auto on = [&](const PlacedEol& at) {
        return FeaturePlace{at.eol.feature, place_on_feature(obstacle, at.eol.feature, at.place).s};
    };
    if (!a.eol.is_corner && !b.eol.is_corner) return distance_along(obstacle, on(a), on(b), most).has_value();
    if (a.eol.is_corner != b.eol.is_corner) {
        const PlacedEol &corner = a.eol.is_corner ? a : b, &other = a.eol.is_corner ? b : a;
        return distance_to_corner(obstacle, on(other), corner.eol.feature, most).has_value();
    }
    const int point = features.corners[a.eol.feature].point;
    const ObstacleTopology& topology = obstacle.topology();
    for (int k = 0; k < topology.edge_count_at(point); ++k) {
        const int edge = topology.edge_at(point, k);
        const int feature = feature_of_edge(features, edge);
        const double s = topology.edges[edge].points[0] == point ? 0.0 : 1.0;
        if (feature >= 0 && distance_to_corner(obstacle, {feature, s}, b.eol.feature, most)) return true;
    }
    return false;
}

std::vector<std::array<int, 2>> find_trace_edges(const std::vector<Obstacle>& obstacles, const State& state,
                                                 const ClothStars& stars)
{
    std::vector<std::array<int, 2>> found;
    std::vector<int> later;  // neighbours
    const auto add_from = [&](int a) {
        const int v = state.index_of(state.eol[a].vertex_id);
        const Obstacle& obstacle = obstacles[static_cast<std::size_t>(state.eol[a].obstacle)];
        later.clear();
        for (const int f : stars.faces[v])
            for (const int w : state.mesh.faces[f])
                if (w > v) later.push_back(w);
        sort_unique(later);
        std::optional<Placement> now;
        for (const int w : later) {
            const int b = state.eol_entry(state.ids[w]);
            if (b < 0) continue;
            if (!now) now = obstacle.at(state.time);
            if (is_trace_edge(obstacle, {state.eol[a], now->inverse(state.mesh.world[v])},
                              {state.eol[b], now->inverse(state.mesh.world[w])}))
                found.push_back({a, b});
        }
    };
    for (int a = 0; a < static_cast<int>(state.eol.size()); ++a) add_from(a);
    return found;
}

void follow_features(const std::vector<Obstacle>& obstacles, State& state)
{
    for (EolVertex& eol : state.eol) {
        if (eol.is_corner || eol.turn >= 0) continue;
        const Obstacle& obstacle = obstacles[eol.obstacle];
        const Vec3& world = state.mesh.world[state.index_of(eol.vertex_id)];
        eol.feature = follow_polyline(obstacle, eol.feature, obstacle.at(state.time).inverse(world)).feature;
    }
}

}  // namespace arris
