// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle/feature_path.h"

#include <algorithm>
#include <limits>
#include <tuple>

#include "geometry/closest_point.h"
#include "geometry/obstacle/feature_nodes.h"
#include "geometry/tolerances.h"

namespace arris {
namespace {

double length_of(const Obstacle& obstacle, int feature)
{
    const auto [a, b] = feature_segment(obstacle, feature);
    return (b - a).norm();
}

/// Unit vector from the edge's first point to its second.
Vec3 direction_of(const Obstacle& obstacle, int feature)
{
    const auto [a, b] = feature_segment(obstacle, feature);
    return (b - a).normalized();
}

/// The edge that follows in the same polyline beyond end `end` (0 or 1) of edge `feature`, and which of its
/// own ends lies there.
struct Step {
    int feature, end;
};
std::optional<Step> across(const Obstacle& obstacle, int feature, int end)
{
    const ObstacleTopology& topology = obstacle.topology();
    const ObstacleFeatures& features = obstacle.features();
    const FeatureEdge& from = features.edges[feature];
    const int point = topology.edges[from.edge].points[end];
    if (is_corner(features, point)) return std::nullopt;
    for (int k = 0; k < topology.edge_count_at(point); ++k) {
        const int edge = topology.edge_at(point, k);
        if (edge == from.edge) continue;
        const int other = feature_of_edge(features, edge);
        if (other >= 0 && features.edges[other].polyline == from.polyline)
            return Step{other, topology.edges[edge].points[0] == point ? 0 : 1};
    }
    return std::nullopt;
}

/// Walks from `place` past end `end` of its edge, over a length of at most `reach` and at most once around a
/// closed polyline.
template <typename Visit>
void walk(const Obstacle& obstacle, const FeaturePlace& place, int end, double reach, const Visit& visit)
{
    int feature = place.feature;
    double s = place.s;
    for (std::size_t count = 0; count <= obstacle.features().edges.size(); ++count) {
        const double length = length_of(obstacle, feature);
        const double left = (end == 1 ? 1.0 - s : s) * length;
        const double share = length > 0.0 ? std::min(left, reach) / length : 0.0;
        const double to = reach >= left ? end : end == 1 ? s + share : s - share;
        if (!visit(feature, s, to)) return;
        reach -= left;
        if (!(reach > 0.0)) return;
        const std::optional<Step> next = across(obstacle, feature, end);
        if (!next || next->feature == place.feature) return;
        feature = next->feature;
        s = next->end;
        end = 1 - next->end;
    }
}

}  // namespace

std::array<Vec3, 2> feature_segment(const Obstacle& obstacle, int feature)
{
    const auto& ends = obstacle.topology().edges[obstacle.features().edges[feature].edge].points;
    return {obstacle.mesh().points[ends[0]], obstacle.mesh().points[ends[1]]};
}

PointOnFeature place_on_feature(const Obstacle& obstacle, int feature, const Vec3& place)
{
    const auto [a, b] = feature_segment(obstacle, feature);
    const double s = closest_on_segment(place, a, b);
    return {s, a + s * (b - a)};
}

Vec3 way_across(const Obstacle& obstacle, int feature, const Vec3& place)
{
    const Vec3 along = direction_of(obstacle, feature);
    const Vec3 from = place - feature_segment(obstacle, feature)[0];
    return from - along.dot(from) * along;
}

double length_past_end(const Obstacle& obstacle, int feature, const Vec3& place)
{
    const int end = end_passed(obstacle, feature, place);
    if (end < 0 || obstacle.features().edges[feature].kind != FeatureKind::Wire) return 0.0;
    return std::abs(direction_of(obstacle, feature).dot(place - obstacle.mesh().points[end]));
}

FeaturePlace follow_polyline(const Obstacle& obstacle, int feature, const Vec3& place)
{
    const auto look_at = [&](int f) {
        const PointOnFeature nearest = place_on_feature(obstacle, f, place);
        return std::pair(nearest.s, (place - nearest.point).norm());
    };
    auto [s, distance] = look_at(feature);
    for (std::size_t count = 0; count < obstacle.features().edges.size(); ++count) {
        if (s > 0.0 && s < 1.0) break;
        const std::optional<Step> next = across(obstacle, feature, s > 0.0 ? 1 : 0);
        if (!next) break;
        const auto [next_s, next_distance] = look_at(next->feature);
        if (!(next_distance < distance)) break;
        feature = next->feature;
        s = next_s;
        distance = next_distance;
    }
    return {feature, s};
}

int end_passed(const Obstacle& obstacle, int feature, const Vec3& place)
{
    const double s = place_on_feature(obstacle, feature, place).s;
    if (s > 0.0 && s < 1.0) return -1;
    const ObstacleFeatures& features = obstacle.features();
    const int end = obstacle.topology().edges[features.edges[feature].edge].points[s > 0.0 ? 1 : 0];
    return is_corner(features, end) ? end : -1;
}

bool is_past_end(const Obstacle& obstacle, int feature, const Vec3& place)
{
    return end_passed(obstacle, feature, place) >= 0;
}

std::optional<FeatureBend> find_bend(const Obstacle& obstacle, int point)
{
    const ObstacleTopology& topology = obstacle.topology();
    const ObstacleFeatures& features = obstacle.features();
    for (int k = 0; k < topology.edge_count_at(point); ++k) {
        const int edge = topology.edge_at(point, k);
        const int feature = feature_of_edge(features, edge);
        if (feature < 0 || features.edges[feature].kind != FeatureKind::Wire) continue;
        const int end = topology.edges[edge].points[0] == point ? 0 : 1;
        const std::optional<Step> next = across(obstacle, feature, end);
        if (!next) continue;
        const Vec3 sine = direction_of(obstacle, feature).cross(direction_of(obstacle, next->feature));
        if (sine.norm() > kParallel) return FeatureBend{feature, end};
    }
    return std::nullopt;
}

double missed_by_chord(const Obstacle& obstacle, const FeatureBend& bend, double reach)
{
    const std::optional<Step> next = across(obstacle, bend.feature, bend.end);
    if (!next || std::min(length_of(obstacle, bend.feature), length_of(obstacle, next->feature)) < reach)
        return 0.0;
    // The tangent lies halfway between the two edges, so the angle between either edge and the tangent is
    // half the bend angle.
    return reach * direction_of(obstacle, bend.feature).cross(tangent_at(obstacle, bend)).norm();
}

int point_at(const Obstacle& obstacle, const FeatureBend& bend)
{
    return obstacle.topology().edges[obstacle.features().edges[bend.feature].edge].points[bend.end];
}

Vec3 bend_point(const Obstacle& obstacle, const FeatureBend& bend)
{
    return feature_segment(obstacle, bend.feature)[bend.end];
}

Vec3 tangent_at(const Obstacle& obstacle, const FeatureBend& bend)
{
    const Vec3 way = direction_of(obstacle, bend.feature);
    const std::optional<Step> next = across(obstacle, bend.feature, bend.end);
    if (!next) return way;
    const Vec3 onward = direction_of(obstacle, next->feature);
    return (way + (next->end == bend.end ? Vec3(-onward) : onward)).normalized();
}

std::optional<double> distance_along(const Obstacle& obstacle, const FeaturePlace& a, const FeaturePlace& b,
                                     double most)
{
    const std::vector<FeatureEdge>& edges = obstacle.features().edges;
    if (edges[a.feature].polyline != edges[b.feature].polyline) return std::nullopt;
    double least = std::numeric_limits<double>::infinity();
    for (const int end : {0, 1}) {
        double walked = 0.0;
        walk(obstacle, a, end, most, [&](int feature, double from, double to) {
            const double length = length_of(obstacle, feature);
            if (feature == b.feature && b.s >= std::min(from, to) && b.s <= std::max(from, to)) {
                least = std::min(least, walked + std::abs(b.s - from) * length);
                return false;
            }
            walked += std::abs(to - from) * length;
            return true;
        });
    }
    return least <= most ? std::optional(least) : std::nullopt;
}

std::optional<double> distance_to_corner(const Obstacle& obstacle, const FeaturePlace& a, int corner,
                                         double most)
{
    const int point = obstacle.features().corners[corner].point;
    double least = std::numeric_limits<double>::infinity();
    for (const int end : {0, 1}) {
        double walked = 0.0;
        walk(obstacle, a, end, most, [&](int feature, double from, double to) {
            const auto& ends = obstacle.topology().edges[obstacle.features().edges[feature].edge].points;
            walked += std::abs(to - from) * length_of(obstacle, feature);
            if ((to <= 0.0 && ends[0] == point) || (to >= 1.0 && ends[1] == point))
                least = std::min(least, walked);
            return true;
        });
    }
    return least <= most ? std::optional(least) : std::nullopt;
}

Polyline trace_polyline(const Obstacle& obstacle, int polyline)
{
    const std::vector<FeatureEdge>& edges = obstacle.features().edges;
    const auto seed = std::find_if(edges.begin(), edges.end(),
                                   [&](const FeatureEdge& e) { return e.polyline == polyline; });
    Polyline traced;
    if (seed == edges.end()) return traced;
    // Go back to the polyline's first edge, or once around if it is closed.
    const int first = static_cast<int>(seed - edges.begin());
    Step at{first, 1};  // the current edge, and the end at which the polyline continues
    for (std::optional<Step> before = across(obstacle, first, 0); before;
         before = across(obstacle, at.feature, 1 - at.end)) {
        if (before->feature == first) {
            traced.is_closed = true;
            at = {first, 1};
            break;
        }
        at = *before;
    }
    const int begin = at.feature;
    while (true) {
        traced.edges.push_back({at.feature, at.end == 1, traced.length});
        traced.length += length_of(obstacle, at.feature);
        const std::optional<Step> next = across(obstacle, at.feature, at.end);
        if (!next || next->feature == begin) return traced;
        at = {next->feature, 1 - next->end};
    }
}

int feature_of_edge(const ObstacleFeatures& features, int edge)
{
    const auto found = std::lower_bound(features.edges.begin(), features.edges.end(), edge,
                                        [](const FeatureEdge& f, int e) { return f.edge < e; });
    return found != features.edges.end() && found->edge == edge
               ? static_cast<int>(found - features.edges.begin())
               : -1;
}

}  // namespace arris
