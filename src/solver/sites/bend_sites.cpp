// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/sites/bend_sites.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "geometry/closest_point.h"
#include "geometry/obstacle/feature_path.h"
#include "solver/eol/eol_features.h"
#include "solver/model/eol_limits.h"
#include "solver/model/target_length.h"

namespace arris {

namespace {

/// An EOL vertex or a site on a wire.
struct Place {
    double along;  ///< m, from the polyline's start
    Vec3 point;    ///< on the wire
    Vec2 material;
    int vertex;  ///< the cloth's vertex there or nearest to it
    int bend;    ///< point of the obstacle's mesh where it is held, or -1
};

struct WireBend {
    double along;
    int point;
    FeatureBend bend;
};

class BendFinder {
  public:
    BendFinder(const Scene& scene, const State& state, const ClothStars& stars, std::int32_t o,
               const std::vector<Vec3>& positions)
        : scene_(scene),
          state_(state),
          stars_(stars),
          o_(o),
          obstacle_(scene.obstacles[static_cast<std::size_t>(o)].at(state.time)),
          positions_(positions)
    {
    }

    void find(int polyline, const std::vector<FeatureSite>& sites, std::vector<FeatureSite>& found) const
    {
        const Polyline traced = trace_polyline(obstacle_, polyline);
        const std::vector<WireBend> bends = bends_of(traced);
        if (bends.empty()) return;
        const std::vector<Place> places = places_on(traced, sites);
        for (std::size_t i = 0; i < places.size(); ++i) {
            const bool is_last = i + 1 == places.size();
            if (is_last && (!traced.is_closed || places.size() < 3)) break;
            const Place& p = places[i];
            Place q = places[is_last ? 0 : i + 1];
            if (is_last) q.along += traced.length;
            if (const auto site = between(p, q, bends, traced.length)) found.push_back(*site);
        }
    }

  private:
    std::vector<WireBend> bends_of(const Polyline& polyline) const
    {
        std::vector<WireBend> bends;
        for (const PolylineEdge& edge : polyline.edges) {
            const int point = point_at(obstacle_, {edge.feature, edge.is_forward ? 0 : 1});
            if (const auto bend = find_bend(obstacle_, point)) bends.push_back({edge.begin, point, *bend});
        }
        return bends;
    }

    Place place_at(const PolylineEdge& edge, const Vec3& place) const
    {
        const PointOnFeature at = place_on_feature(obstacle_, edge.feature, place);
        const auto [a, b] = feature_segment(obstacle_, edge.feature);
        const double along = edge.begin + (edge.is_forward ? at.s : 1.0 - at.s) * (b - a).norm();
        return {along, at.point, Vec2::Zero(), -1, -1};
    }

    std::vector<Place> places_on(const Polyline& polyline, const std::vector<FeatureSite>& sites) const
    {
        std::map<int, const PolylineEdge*> edges;
        for (const PolylineEdge& edge : polyline.edges) edges[edge.feature] = &edge;
        std::vector<Place> places;
        const auto add = [&](int feature, int bend, const Vec3& place, const Vec2& material, int vertex) {
            const auto edge = edges.find(feature);
            if (edge == edges.end()) return;
            Place at = place_at(*edge->second, place);
            at.material = material;
            at.vertex = vertex;
            if (bend >= 0) at.bend = point_at(obstacle_, {feature, bend});
            places.push_back(at);
        };
        for (const EolVertex& eol : state_.eol) {
            const int v = state_.index_of(eol.vertex_id);
            if (eol.on.obstacle == o_ && !eol.on.is_corner())
                add(eol.on.index, eol.on.end, positions_[v], state_.mesh.material[v], v);
        }
        for (const FeatureSite& site : sites)
            if (!site.on.is_corner())
                add(site.on.index, site.on.end, place_of(site), site.material, state_.index_of(site.near));
        std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
            return std::tuple(a.along, a.vertex) < std::tuple(b.along, b.vertex);
        });
        return places;
    }

    Vec3 place_of(const FeatureSite& site) const
    {
        if (site.on.is_bend()) return bend_point(obstacle_, {site.on.index, site.on.end});
        return place_of_site(state_.mesh, stars_, site, positions_);
    }

    /// The bend between two neighbours that their chord misses most. `length`: of the polyline, m.
    std::optional<FeatureSite> between(const Place& p, const Place& q, const std::vector<WireBend>& bends,
                                       double length) const
    {
        const double cell = target_length(scene_, state_, p.material);
        if (!((p.material - q.material).norm() < kLongEdge * cell)) return std::nullopt;
        const WireBend* worst = nullptr;
        double most = kMissedByChord * scene_.materials.thickness();
        for (const WireBend& bend : bends)
            for (const double along : {bend.along, bend.along + length}) {
                if (!(along > p.along && along < q.along) || bend.point == p.bend || bend.point == q.bend ||
                    !locks_at_bend(scene_, state_, obstacle_, bend.bend, p.material))
                    continue;
                const Vec3& at = obstacle_->mesh().points[static_cast<std::size_t>(bend.point)];
                const double s = closest_on_segment(at, p.point, q.point);
                const double missed = (at - (p.point + s * (q.point - p.point))).norm();
                if (missed > most) worst = &bend;
                most = std::max(most, missed);
            }
        return worst ? nearest_to(*worst, {p.vertex, q.vertex}) : std::nullopt;
    }

    /// Site where the cloth around two vertices is nearest to a bend.
    std::optional<FeatureSite> nearest_to(const WireBend& bend, const std::array<int, 2>& around) const
    {
        const Vec3& point = obstacle_->mesh().points[static_cast<std::size_t>(bend.point)];
        double least = kOnFeature * scene_.materials.thickness();
        std::optional<FeatureSite> site;
        for (const int f : faces_around(around)) {
            const auto& [a, b, c] = state_.mesh.faces[f];
            const std::array<Vec3, 3> triangle = {positions_[a], positions_[b], positions_[c]};
            const Vec3 up = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).stableNormalized();
            const PointOnTriangle closest = closest_on_triangle(point, triangle, up);
            const double distance = (closest.point - point).norm();
            if (!(distance < least)) continue;
            least = distance;
            site = make_bend_site(state_, stars_, o_, bend.bend, state_.mesh.faces[f], closest.weights,
                                  (closest.point - point) / distance);
        }
        return site;
    }

    /// Faces at these vertices and at their neighbours.
    std::set<int> faces_around(const std::array<int, 2>& vertices) const
    {
        std::set<int> faces;
        for (const int v : vertices)
            for (const int f : stars_.faces[v])
                for (const int w : state_.mesh.faces[f])
                    faces.insert(stars_.faces[w].begin(), stars_.faces[w].end());
        return faces;
    }

    const Scene& scene_;
    const State& state_;
    const ClothStars& stars_;
    std::int32_t o_;
    ObstaclePose obstacle_;  ///< at the state's time
    const std::vector<Vec3>& positions_;
};

}  // namespace

bool locks_at_bend(const Scene& scene, const State& state, const Obstacle& obstacle, const FeatureBend& bend,
                   const Vec2& material)
{
    const double half_cell = 0.5 * target_length(scene, state, material);
    return missed_by_chord(obstacle, bend, half_cell) > kMissedByChord * scene.materials.thickness();
}

FeatureSite make_bend_site(const State& state, const ClothStars& stars, std::int32_t o,
                           const FeatureBend& bend, const std::array<int, 3>& vertices,
                           const std::array<double, 3>& weights, const Vec3& outward)
{
    const Vec2 X = blend_material(state.mesh, stars, vertices, weights);
    int count = 0, border = 0;
    for (int i = 0; i < 3 && vertices[i] >= 0; ++i) {
        if (!(weights[i] > 0.0)) continue;
        ++count;
        border += stars.is_on_border(vertices[i]) ? 1 : 0;
    }
    FeatureSite site{FeatureId::bend(o, bend.feature, bend.end), X,
                     state.ids[find_nearest(stars, vertices, weights)], outward};
    site.is_on_border = count < 3 && border == count;
    return site;
}

std::vector<FeatureSite> find_bend_sites(const Scene& scene, const State& state, const ClothStars& stars,
                                         std::int32_t o, const std::vector<Vec3>& positions,
                                         const std::vector<FeatureSite>& sites)
{
    const std::vector<FeatureEdge>& edges =
        scene.obstacles[static_cast<std::size_t>(o)].shape().features().edges;
    std::set<int> polylines;
    const auto add = [&](int feature) {
        if (edges[feature].kind == FeatureKind::Wire) polylines.insert(edges[feature].polyline);
    };
    for (const EolVertex& eol : state.eol)
        if (eol.on.obstacle == o && !eol.on.is_corner()) add(eol.on.index);
    for (const FeatureSite& site : sites)
        if (!site.on.is_corner()) add(site.on.index);
    const BendFinder finder(scene, state, stars, o, positions);
    std::vector<FeatureSite> found;
    for (const int polyline : polylines) finder.find(polyline, sites, found);
    return found;
}

}  // namespace arris
