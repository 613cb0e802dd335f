// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/sites/feature_sites.h"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>

#include "geometry/closest_point.h"
#include "geometry/obstacle/feature_frame.h"
#include "geometry/obstacle/feature_nodes.h"
#include "geometry/obstacle/feature_path.h"
#include "geometry/obstacle/normal_cone.h"
#include "geometry/tolerances.h"
#include "solver/eol/eol_features.h"
#include "solver/sites/bend_sites.h"
#include "solver/sites/edge_crossings.h"
#include "solver/sites/end_sites.h"
#include "solver/sites/trace_gaps.h"

namespace arris {

namespace {

/// Finds the places where features of one obstacle pressed in the last step.
class SiteFinder {
  public:
    SiteFinder(const Scene& scene, const State& state, const ClothStars& stars, std::int32_t o)
        : scene_(scene),
          state_(state),
          stars_(stars),
          obstacle_(scene.obstacles[o].at(state.time)),
          o_(o),
          thickness_(scene.materials.thickness()),
          crossings_(scene, state, stars, o)
    {
    }

    std::optional<FeatureSite> find(const ActiveContact& contact) const
    {
        std::array<int, 3> v = {-1, -1, -1};
        for (int i = 0; i < 3 && contact.vertex_ids[i] != ContactVertexIds::kNoVertex; ++i) {
            v[i] = state_.index_of(contact.vertex_ids[i]);
            if (v[i] < 0) return std::nullopt;
        }
        switch (contact.kind) {
            case ContactKind::Vertex:
                return at_vertex(v[0], contact.normal);
            case ContactKind::Edge:
                return on_edge(v[0], v[1], contact);
            case ContactKind::Triangle:
                return in_face(v, contact);
        }
        return std::nullopt;
    }

    const EdgeCrossings& crossings() const { return crossings_; }

  private:
    std::optional<FeatureSite> on_edge(int a, int b, const ActiveContact& contact) const
    {
        const int feature = feature_of_edge(obstacle_->features(), contact.element);
        if (feature < 0 || !obstacle_->features().edges[feature].is_awake) return std::nullopt;
        if (const std::optional<FeatureSite> bend = on_bend(a, b, feature, contact.normal)) return bend;
        return crossings_.find_pressed(a, b, feature, contact.normal);
    }

    std::optional<FeatureSite> in_face(const std::array<int, 3>& v, const ActiveContact& contact) const
    {
        if (const auto bend = find_locked_bend(contact.element, v[0]))
            return at_bend(*bend, v, contact.normal);
        const int corner = corner_at(obstacle_->features(), contact.element);
        if (v[2] < 0) return std::nullopt;
        if (corner >= 0 && !obstacle_->features().corners[corner].is_awake) return std::nullopt;
        if (corner < 0) return at_rim_bend(contact.element, v, contact.normal);
        const Vec3 &a = crossings_.positions()[v[0]], &b = crossings_.positions()[v[1]],
                   &c = crossings_.positions()[v[2]];
        const PointOnTriangle closest = closest_on_triangle(obstacle_->mesh().points[contact.element],
                                                            {a, b, c}, (b - a).cross(c - a).normalized());
        if (const std::optional<FeatureSite> at = at_corner_of(v, corner)) return at;
        const Vec2 X = blend_material(state_.mesh, stars_, v, closest.weights);
        return make_corner(corner, X, find_nearest(stars_, v, closest.weights), contact.normal);
    }

    /// Site at a bend of a rim, a vertex of the obstacle's mesh in the middle of a convex edge: the point of
    /// the face straight outward from it. A trace without a vertex there would miss the bend.
    std::optional<FeatureSite> at_rim_bend(int point, const std::array<int, 3>& v, const Vec3& normal) const
    {
        const Vec3& p = obstacle_->mesh().points[point];
        const std::array<Vec3, 3> face = {crossings_.positions()[v[0]], crossings_.positions()[v[1]],
                                          crossings_.positions()[v[2]]};
        const Vec3 up = (face[1] - face[0]).cross(face[2] - face[0]).stableNormalized();
        const ObstacleTopology& topology = obstacle_->topology();
        for (int k = 0; k < topology.edge_count_at(point); ++k) {
            const int feature = feature_of_edge(obstacle_->features(), topology.edge_at(point, k));
            if (feature < 0) continue;
            const FeatureEdge& edge = obstacle_->features().edges[feature];
            if (edge.kind != FeatureKind::Convex || !edge.is_awake) continue;
            const auto frame =
                find_edge_frame(obstacle_, feature, p, {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()});
            const double height = up.dot(face[0] - p) / up.dot(frame->outward);
            if (!(height >= 0.0 && height <= kOnFeature * thickness_)) continue;
            const Vec3 there = p + height * frame->outward;
            const PointOnTriangle closest = closest_on_triangle(there, face, up);
            if (!((closest.point - there).norm() <= kOnSurface * thickness_)) continue;
            const Vec2 X = blend_material(state_.mesh, stars_, v, closest.weights);
            const int near = find_nearest(stars_, v, closest.weights);
            return FeatureSite{FeatureId::edge(o_, feature), X, state_.ids[near], normal};
        }
        return std::nullopt;
    }

    /// The vertex of the face that is on a tip already. Cloth around a released vertex has the tip inside and
    /// touches it with several faces: a new vertex in one of the faces would be beside the others.
    std::optional<FeatureSite> at_corner_of(const std::array<int, 3>& v, int corner) const
    {
        if (!is_tip(obstacle_, corner)) return std::nullopt;
        const Vec3& point = obstacle_->mesh().points[obstacle_->features().corners[corner].point];
        const auto distance = [&](int w) { return (crossings_.positions()[w] - point).norm(); };
        const int nearest =
            *std::min_element(v.begin(), v.end(), [&](int a, int b) { return distance(a) < distance(b); });
        if (!(distance(nearest) <= kOnFeature * thickness_)) return std::nullopt;
        const Vec3 outward = (crossings_.positions()[nearest] - point).stableNormalized();
        return make_corner(corner, state_.mesh.material[nearest], nearest, outward);
    }

    /// Site at a corner or bend, or beside a feature edge whose plane is crossed by a cloth edge from this
    /// vertex.
    std::optional<FeatureSite> at_vertex(int v, const Vec3& normal) const
    {
        const Vec3& place = crossings_.positions()[v];
        const double reach = kOnFeature * thickness_;
        const Box3 box(place.array() - reach, place.array() + reach);
        std::vector<int> found;
        obstacle_->find_corners(box, found);
        const bool is_on_border = stars_.is_on_border(v);  // such a vertex has no room at a point
        for (const int c : is_on_border ? std::vector<int>() : found) {
            const int point = obstacle_->features().corners[c].point;
            const Vec3 from = place - obstacle_->mesh().points[point];
            if (from.norm() <= reach && is_in_point_cone(obstacle_, point, from.normalized()))
                return make_corner(c, state_.mesh.material[v], v, normal);
        }
        obstacle_->find_feature_edges(box, found);
        for (const int f : found)
            for (const int point : obstacle_->topology().edges[obstacle_->features().edges[f].edge].points)
                if (const auto bend = find_locked_bend(point, v);
                    bend && (place - obstacle_->mesh().points[point]).norm() <= reach)
                    return make_bend(*bend, {v, -1, -1}, {1.0, 0.0, 0.0}, normal);
        for (const int f : found)
            for (const int w : crossings_.neighbours(v))
                if (const std::optional<FeatureSite> site = crossings_.find(v, w, f, normal)) return site;
        return std::nullopt;
    }

    /// The bend at a point of the obstacle's mesh where a vertex is locked, beside vertex `v` of the cloth.
    std::optional<FeatureBend> find_locked_bend(int point, int v) const
    {
        const std::optional<FeatureBend> bend = find_bend(obstacle_, point);
        const bool is_held = bend && locks_at_bend(scene_, state_, obstacle_, *bend, state_.mesh.material[v]);
        return is_held ? bend : std::nullopt;
    }

    /// Site at a bend, if the bend is the point of the wire's edge nearest to the cloth's edge.
    std::optional<FeatureSite> on_bend(int a, int b, int feature, const Vec3& normal) const
    {
        const SegmentPair nearest = closest_between_segments(
            {crossings_.positions()[a], crossings_.positions()[b]}, feature_segment(obstacle_, feature));
        if (nearest.t > 0.0 && nearest.t < 1.0) return std::nullopt;
        const int end = nearest.t > 0.0 ? 1 : 0;
        const auto bend = find_locked_bend(point_at(obstacle_, {feature, end}), a);
        if (!bend || !((nearest.first - nearest.second).norm() <= kOnFeature * thickness_))
            return std::nullopt;
        return make_bend(*bend, {a, b, -1}, {1.0 - nearest.s, nearest.s, 0.0}, normal);
    }

    /// Site where a bend is nearest to a face, or to the edge between two faces.
    std::optional<FeatureSite> at_bend(const FeatureBend& bend, const std::array<int, 3>& v,
                                       const Vec3& normal) const
    {
        const Vec3 point = bend_point(obstacle_, bend);
        const Vec3 &a = crossings_.positions()[v[0]], &b = crossings_.positions()[v[1]];
        if (v[2] >= 0) {
            const Vec3& c = crossings_.positions()[v[2]];
            const Vec3 up = (b - a).cross(c - a).normalized();
            return make_bend(bend, v, closest_on_triangle(point, {a, b, c}, up).weights, normal);
        }
        const double s = closest_on_segment(point, a, b);
        return make_bend(bend, v, {1.0 - s, s, 0.0}, normal);
    }

    FeatureSite make_bend(const FeatureBend& bend, const std::array<int, 3>& v,
                          const std::array<double, 3>& weights, const Vec3& normal) const
    {
        return make_bend_site(state_, stars_, o_, bend, v, weights, normal);
    }

    FeatureSite make_corner(int corner, const Vec2& X, int near, const Vec3& outward) const
    {
        return {FeatureId::corner(o_, corner), X, state_.ids[near], outward};
    }

    const Scene& scene_;
    const State& state_;
    const ClothStars& stars_;
    ObstaclePose obstacle_;  ///< at the state's time
    std::int32_t o_;
    double thickness_;
    EdgeCrossings crossings_;
};

}  // namespace

Vec3 place_of_site(const ClothMesh& mesh, const ClothStars& stars, const FeatureSite& site,
                   const std::vector<Vec3>& positions)
{
    const Vec2 first = blend_material(mesh, stars, site.edge, std::array{1.0, 0.0}),
               last = blend_material(mesh, stars, site.edge, std::array{0.0, 1.0});
    const double length = (last - first).norm();
    const double s = length > 0.0 ? (site.material - first).norm() / length : 0.0;
    return (1.0 - s) * positions[site.edge[0]] + s * positions[site.edge[1]];
}

std::vector<FeatureSite> find_feature_sites(const Scene& scene, const State& state, const ClothStars& stars)
{
    std::map<std::int32_t, SiteFinder> finders;
    std::vector<FeatureSite> sites;
    const auto finder_of = [&](std::int32_t o) -> const SiteFinder& {
        return finders.try_emplace(o, scene, state, stars, o).first->second;
    };
    std::map<std::array<int, 2>, std::vector<FeatureSite>> by_feature;  // by obstacle and edge
    for (std::size_t c = 0; c < state.active.size(); ++c) {
        const ActiveContact& contact = state.active[c];
        // Squeezed cloth presses on the faces beside a feature as well, and does not turn at the feature.
        if (contact.obstacle == kClothItself || contact.is_squeezed) continue;
        const bool is_eol =
            contact.kind == ContactKind::Vertex && state.eol_entry(contact.vertex_ids[0]) >= 0;
        std::optional<FeatureSite> site = is_eol ? std::nullopt : finder_of(contact.obstacle).find(contact);
        if (!site) continue;
        site->contact = static_cast<int>(c);
        if (site->on.is_corner() || site->is_in_face())
            sites.push_back(*site);
        else
            by_feature[{site->on.obstacle, site->on.index}].push_back(*site);
    }
    for (const EolVertex& eol : state.eol)
        if (!eol.on.is_corner()) by_feature[{eol.on.obstacle, eol.on.index}];
    for (auto& [feature, found] : by_feature) {
        fill_trace_gaps(finder_of(feature[0]).crossings(), feature[1], found);
        continue_past_ends(finder_of(feature[0]).crossings(), feature[1], found);
        sites.insert(sites.end(), found.begin(), found.end());
    }
    for (const auto& [o, finder] : finders) drop_ends_passed(finder.crossings(), sites);
    for (const auto& [o, finder] : finders) {
        std::vector<FeatureSite> of_obstacle;
        for (const FeatureSite& site : sites)
            if (site.on.obstacle == o) of_obstacle.push_back(site);
        const std::vector<FeatureSite> bends =
            find_bend_sites(scene, state, stars, o, finder.crossings().positions(), of_obstacle);
        sites.insert(sites.end(), bends.begin(), bends.end());
    }
    std::sort(sites.begin(), sites.end(), [](const FeatureSite& a, const FeatureSite& b) {
        const auto key_of = [](const FeatureSite& s) {
            return std::tuple(!s.on.is_corner(), !s.on.is_bend(), s.on.obstacle, s.on.index, s.material.x(),
                              s.material.y());
        };
        return key_of(a) < key_of(b);
    });
    return sites;
}

}  // namespace arris
