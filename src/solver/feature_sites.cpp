// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/feature_sites.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "geometry/closest_point.h"
#include "geometry/feature_frame.h"
#include "geometry/feature_nodes.h"
#include "geometry/feature_path.h"
#include "geometry/normal_cone.h"
#include "solver/eol_features.h"
#include "solver/turn_sites.h"

namespace arris {

namespace {

constexpr double kInPlane = 1e-6;  // thicknesses: a vertex nearer to a feature's plane is in it
constexpr double kAsGood = 0.1;    // the same, where the cloth comes no nearer: its edge begins or ends there

/// Feature edges by topology edge; -1 where it is none.
std::vector<int> feature_of_edges(const Obstacle& obstacle)
{
    std::vector<int> feature(obstacle.topology().edges.size(), -1);
    const auto& edges = obstacle.features().edges;
    for (std::size_t f = 0; f < edges.size(); ++f) feature[edges[f].edge] = static_cast<int>(f);
    return feature;
}

int corner_at(const Obstacle& obstacle, int point)
{
    const auto& corners = obstacle.features().corners;
    const auto found = std::lower_bound(corners.begin(), corners.end(), point,
                                        [](const FeatureCorner& c, int p) { return c.point < p; });
    return found != corners.end() && found->point == point ? static_cast<int>(found - corners.begin()) : -1;
}

/// Finds the places of one obstacle on which its features pressed in the last step.
class SiteFinder {
  public:
    SiteFinder(const Scene& scene, const State& state, const ClothStars& stars, std::int32_t o)
        : scene_(scene),
          state_(state),
          obstacle_(scene.obstacles[o]),
          o_(o),
          thickness_(scene.material.thickness),
          positions_(to_frame(obstacle_.at(state.time), state.mesh.world)),
          feature_(feature_of_edges(obstacle_)),
          stars_(stars)
    {
    }

    std::optional<FeatureSite> find(const ActiveContact& contact) const
    {
        std::array<int, 3> v = {-1, -1, -1};
        for (int i = 0; i < 3 && contact.vertex_ids[i] != ActiveContact::kNoVertex; ++i) {
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

    /// Of the cloth, in the obstacle's frame.
    const std::vector<Vec3>& positions() const { return positions_; }

    /// Adds to sites of convex edge `feature` what of the cloth lies on it between them and EOL vertices.
    void complete(int feature, std::vector<FeatureSite>& sites) const
    {
        if (obstacle_.features().edges[feature].kind != FeatureKind::Convex) return;
        const Vec3 outward = outward_of(feature);
        TraceGraph trace;
        std::vector<Crossing> open = begin_trace(feature, sites, trace);
        while (!open.empty()) {
            const Crossing at = open.back();
            open.pop_back();
            for (const auto& [next, site] : crossings_beside(at, feature, outward)) {
                const auto [node, is_new] = trace.try_emplace(next, TraceNode{site, false, {}});
                if (is_new) open.push_back(next);
                node->second.beside.insert(at);
                trace.at(at).beside.insert(next);
            }
        }
        cut_loose_ends(trace);
        for (const auto& [at, node] : trace)
            if (!node.is_known) sites.push_back(*node.site);
    }

  private:
    struct Reach {
        double in_plane;  ///< thicknesses from the plane, within which an edge's end is the crossing
        double height;    ///< m, above the feature, to which cloth lies on it
    };
    using Crossing = std::array<int, 2>;  ///< a FeatureSite's edge
    struct TraceNode {
        std::optional<FeatureSite> site;  ///< none where an EOL vertex is
        bool is_known;                    ///< a site that presses, or an EOL vertex
        std::set<Crossing> beside;
    };
    using TraceGraph = std::map<Crossing, TraceNode>;

    bool is_eol_on(int v, int feature) const
    {
        const int entry = state_.eol_entry(state_.ids[v]);
        return entry >= 0 && !state_.eol[entry].is_corner && state_.eol[entry].obstacle == o_ &&
               state_.eol[entry].feature == feature;
    }

    /// What is on the feature already; returned are those of them from which the trace may go on.
    std::vector<Crossing> begin_trace(int feature, const std::vector<FeatureSite>& sites,
                                      TraceGraph& trace) const
    {
        std::vector<Crossing> open;
        for (const FeatureSite& site : sites)
            if (trace.try_emplace(site.edge, TraceNode{site, true, {}}).second) open.push_back(site.edge);
        for (const EolVertex& eol : state_.eol) {
            const int v = state_.index_of(eol.vertex_id);
            if (!is_eol_on(v, feature)) continue;
            trace[{v, v}] = {std::nullopt, true, {}};
            const std::vector<int> beside = neighbours(v);
            const auto joined =
                std::count_if(beside.begin(), beside.end(), [&](int w) { return is_eol_on(w, feature); });
            if (joined < 2) open.push_back({v, v});
        }
        return open;
    }

    /// Where the plane of the feature passes through the faces around a crossing.
    std::map<Crossing, std::optional<FeatureSite>> crossings_beside(const Crossing& at, int feature,
                                                                    const Vec3& outward) const
    {
        std::map<Crossing, std::optional<FeatureSite>> found;
        for (const int f : stars_.faces[at[0]]) {
            const Face& face = state_.mesh.faces[f];
            if (std::find(face.begin(), face.end(), at[1]) == face.end()) continue;
            for (int k = 0; k < 3; ++k) {
                const int a = face[k], b = face[(k + 1) % 3];
                if (is_eol_on(a, feature))
                    found[{a, a}] = std::nullopt;
                else if (is_eol_on(b, feature))
                    found[{b, b}] = std::nullopt;
                else if (const auto site = cross(a, b, feature, outward))
                    found[site->edge] = site;
            }
        }
        found.erase(at);
        return found;
    }

    Vec3 outward_of(int feature) const
    {
        const std::array<Vec3, 2> ends = feature_segment(obstacle_, feature);
        return find_edge_frame(obstacle_, feature, ends[0], {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()})
            ->outward;
    }

    /// What remains beside what is known lies between; or on the cloth's border, next to it.
    static void cut_loose_ends(TraceGraph& trace)
    {
        const auto is_loose = [&](const TraceNode& node) {
            if (node.is_known || node.beside.size() > 1) return false;
            const bool is_end =
                !node.beside.empty() && node.site->is_on_border && trace.at(*node.beside.begin()).is_known;
            return !is_end;
        };
        for (bool is_changed = true; is_changed;) {
            is_changed = false;
            for (auto at = trace.begin(); at != trace.end();) {
                if (!is_loose(at->second)) {
                    ++at;
                    continue;
                }
                for (const Crossing& next : at->second.beside) trace.at(next).beside.erase(at->first);
                at = trace.erase(at);
                is_changed = true;
            }
        }
    }

    FeatureSite make_site(bool is_corner, int feature, const Vec2& X, int near, const Vec3& outward) const
    {
        return {o_, is_corner, feature, X, state_.ids[near], outward};
    }

    /// Where the cloth's edge passes through the plane in which an EOL vertex may move.
    std::optional<FeatureSite> on_edge(int a, int b, const ActiveContact& contact) const
    {
        const int feature = feature_[contact.element];
        if (feature < 0) return std::nullopt;
        if (const std::optional<FeatureSite> turn = on_turn(a, b, feature, contact.normal)) return turn;
        const double height = kOnFeature * thickness_ + find_rise(a, b, feature, contact.normal);
        for (const double in_plane : {kInPlane, kAsGood})
            if (const auto crossing = cross(a, b, feature, contact.normal, {in_plane, height}))
                return crossing;
        return beyond_end(a, b, feature, contact.normal);
    }

    /// Cloth a stand-off above an edge passes through its plane a little beyond where it is nearest: where an
    /// edge of it ends between the two, on one that goes on from there.
    std::optional<FeatureSite> beyond_end(int a, int b, int feature, const Vec3& normal) const
    {
        if (obstacle_.features().edges[feature].kind != FeatureKind::Convex) return std::nullopt;
        const std::array<Vec3, 2> segment = feature_segment(obstacle_, feature);
        const SegmentPair nearest = closest_between_segments({positions_[a], positions_[b]}, segment);
        const int end = nearest.s < 0.5 ? a : b;
        if (!((positions_[end] - nearest.second).norm() <= kOnFeature * thickness_)) return std::nullopt;
        for (const int w : neighbours(end))
            if (w != a && w != b)
                if (const auto site = cross(end, w, feature, normal)) return site;
        return std::nullopt;
    }

    /// At a point of the obstacle's mesh beside vertex `v` of the cloth.
    std::optional<FeatureTurn> find_held_turn(int point, int v) const
    {
        const std::optional<FeatureTurn> turn = find_turn(obstacle_, point);
        const bool is_held = turn && is_held_at(scene_, obstacle_, *turn, state_.mesh.material[v]);
        return is_held ? turn : std::nullopt;
    }

    /// Where the end of a wire's edge that is nearest to the cloth's is a turn.
    std::optional<FeatureSite> on_turn(int a, int b, int feature, const Vec3& normal) const
    {
        const SegmentPair nearest =
            closest_between_segments({positions_[a], positions_[b]}, feature_segment(obstacle_, feature));
        if (nearest.t > 0.0 && nearest.t < 1.0) return std::nullopt;
        const int end = nearest.t > 0.0 ? 1 : 0;
        const auto turn = find_held_turn(point_at(obstacle_, {feature, end}), a);
        if (!turn || !((nearest.first - nearest.second).norm() <= kOnFeature * thickness_))
            return std::nullopt;
        return make_turn(*turn, {a, b, -1}, {1.0 - nearest.s, nearest.s, 0.0}, normal);
    }

    FeatureSite make_turn(const FeatureTurn& turn, const std::array<int, 3>& v,
                          const std::array<double, 3>& weights, const Vec3& normal) const
    {
        return make_turn_site(state_, stars_, o_, turn, v, weights, normal);
    }

    bool is_eol(int v) const { return state_.eol_entry(state_.ids[v]) >= 0; }

    /// How much higher an edge of the cloth that pressed along `normal` may be over the feature by now. What
    /// kept the gap is the point that touched; the edge has slid on from there, and turned.
    double find_rise(int a, int b, int feature, const Vec3& normal) const
    {
        const auto [from, to] = feature_segment(obstacle_, feature);
        const SegmentPair nearest = closest_between_segments({positions_[a], positions_[b]}, {from, to});
        const Placement now = obstacle_.at(state_.time);
        const Vec3 velocity = (1.0 - nearest.s) * state_.velocity[a] + nearest.s * state_.velocity[b] -
                              obstacle_.velocity_after(state_.time, now(nearest.second));
        const Vec3 along = (to - from).normalized();
        const Vec3 sliding = now.rotation.transpose() * velocity;
        const double slide = state_.previous_dt * (sliding - along.dot(sliding) * along).norm();
        return slide * std::abs(normal.dot((positions_[b] - positions_[a]).normalized()));
    }

    std::optional<FeatureSite> cross(int a, int b, int feature, const Vec3& normal) const
    {
        return cross(a, b, feature, normal, {kInPlane, kOnFeature * thickness_});
    }
    std::optional<FeatureSite> cross(int a, int b, int feature, const Vec3& normal, const Reach& reach) const
    {
        if (a > b) std::swap(a, b);
        const std::optional<double> s = find_crossing(a, b, feature, reach);
        if (!s || (*s == 0.0 && is_eol(a)) || (*s == 1.0 && is_eol(b))) return std::nullopt;
        const Vec2 X = (1.0 - *s) * state_.mesh.material[a] + *s * state_.mesh.material[b];
        FeatureSite site = make_site(false, feature, X, *s < 0.5 ? a : b, normal);
        site.edge = {*s < 1.0 ? a : b, *s > 0.0 ? b : a};
        const auto [before, after] = stars_.border_neighbours[site.edge[0]];
        site.is_on_border = site.edge[0] == site.edge[1] ? before >= 0 : before == b || after == b;
        return site;
    }

    /// On a wire or border, whose plane turns with the cloth, the nearest point.
    std::optional<double> find_crossing(int a, int b, int feature, const Reach& reach) const
    {
        const std::array<Vec3, 2> segment = feature_segment(obstacle_, feature);
        const SegmentPair nearest = closest_between_segments({positions_[a], positions_[b]}, segment);
        const FeatureEdge& edge = obstacle_.features().edges[feature];
        if (edge.kind != FeatureKind::Convex) {
            const bool is_near = (nearest.first - nearest.second).norm() <= kOnFeature * thickness_;
            const auto& ends = obstacle_.topology().edges[edge.edge].points;
            const bool is_at_corner = (nearest.t <= 0.0 && corner_at(obstacle_, ends[0]) >= 0) ||
                                      (nearest.t >= 1.0 && corner_at(obstacle_, ends[1]) >= 0);
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

    std::optional<FeatureSite> in_face(const std::array<int, 3>& v, const ActiveContact& contact) const
    {
        if (const auto turn = find_held_turn(contact.element, v[0])) return at_turn(*turn, v, contact.normal);
        const int corner = corner_at(obstacle_, contact.element);
        if (corner < 0 || v[2] < 0) return std::nullopt;
        const Vec3 &a = positions_[v[0]], &b = positions_[v[1]], &c = positions_[v[2]];
        const PointOnTriangle closest = closest_on_triangle(obstacle_.mesh().points[contact.element],
                                                            {a, b, c}, (b - a).cross(c - a).normalized());
        if (const std::optional<FeatureSite> at = at_corner_of(v, corner)) return at;
        Vec2 X = Vec2::Zero();
        for (int i = 0; i < 3; ++i) X += closest.weights[i] * state_.mesh.material[v[i]];
        const auto heaviest = std::max_element(closest.weights.begin(), closest.weights.end());
        return make_site(true, corner, X, v[heaviest - closest.weights.begin()], contact.normal);
    }

    /// A vertex of the face that is on a tip as it is. Cloth around one that was let go has the tip
    /// inside, and touches it with several faces: a vertex in one of them would be beside the others.
    std::optional<FeatureSite> at_corner_of(const std::array<int, 3>& v, int corner) const
    {
        if (!is_tip(obstacle_, corner)) return std::nullopt;
        const Vec3& point = obstacle_.mesh().points[obstacle_.features().corners[corner].point];
        const auto distance = [&](int w) { return (positions_[w] - point).norm(); };
        const int nearest =
            *std::min_element(v.begin(), v.end(), [&](int a, int b) { return distance(a) < distance(b); });
        if (!(distance(nearest) <= kOnFeature * thickness_)) return std::nullopt;
        const Vec3 outward = (positions_[nearest] - point).stableNormalized();
        return make_site(true, corner, state_.mesh.material[nearest], nearest, outward);
    }

    /// Where a turn is nearest to a face, or to the edge between two.
    std::optional<FeatureSite> at_turn(const FeatureTurn& turn, const std::array<int, 3>& v,
                                       const Vec3& normal) const
    {
        const Vec3 point = turn_point(obstacle_, turn);
        const Vec3 &a = positions_[v[0]], &b = positions_[v[1]];
        if (v[2] >= 0) {
            const Vec3& c = positions_[v[2]];
            const Vec3 up = (b - a).cross(c - a).normalized();
            return make_turn(turn, v, closest_on_triangle(point, {a, b, c}, up).weights, normal);
        }
        const double s = closest_on_segment(point, a, b);
        return make_turn(turn, v, {1.0 - s, s, 0.0}, normal);
    }

    /// At a corner, or beside an edge through whose plane an edge of the cloth from here passes.
    std::optional<FeatureSite> at_vertex(int v, const Vec3& normal) const
    {
        const Vec3& place = positions_[v];
        const double reach = kOnFeature * thickness_;
        const Box3 box(place.array() - reach, place.array() + reach);
        std::vector<int> found;
        obstacle_.find_corners(box, found);
        for (const int c : found) {
            const int point = obstacle_.features().corners[c].point;
            const Vec3 from = place - obstacle_.mesh().points[point];
            if (from.norm() <= reach && is_in_point_cone(obstacle_, point, from.normalized()))
                return make_site(true, c, state_.mesh.material[v], v, normal);
        }
        obstacle_.find_feature_edges(box, found);
        for (const int f : found)
            for (const int point : obstacle_.topology().edges[obstacle_.features().edges[f].edge].points)
                if (const auto turn = find_held_turn(point, v);
                    turn && (place - obstacle_.mesh().points[point]).norm() <= reach)
                    return make_turn(*turn, {v, -1, -1}, {1.0, 0.0, 0.0}, normal);
        for (const int f : found)
            for (const int w : neighbours(v))
                if (const std::optional<FeatureSite> site = cross(v, w, f, normal)) return site;
        return std::nullopt;
    }

    /// Ascending.
    std::vector<int> neighbours(int v) const
    {
        std::vector<int> found;
        for (const int f : stars_.faces[v])
            for (const int w : state_.mesh.faces[f])
                if (w != v) found.push_back(w);
        std::sort(found.begin(), found.end());
        found.erase(std::unique(found.begin(), found.end()), found.end());
        return found;
    }

    const Scene& scene_;
    const State& state_;
    const Obstacle& obstacle_;
    std::int32_t o_;
    double thickness_;
    std::vector<Vec3> positions_;
    std::vector<int> feature_;
    const ClothStars& stars_;
};

}  // namespace

std::array<Vec3, 2> feature_segment(const Obstacle& obstacle, int feature)
{
    const auto& ends = obstacle.topology().edges[obstacle.features().edges[feature].edge].points;
    return {obstacle.mesh().points[ends[0]], obstacle.mesh().points[ends[1]]};
}

std::vector<FeatureSite> find_feature_sites(const Scene& scene, const State& state, const ClothStars& stars)
{
    std::map<std::int32_t, SiteFinder> finders;
    std::vector<FeatureSite> sites;
    const auto finder_of = [&](std::int32_t o) -> const SiteFinder& {
        return finders.try_emplace(o, scene, state, stars, o).first->second;
    };
    std::map<std::array<int, 2>, std::vector<FeatureSite>> by_feature;  // of obstacle and edge
    for (std::size_t c = 0; c < state.active.size(); ++c) {
        const ActiveContact& contact = state.active[c];
        const bool is_eol =
            contact.kind == ContactKind::Vertex && state.eol_entry(contact.vertex_ids[0]) >= 0;
        std::optional<FeatureSite> site = is_eol ? std::nullopt : finder_of(contact.obstacle).find(contact);
        if (!site) continue;
        site->contact = static_cast<int>(c);
        if (site->is_corner)
            sites.push_back(*site);
        else
            by_feature[{site->obstacle, site->feature}].push_back(*site);
    }
    for (const EolVertex& eol : state.eol)
        if (!eol.is_corner) by_feature[{eol.obstacle, eol.feature}];
    for (auto& [feature, found] : by_feature) {
        finder_of(feature[0]).complete(feature[1], found);
        sites.insert(sites.end(), found.begin(), found.end());
    }
    for (const auto& [o, finder] : finders) {
        std::vector<FeatureSite> of_obstacle;
        for (const FeatureSite& site : sites)
            if (site.obstacle == o) of_obstacle.push_back(site);
        const std::vector<FeatureSite> turns =
            find_turn_sites(scene, state, stars, o, finder.positions(), of_obstacle);
        sites.insert(sites.end(), turns.begin(), turns.end());
    }
    std::sort(sites.begin(), sites.end(), [](const FeatureSite& a, const FeatureSite& b) {
        const auto key_of = [](const FeatureSite& s) {
            return std::tuple(!s.is_corner, s.turn < 0, s.obstacle, s.feature, s.material.x(),
                              s.material.y());
        };
        return key_of(a) < key_of(b);
    });
    return sites;
}

}  // namespace arris
