// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/sites/edge_crossings.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/closest_point.h"
#include "geometry/obstacle/feature_frame.h"
#include "geometry/obstacle/feature_nodes.h"
#include "geometry/obstacle/feature_path.h"
#include "geometry/obstacle/normal_cone.h"
#include "geometry/sort_unique.h"
#include "geometry/tolerances.h"
#include "solver/eol/eol_features.h"
#include "solver/eol/wire_fold.h"
#include "solver/model/eol_limits.h"
#include "solver/model/target_length.h"
#include "solver/sites/wire_end.h"

namespace arris {

EdgeCrossings::EdgeCrossings(const Scene& scene, const State& state, const ClothStars& stars,
                             std::int32_t obstacle)
    : state_(state),
      stars_(stars),
      moving_(scene.obstacles[obstacle]),
      obstacle_(scene.obstacles[obstacle].at(state.time)),
      o_(obstacle),
      thickness_(scene.materials.thickness()),
      target_(surgery_target(scene, state)),
      positions_(to_local(obstacle_.placement, state.mesh.world))
{
}

std::optional<FeatureSite> EdgeCrossings::find(int a, int b, int feature, const Vec3& normal) const
{
    return find(a, b, feature, normal, {kOnSurface, kOnFeature * thickness_});
}

std::optional<FeatureSite> EdgeCrossings::find_past_end(int a, int b, int feature, const Vec3& normal) const
{
    const auto site = find(a, b, feature, normal, {kOnSurface, kOnFeature * thickness_, true});
    return site && is_past_end(feature, *site) ? site : std::nullopt;
}

std::optional<FeatureSite> EdgeCrossings::find_pressed(int a, int b, int feature, const Vec3& normal) const
{
    const double height = kOnFeature * thickness_ + find_rise(a, b, feature, normal);
    for (const double in_plane : {kOnSurface, kOffPlane})
        if (const auto crossing = find(a, b, feature, normal, {in_plane, height})) return crossing;
    return find_beyond_end(a, b, feature, normal);
}

std::vector<int> EdgeCrossings::neighbours(int vertex) const
{
    std::vector<int> found;
    for (const int f : stars_.faces[vertex])
        for (const int w : state_.mesh.faces[f])
            if (w != vertex) found.push_back(w);
    sort_unique(found);
    return found;
}

std::optional<FeatureSite> EdgeCrossings::find(int a, int b, int feature, const Vec3& normal,
                                               const Reach& reach) const
{
    if (a > b) std::swap(a, b);
    // Past the end of a wire a trace leads only over a fold, and to the cloth's border.
    const auto is_there = [&](const FeatureSite& site) {
        return reach.is_past_end || site.is_on_border || !is_past_end(feature, site);
    };
    if (const auto fold = find_fold_around(a, b, feature)) {
        const auto site = find_on_fold(*fold, feature);
        return site && is_there(*site) ? site : std::nullopt;
    }
    const std::optional<double> s = find_share(a, b, feature, reach);
    if (!s || (*s == 0.0 && is_eol(a)) || (*s == 1.0 && is_eol(b))) return std::nullopt;
    const Vec2 X = blend_material(state_.mesh, stars_, std::array{a, b}, std::array{1.0 - *s, *s});
    if (is_beside_fold(a, b, feature, X)) return std::nullopt;
    const int near = *s == 0.0   ? a
                     : *s == 1.0 ? b
                                 : find_nearest(stars_, std::array{b, a}, std::array{*s, 1.0 - *s});
    FeatureSite site = {FeatureId::edge(o_, feature), X, state_.ids[near], normal};
    site.edge = {*s < 1.0 ? a : b, *s > 0.0 ? b : a};
    site.is_on_border = site.edge[0] == site.edge[1] ? stars_.is_on_border(site.edge[0])
                                                     : is_border_edge(state_.mesh, stars_, site.edge[0], b);
    return is_there(site) ? std::optional(site) : std::nullopt;
}

/// The feature near vertex `v` of the cloth, with the line that goes on past an end of a wire.
std::array<Vec3, 2> EdgeCrossings::segment_at(int v, int feature) const
{
    std::array<Vec3, 2> segment = feature_segment(obstacle_, feature);
    const Vec3 along = (segment[1] - segment[0]).normalized();
    for (const int end : {0, 1}) {
        const double reach = reach_past_end(obstacle_, feature, point_at(obstacle_, {feature, end}),
                                            thickness_, target_.length(state_.mesh.material[v]));
        segment[end] += (end == 1 ? reach : -reach) * along;
    }
    return segment;
}

Vec3 EdgeCrossings::place_of(const FeatureSite& site) const
{
    return place_of_site(state_.mesh, stars_, site, positions_);
}

bool EdgeCrossings::is_past_end(int feature, const FeatureSite& site) const
{
    return arris::is_past_end(obstacle_, feature, place_of(site));
}

/// Site on a fold of the cloth around a wire or border. Each side of the fold has a nearest point of its own,
/// a little way from the fold. A vertex there would be in cloth that does not bend there, and would leave the
/// fold itself to constraints.
std::optional<FeatureSite> EdgeCrossings::find_on_fold(const FoldEnd& fold, int feature) const
{
    const int v = fold.vertex;
    if (is_eol(v)) return std::nullopt;
    FeatureSite site = {FeatureId::edge(o_, feature), state_.mesh.material[v], state_.ids[v],
                        fold.from.stableNormalized()};
    site.edge = {v, v};
    site.is_on_border = stars_.is_on_border(v);
    site.is_on_fold = true;
    return site;
}

/// Share of the edge, from a (0) to b (1), at which it crosses.
std::optional<double> EdgeCrossings::find_share(int a, int b, int feature, const Reach& reach) const
{
    const std::array<Vec3, 2> segment = segment_at(a, feature);
    const SegmentPair nearest = closest_between_segments({positions_[a], positions_[b]}, segment);
    const FeatureEdge& edge = obstacle_->features().edges[feature];
    if (edge.kind != FeatureKind::Convex) {
        const bool is_near = (nearest.first - nearest.second).norm() <= kOnFeature * thickness_;
        const auto& ends = obstacle_->topology().edges[edge.edge].points;
        const bool is_at_corner = (nearest.t <= 0.0 && is_corner(obstacle_->features(), ends[0])) ||
                                  (nearest.t >= 1.0 && is_corner(obstacle_->features(), ends[1]));
        if (!is_near || is_at_corner) return std::nullopt;
        return nearest.s;
    }
    const std::optional<FeatureFrame> frame =
        find_edge_frame(obstacle_, feature, nearest.second, {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()});
    const Vec3 across = frame->tangent.cross(frame->outward);
    const double of_a = across.dot(positions_[a] - frame->point);
    const double of_b = across.dot(positions_[b] - frame->point);
    const bool is_at_a = std::abs(of_a) <= reach.in_plane * thickness_;
    const bool is_at_b = std::abs(of_b) <= reach.in_plane * thickness_;
    if (!is_at_a && !is_at_b && (of_a > 0.0) == (of_b > 0.0)) return std::nullopt;
    const double s = is_at_a ? 0.0 : is_at_b ? 1.0 : of_a / (of_a - of_b);
    const Vec3 place = (1.0 - s) * positions_[a] + s * positions_[b];
    const double height = frame->outward.dot(place - frame->point);
    const double along = closest_on_segment(place, segment[0], segment[1]);
    if (!(height >= 0.0 && height <= reach.height && along > 0.0 && along < 1.0)) return std::nullopt;
    return s;
}

/// End of the cloth's edge at which the cloth is folded around a wire or border. Only so near to it that a
/// vertex on the wire would crowd the fold.
std::optional<EdgeCrossings::FoldEnd> EdgeCrossings::find_fold_around(int a, int b, int feature) const
{
    if (obstacle_->features().edges[feature].kind == FeatureKind::Convex) return std::nullopt;
    const std::array<Vec3, 2> segment = segment_at(a, feature);
    for (const auto& [end, other] : {std::pair(a, b), std::pair(b, a)}) {
        const double along = closest_on_segment(positions_[end], segment[0], segment[1]);
        const Vec3 from = positions_[end] - (segment[0] + along * (segment[1] - segment[0]));
        const double reach =
            std::max(kOnFeature * thickness_, kCrowded * target_.length(state_.mesh.material[end]));
        if (!(along > 0.0 && along < 1.0 && from.norm() <= reach)) continue;
        std::vector<Vec3> around;
        for (const int w : neighbours(end)) around.push_back(positions_[w]);
        if (is_folded_around(segment, positions_[end], positions_[other], around, kOnFeature * thickness_))
            return FoldEnd{end, from};
    }
    return std::nullopt;
}

/// Whether a wire or border presses at X from outside on a fold of the cloth, at an end of its edge. A vertex
/// on the wire would take the fold's place, though the fold does not hang on the wire.
bool EdgeCrossings::is_beside_fold(int a, int b, int feature, const Vec2& X) const
{
    if (obstacle_->features().edges[feature].kind == FeatureKind::Convex) return false;
    const std::array<Vec3, 2> segment = segment_at(a, feature);
    const std::array<int, 2> ends = {a, b};
    return std::any_of(ends.begin(), ends.end(), [&](int end) {
        const Vec2& at = state_.mesh.material[end];
        if (!((X - at).norm() < kCrowded * target_.length(at))) return false;
        std::vector<Vec3> around;
        for (const int w : neighbours(end)) around.push_back(positions_[w]);
        return is_folded_beside(segment, positions_[end], around);
    });
}

/// Height, m, by which an edge of the cloth that pressed along `normal` may have risen over the feature. The
/// point that touched keeps its gap, while the edge has slid along and turned since.
double EdgeCrossings::find_rise(int a, int b, int feature, const Vec3& normal) const
{
    const auto [from, to] = feature_segment(obstacle_, feature);
    const SegmentPair nearest = closest_between_segments({positions_[a], positions_[b]}, {from, to});
    const Placement& now = obstacle_.placement;
    const Vec3 velocity = (1.0 - nearest.s) * state_.velocity[a] + nearest.s * state_.velocity[b] -
                          moving_.velocity_after(state_.time, now(nearest.second));
    const Vec3 along = (to - from).normalized();
    const Vec3 sliding = now.rotation.transpose() * velocity;
    const double slide = state_.previous_dt * (sliding - along.dot(sliding) * along).norm();
    return slide * std::abs(normal.dot((positions_[b] - positions_[a]).normalized()));
}

/// Crossing beyond the end of a cloth edge. Cloth a stand-off above a feature crosses the plane slightly
/// beyond its nearest point. If an edge ends between the two, the crossing is on an edge that continues from
/// there.
std::optional<FeatureSite> EdgeCrossings::find_beyond_end(int a, int b, int feature, const Vec3& normal) const
{
    if (obstacle_->features().edges[feature].kind != FeatureKind::Convex) return std::nullopt;
    const std::array<Vec3, 2> segment = feature_segment(obstacle_, feature);
    const SegmentPair nearest = closest_between_segments({positions_[a], positions_[b]}, segment);
    const int end = nearest.s < 0.5 ? a : b;
    if (!((positions_[end] - nearest.second).norm() <= kOnFeature * thickness_)) return std::nullopt;
    for (const int w : neighbours(end))
        if (w != a && w != b)
            if (const auto site = find(end, w, feature, normal)) return site;
    return std::nullopt;
}

}  // namespace arris
