// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/sites/eol_decision.h"

#include <algorithm>
#include <cmath>

#include "geometry/obstacle/feature_frame.h"
#include "geometry/obstacle/feature_nodes.h"
#include "geometry/obstacle/feature_path.h"
#include "solver/eol/eol_features.h"
#include "solver/eol/free_fold.h"
#include "solver/model/hysteresis.h"
#include "solver/model/target_length.h"
#include "solver/sites/border_room.h"
#include "solver/sites/gathering.h"
#include "solver/sites/wire_end.h"

namespace arris {

namespace {

double room_wanted(const CellsAround& room, const FeatureId& on)
{
    return on.is_fixed() ? room.fixed : room.sliding;
}

/// Whether the cloth at a site on an edge lies flat on a face beside the edge.
bool is_along_face(const Obstacle& obstacle, const FeatureSite& site)
{
    const auto& normals = obstacle.features().edges[site.on.index].normals;
    return std::any_of(normals.begin(), normals.end(),
                       [&](const Vec3& n) { return n.dot(site.outward) > kFlat; });
}

/// Whether the cloth is folded at the vertex with these faces.
bool is_folded(const State& state, std::span<const int> faces)
{
    std::vector<Vec3> normals;
    Vec3 mean = Vec3::Zero();
    for (const int f : faces) {
        const auto& [a, b, c] = state.mesh.faces[f];
        const std::vector<Vec3>& x = state.mesh.world;
        normals.push_back((x[b] - x[a]).cross(x[c] - x[a]).normalized());
        mean += normals.back();
    }
    mean.normalize();
    return !std::all_of(normals.begin(), normals.end(), [&](const Vec3& n) { return n.dot(mean) > kFlat; });
}

/// Whether an EOL vertex belongs to a corner that now presses on a face of the cloth. A corner holds only one
/// vertex, whose place is now in that face.
bool is_corner_under_face(const Scene& scene, const State& state, const EolVertex& eol)
{
    if (!eol.on.is_corner()) return false;
    const int point = scene.obstacles[eol.on.obstacle].shape().features().corners[eol.on.index].point;
    return std::any_of(state.active.begin(), state.active.end(), [&](const ActiveContact& contact) {
        return contact.obstacle == eol.on.obstacle && contact.kind == ContactKind::Triangle &&
               contact.element == point;
    });
}

/// From the feature to an EOL vertex. Past the end of a wire it is measured across the line that goes on from
/// there.
Vec3 way_off(const FeatureFrame& frame, const Vec3& place)
{
    const Vec3 from = place - frame.point;
    return from - frame.tangent.dot(from) * frame.tangent;
}

/// Whether an EOL vertex off its edge or wire, under fast flow, moves in another direction than the arriving
/// cloth. It then bends that cloth in every step. A fold that moves along a face does not (free_fold.h).
bool is_led_astray(const Scene& scene, const State& state, const EolVertex& eol, const EolCoordinates& at,
                   const Vec3& place)
{
    constexpr double kAlongFace = 0.15;  // sine
    if (eol.on.is_corner() ||
        !has_left_feature(place - way_off(at.frame, place), place, scene.materials.thickness()) ||
        !(state.material_velocity[at.vertex].norm() > 0.5 * kFreeFlow))
        return false;
    const ObstaclePose obstacle = scene.obstacles[eol.on.obstacle].at(state.time);
    if (!is_on_convex_edge(obstacle, eol)) return true;
    const std::array<Vec3, 2>& normals = obstacle->features().edges[eol.on.index].normals;
    return std::none_of(normals.begin(), normals.end(), [&](const Vec3& normal) {
        return std::abs(normal.dot(at.frame.outward)) < kAlongFace;
    });
}

/// Whether an EOL vertex has not passed the end of its polyline. It may be past the end of a wire, in line
/// with it.
bool is_on_feature(const Scene& scene, const State& state, const EolVertex& eol, const Vec3& place)
{
    const ObstaclePose obstacle = scene.obstacles[eol.on.obstacle].at(state.time);
    const int end = eol.on.is_corner() ? -1 : end_passed(obstacle, eol.on.index, place);
    const Vec2& X = state.mesh.material[state.index_of(eol.vertex_id)];
    return end < 0 || length_past_end(obstacle, eol.on.index, place) <
                          reach_past_end(obstacle, eol.on.index, end, scene.materials.thickness(),
                                         target_length(scene, state, X));
}

/// Whether an EOL vertex is so near to the cloth's border that it is released.
bool is_at_border(const Scene& scene, const State& state, const ClothStars& stars, const EolVertex& eol)
{
    const int v = state.index_of(eol.vertex_id);
    const Vec2& X = state.mesh.material[v];
    const double wanted = kStayRatio * room_wanted(kRoom, eol.on);
    const double room = room_to_border(scene, state, stars, X, v, stars.is_on_border(v), eol);
    return !(room > wanted * longest_cell(scene)) && !(room > wanted * target_length(scene, state, X));
}

}  // namespace

std::optional<ConstraintCause> EolAdmission::find_refusal(const FeatureSite& site, int v,
                                                          const Vec2& flow) const
{
    if (is_pinned(site.material)) return ConstraintCause::Quality;
    if (const std::optional<ConstraintCause> border = find_border_cause(site, v, flow)) return border;
    if (is_unresolved(site)) return ConstraintCause::Unresolved;
    if (is_beside_other(site)) return ConstraintCause::OtherFeature;
    if (gathers(site, v)) return ConstraintCause::Gathering;
    if (const std::optional<ConstraintCause> fold = find_fold_cause(site)) return fold;
    if ((site.on.is_fixed()) && has_vertex_on(site)) return ConstraintCause::BesideEol;
    return std::nullopt;
}

bool EolAdmission::is_pinned(const Vec2& material) const
{
    return std::any_of(scene_.pins.begin(), scene_.pins.end(), [&](const Pin& pin) {
        return pin.holds(state_.time, state_.time) && pin.material.contains(material, material_tolerance_);
    });
}

/// Cause if the cloth's border leaves no room for a vertex; nothing if there is room.
std::optional<ConstraintCause> EolAdmission::find_border_cause(const FeatureSite& site, int v,
                                                               const Vec2& flow) const
{
    const double h = target_length(scene_, state_, site.material);
    const EolVertex eol{site.near, site.on, site.outward, 0};
    if (site.is_on_border && site.on.is_bend()) return ConstraintCause::NearBorder;
    // All vertices of the element are on seams, each with the material of several panels around.
    if (!site.is_on_border && stars_.is_on_seam(v)) return ConstraintCause::NearBorder;
    if (site.is_on_border && !site.on.is_corner() && is_along_border(scene_, state_, stars_, site.edge, eol))
        return ConstraintCause::AlongBorder;
    const auto room_at = [&](const Vec2& X) {
        return room_to_border(scene_, state_, stars_, X, v, site.is_on_border, eol);
    };
    const double room = room_at(site.material);
    if (room < room_wanted(kRoom, eol.on) * h) return ConstraintCause::NearBorder;
    // A vertex that moves fast towards the border would be released at once.
    constexpr double kAside = 1e-3;  // target lengths: for a finite difference of the room
    const Vec2 aside = kAside * h * flow.stableNormalized();
    const double closing = (room - room_at(site.material + aside)) / (kAside * h) * flow.norm();
    if (room < soon_ * closing) return ConstraintCause::BorderAhead;
    return std::nullopt;
}

/// Whether the cloth along the feature is near to gathering.
bool EolAdmission::gathers(const FeatureSite& site, int v) const
{
    if (site.on.is_fixed()) return false;
    const ObstaclePose obstacle = scene_.obstacles[site.on.obstacle].at(state_.time);
    const auto [from, to] = feature_segment(obstacle, site.on.index);
    const Vec3 tangent = obstacle.placement.rotation * (to - from).normalized();
    return is_near_gathering(scene_, state_, stars_, v, tangent);
}

/// Whether a feature is finer than the cells: a convex polyline shorter than one from corner to corner, or a
/// corner at which such polylines end, without room beside another corner's vertex. Cloth that follows two or
/// more polylines needs the corner between them. Any other is the tip of something thin, or roughness.
bool EolAdmission::is_unresolved(const FeatureSite& site) const
{
    if (site.on.is_bend()) return false;
    const Obstacle& obstacle = scene_.obstacles[site.on.obstacle].shape();
    const ObstacleFeatures& features = obstacle.features();
    const double cell = target_length(scene_, state_, site.material);
    const auto is_short = [&](int feature) {
        const FeatureEdge& edge = features.edges[feature];
        const FeaturePolyline& polyline = features.polylines[edge.polyline];
        return edge.kind == FeatureKind::Convex && !polyline.is_closed && polyline.length < cell;
    };
    if (!site.on.is_corner()) return is_short(site.on.index);
    int followed = 0, unresolved = 0;
    const ObstacleTopology& topology = obstacle.topology();
    const int point = features.corners[site.on.index].point;
    for (int k = 0; k < topology.edge_count_at(point); ++k)
        if (const int feature = feature_of_edge(features, topology.edge_at(point, k)); feature >= 0)
            ++(is_short(feature) ? unresolved : followed);
    if (unresolved == 0 || followed > 1) return false;
    return std::any_of(trace_.eol().begin(), trace_.eol().end(), [&](const EolVertex& e) {
        return e.on.obstacle == site.on.obstacle && e.on.is_corner() && e.on != site.on &&
               trace_.is_on_trace(e.vertex_id) && trace_.distance(e, site.material) < kRoom.fixed * cell;
    });
}

/// Whether another edge nearer than the thickness has a trace here: between two traces there would be no
/// room.
bool EolAdmission::is_beside_other(const FeatureSite& site) const
{
    if (site.on.is_corner()) return false;
    const ObstaclePose obstacle = scene_.obstacles[site.on.obstacle].at(state_.time);
    const std::vector<FeatureEdge>& edges = obstacle->features().edges;
    const double h = target_length(scene_, state_, site.material);
    return std::any_of(trace_.eol().begin(), trace_.eol().end(), [&](const EolVertex& e) {
        if (e.on.obstacle != site.on.obstacle || e.on.is_corner() || !trace_.is_on_trace(e.vertex_id) ||
            edges[e.on.index].polyline == edges[site.on.index].polyline ||
            !(trace_.distance(e, site.material) < 1.5 * h))
            return false;
        const Vec3 there = place_on_feature(obstacle, e.on.index, trace_.placed(e).place).point;
        const Vec3 here = place_on_feature(obstacle, site.on.index, there).point;
        return (there - here).norm() < scene_.materials.thickness();
    });
}

/// Whether an EOL vertex belongs to a free fold: one that has left its convex edge.
bool EolAdmission::has_left(const EolVertex& eol) const
{
    const ObstaclePose obstacle = scene_.obstacles[eol.on.obstacle].at(state_.time);
    if (!is_on_convex_edge(obstacle, eol)) return false;
    const Vec3 place = trace_.placed(eol).place;
    return has_left_feature(place_on_feature(obstacle, eol.on.index, place).point, place,
                            scene_.materials.thickness());
}

/// World position of a site on an edge of the cloth; of its vertex where the site has no edge.
Vec3 EolAdmission::world_at(const FeatureSite& site) const
{
    if (site.edge[0] < 0) return state_.mesh.world[state_.index_of(site.near)];
    return place_of_site(state_.mesh, stars_, site, state_.mesh.world);
}

/// Cause if a site follows a free fold over the edge. The cloth that follows is mostly flat, and then needs
/// no EOL vertex. Where it is not flat, it gets a trace of its own, as soon as there is room for two traces.
/// A site in line with the fold belongs to the fold's trace, part of which has returned, and is not refused.
std::optional<ConstraintCause> EolAdmission::find_fold_cause(const FeatureSite& site) const
{
    if (site.on.is_corner()) return std::nullopt;
    const std::optional<double> way = find_free_fold(site);
    if (!way) return std::nullopt;
    const bool is_between = site.contact < 0;  // fills a gap, and does not press itself
    if (is_between || is_along_face(scene_.obstacles[site.on.obstacle].at(state_.time), site))
        return ConstraintCause::FlatBehind;
    // Traces nearer than a cell cannot be distinguished.
    return *way < target_length(scene_, state_, site.material) ? std::optional(ConstraintCause::BesideEol)
                                                               : std::nullopt;
}

/// Distance, m, from the edge to the free fold that a site follows: the least, if there are several. Nothing
/// if the site follows none.
std::optional<double> EolAdmission::find_free_fold(const FeatureSite& site) const
{
    const ObstaclePose obstacle = scene_.obstacles[site.on.obstacle].at(state_.time);
    const std::vector<FeatureEdge>& edges = obstacle->features().edges;
    const Vec3 here = obstacle.placement.inverse(world_at(site));
    const auto [from, to] = feature_segment(obstacle, site.on.index);
    const double h = target_length(scene_, state_, site.material);
    std::optional<double> least;
    for (const EolVertex& e : trace_.eol()) {
        if (e.on.obstacle != site.on.obstacle || e.on.is_corner() || !trace_.is_on_trace(e.vertex_id) ||
            edges[e.on.index].polyline != edges[site.on.index].polyline || !has_left(e))
            continue;
        constexpr double kShare = 0.5;  // least material across, over the fold's distance from the edge
        constexpr double kSoon = 0.05;  // s: longest time of flow between site and fold
        const Vec3 off = trace_.placed(e).place - here;
        const double along = std::abs((to - from).normalized().dot(off));
        const double way = trace_.distance(e, site.material);
        const double across = std::sqrt(std::max(way * way - along * along, 0.0));
        const double left = std::sqrt(std::max(off.squaredNorm() - along * along, 0.0));
        // Twice the distance up to which a fold is held.
        const double reach = std::min(2.0 * kFlyingCells * h, kSoon * trace_.flow(e.vertex_id).norm());
        if (way < reach && along < h && across > kShare * left) least = std::min(least.value_or(left), left);
    }
    return least;
}

std::optional<ConstraintCause> EolAdmission::refuse_inserted(const EolVertex& eol,
                                                             const FeatureSite& site) const
{
    return (site.is_on_fold || is_in_plane(eol)) && is_on_side(eol)
               ? std::nullopt
               : std::optional(ConstraintCause::OffPlane);
}

bool EolAdmission::is_in_plane(const EolVertex& eol) const
{
    const ObstaclePose obstacle = scene_.obstacles[eol.on.obstacle].at(state_.time);
    const Vec3 place = trace_.placed(eol).place;
    if (eol.on.is_corner()) return true;
    const FeatureEdge& edge = obstacle->features().edges[eol.on.index];
    const Vec3 off = way_across(obstacle, eol.on.index, place);
    if (edge.kind != FeatureKind::Convex) return off.norm() <= kOnFeature * scene_.materials.thickness();
    if (has_left(eol))  // a free fold may be anywhere beyond both faces
        return std::all_of(edge.normals.begin(), edge.normals.end(), [&](const Vec3& normal) {
            return normal.dot(off) >= -kOffPlane * scene_.materials.thickness();
        });
    const std::optional<FeatureFrame> frame =
        find_edge_frame(obstacle, eol.on.index, place, {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()});
    const Vec3 across = frame->tangent.cross(frame->outward);
    return std::abs(across.dot(place - frame->point)) <= kOffPlane * scene_.materials.thickness();
}

bool EolAdmission::is_on_side(const EolVertex& eol) const
{
    constexpr double kAlong = 0.5;  // cosine
    const ObstaclePose obstacle = scene_.obstacles[eol.on.obstacle].at(state_.time);
    if (eol.on.is_corner() || obstacle->features().edges[eol.on.index].kind == FeatureKind::Convex)
        return true;
    const Vec3 place = trace_.placed(eol).place;
    const Vec3 from = way_across(obstacle, eol.on.index, place);
    return from.dot(eol.outward) >= kAlong * from.norm();
}

/// Whether a corner or bend has its EOL vertex already: cloth over it gets only one.
bool EolAdmission::has_vertex_on(const FeatureSite& site) const
{
    const double h = target_length(scene_, state_, site.material);
    return std::any_of(trace_.eol().begin(), trace_.eol().end(), [&](const EolVertex& e) {
        return e.on.is_fixed() && e.on == site.on && trace_.is_on_trace(e.vertex_id) &&
               trace_.distance(e, site.material) < h;
    });
}

EolRetention decide_retention(const Scene& scene, const State& state, const ClothStars& stars, int entry,
                              const EolCoordinates& at, const Vec3& place)
{
    const EolVertex& eol = state.eol[entry];
    if (eol.idle < kIdleSteps) return EolRetention::Firm;
    const double gap = way_off(at.frame, place).norm();
    const double cells = is_led_astray(scene, state, eol, at, place) ? kAstrayCells : kFlyingCells;
    if (gap > cells * shortest_cell(scene) &&
        gap > cells * target_length(scene, state, state.mesh.material[at.vertex]))
        return EolRetention::None;
    const bool has_left = gap > kOnFeature * scene.materials.thickness();
    if (has_left && is_corner_under_face(scene, state, eol)) return EolRetention::None;
    if (is_folded(state, stars.faces[at.vertex])) return EolRetention::Firm;
    return has_left ? EolRetention::None : EolRetention::Loose;
}

void retain_between(const Scene& scene, const State& state, const ClothStars& stars,
                    std::vector<EolRetention>& retained)
{
    if (std::find(retained.begin(), retained.end(), EolRetention::Loose) == retained.end()) return;
    std::vector<std::vector<int>> beside(retained.size());
    for (const auto& [a, b] : find_trace_edges(scene.obstacles, state, stars)) {
        if (retained[a] == EolRetention::None || retained[b] == EolRetention::None) continue;
        beside[a].push_back(b);
        beside[b].push_back(a);
    }
    // Cut loose ends off again and again: the Loose vertices that remain lie between Firm ones.
    std::vector<int> open;
    for (std::size_t entry = 0; entry < retained.size(); ++entry) open.push_back(static_cast<int>(entry));
    while (!open.empty()) {
        const int at = open.back();
        open.pop_back();
        if (retained[at] != EolRetention::Loose || beside[at].size() > 1) continue;
        retained[at] = EolRetention::None;
        for (const int next : beside[at]) {
            std::erase(beside[next], at);
            open.push_back(next);
        }
    }
    for (EolRetention& retention : retained)
        if (retention == EolRetention::Loose) retention = EolRetention::Firm;
}

std::vector<EolRelease> find_releases(const Scene& scene, const State& state, const ClothStars& stars)
{
    EolPlacer placer(scene.obstacles, scene.materials.thickness(), state, stars);
    std::vector<EolRetention> retained(state.eol.size(), EolRetention::None);
    std::vector<ConstraintCause> causes(state.eol.size(), ConstraintCause::Released);
    for (int entry = 0; entry < static_cast<int>(state.eol.size()); ++entry) {
        const EolVertex& eol = state.eol[entry];
        const ObstaclePose obstacle = scene.obstacles[eol.on.obstacle].at(state.time);
        const Vec3 place = obstacle.placement.inverse(state.mesh.world[state.index_of(eol.vertex_id)]);
        const EolPlacing placing = placer.place(entry);
        if (!placing.coordinates)
            causes[entry] = placing.refusal;
        else if (is_at_border(scene, state, stars, eol))
            causes[entry] = ConstraintCause::NearBorder;
        else if (is_on_feature(scene, state, eol, place))
            retained[entry] = decide_retention(scene, state, stars, entry, *placing.coordinates, place);
    }
    for (std::size_t entry = 0; entry < retained.size(); ++entry) {
        if (!has_gathered(state.eol[entry]) || retained[entry] == EolRetention::None) continue;
        retained[entry] = EolRetention::None;
        causes[entry] = ConstraintCause::Gathering;
    }
    retain_between(scene, state, stars, retained);
    std::vector<EolRelease> released;
    for (std::size_t entry = 0; entry < retained.size(); ++entry)
        if (retained[entry] != EolRetention::Firm)
            released.push_back({state.eol[entry].vertex_id, causes[entry]});
    return released;
}

}  // namespace arris
