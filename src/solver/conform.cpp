// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/conform.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/feature_frame.h"
#include "geometry/feature_path.h"
#include "geometry/surgery_cleanup.h"
#include "geometry/trace_clearing.h"
#include "geometry/trace_insertion.h"
#include "solver/border_room.h"
#include "solver/eol_coordinates.h"
#include "solver/eol_guard.h"
#include "solver/eol_release.h"
#include "solver/feature_flow.h"
#include "solver/feature_sites.h"
#include "solver/free_fold.h"
#include "solver/held_vertices.h"
#include "solver/trace_order.h"

namespace arris {

namespace {

// Target lengths to a border ahead, below which no vertex is made.
constexpr double kInsertRoom = 0.3, kCornerInsertRoom = 0.5;
// Of flow that must find material ahead. A step may take 30 % of a face's material: of what has room for four
// no more than that also where the flow gets faster.
constexpr double kClearSteps = 4.0;

/// Tags of the surgery: one a polyline and one a corner of each obstacle.
class FeatureTags {
  public:
    explicit FeatureTags(const std::vector<Obstacle>& obstacles) : obstacles_(obstacles)
    {
        for (const Obstacle& obstacle : obstacles) {
            first_.push_back(count_);
            const ObstacleFeatures& features = obstacle.features();
            count_ += features.polyline_count + static_cast<int>(features.corners.size());
        }
    }

    int tag(std::int32_t obstacle, bool is_corner, std::int32_t feature) const
    {
        const ObstacleFeatures& features = obstacles_[obstacle].features();
        return first_[obstacle] +
               (is_corner ? features.polyline_count + feature : features.edges[feature].polyline);
    }
    int tag(const EolVertex& vertex) const { return tag(vertex.obstacle, vertex.is_corner, vertex.feature); }

  private:
    const std::vector<Obstacle>& obstacles_;
    std::vector<int> first_;
    int count_ = 0;
};

class Conforming {
  public:
    Conforming(const Scene& scene, double dt, const State& state, const ClothStars& stars,
               const FeatureChanges& changes, StrainLimit limit)
        : scene_(scene),
          dt_(dt),
          state_(state),
          stars_(stars),
          changes_(changes),
          target_(*scene.eol),
          tags_(scene.obstacles),
          guard_(scene, state, limit)
    {
    }

    ConformOutcome run(const FailedFlow& failed)
    {
        std::optional<ConformedMesh> mesh = find_mesh(failed);
        return {std::move(mesh), std::move(refused_)};
    }

  private:
    std::optional<ConformedMesh> find_mesh(const FailedFlow& failed)
    {
        if (changes_.released.empty() && changes_.sites.empty() && failed.empty() && !is_flowing())
            return std::nullopt;
        surgery_.emplace(state_.mesh, state_.ids, state_.next_id, pinned(), stars_.topology.edges);
        guard_.watch(*surgery_);
        surgery_->set_guard(
            [this](const SurgeryEvent& event) { return keeps_way(event) && guard_.allows(event); });
        mark();
        for (const VertexId v : changes_.released) give_up(v, cause_of_release(v));
        for (const VertexId v : failed.given_up)
            if (is_on_trace(v)) give_up(v, RowCause::GivenUp);
        for (const auto& [v, flow] : failed.flow) expect_flow(v, flow);
        clear_way();
        forget_released();
        has_failed_ = !failed.given_up.empty();
        is_inserting_ = true;
        for (const FeatureSite& site : changes_.sites) insert(site);
        is_inserting_ = false;
        join();
        report_.operations += clean_up(*surgery_, target_).operations();
        if (report_.inserted > 0) {  // theirs, too, must be clear
            clear_way();
            report_.operations += clean_up(*surgery_, target_).operations();
        }
        if (surgery_->events().empty() && report_.released == 0 && report_.inserted == 0) return std::nullopt;
        return result();
    }

    bool is_flowing() const
    {
        return std::any_of(state_.eol.begin(), state_.eol.end(), [&](const EolVertex& e) {
            return !state_.material_velocity[state_.index_of(e.vertex_id)].isZero();
        });
    }

    std::vector<VertexId> pinned() const
    {
        std::vector<VertexId> ids;
        for (const HeldVertex& held : find_held_vertices(scene_, state_, state_.time + dt_))
            ids.push_back(state_.ids[held.vertex]);
        return ids;
    }

    /// Tells the surgery what is on features already.
    void mark()
    {
        for (const EolVertex& e : state_.eol)
            surgery_->set_role(e.vertex_id, e.is_corner ? TraceRole::Node : TraceRole::OnTrace, tags_.tag(e));
        for (const auto& [a, b] : find_trace_edges(scene_.obstacles, state_, stars_)) {
            const EolVertex &p = state_.eol[a], &q = state_.eol[b];
            surgery_->set_edge_tag(p.vertex_id, q.vertex_id, tags_.tag(p.is_corner ? q : p));
        }
        surgery_->take_touched();
        eol_ = state_.eol;
        for (const EolVertex& e : eol_)
            flow_[e.vertex_id] = state_.material_velocity[state_.index_of(e.vertex_id)];
    }

    /// With which an attempt has failed. That may be wild: what is cleared for it is a cell, or twice what
    /// the flow that is there asks for.
    void expect_flow(VertexId v, const Vec2& failed)
    {
        if (!is_on_trace(v)) return;
        Vec2& flow = flow_[v];
        const double cell = target_.length(surgery_->material(v)) / (kClearSteps * dt_);
        flow = failed * std::min(1.0, std::max(2.0 * flow.norm(), cell) / failed.norm());
    }

    PlacedEol placed(const EolVertex& eol) const
    {
        return {eol, scene_.obstacles[eol.obstacle].at(state_.time).inverse(surgery_->world(eol.vertex_id))};
    }

    void clear_way()
    {
        std::vector<TraceAdvance> advances;
        for (const EolVertex& e : eol_)
            if (is_on_trace(e.vertex_id))
                advances.push_back({e.vertex_id, kClearSteps * dt_ * flow_.at(e.vertex_id)});
        if (advances.empty()) return;
        guard_.set_clearing(true);
        const ClearanceReport cleared = clear_ahead(*surgery_, target_, advances);
        guard_.set_clearing(false);
        report_.operations += cleared.operations;
        ways_ = cleared.ways;
        needed_ = cleared.needed;
        // What stands in the way and cannot give way: there the feature is met by rows. Only there: the rest
        // of the trace carries the cloth on.
        for (const VertexId v : cleared.blocked) give_up(v, RowCause::Blocked);
        for (const TraceAdvance& advance : advances) report_.lost += is_on_trace(advance.vertex) ? 0 : 1;
    }

    /// What has been cleared stays clear.
    bool keeps_way(const SurgeryEvent& event) const
    {
        const TraceWays& ways = is_inserting_ ? needed_ : ways_;
        const auto is_in_way = [&](const PatchFace& face) { return turns_over(face, ways); };
        return ways.empty() || std::none_of(event.after.begin(), event.after.end(), is_in_way) ||
               std::any_of(event.before.begin(), event.before.end(), is_in_way);
    }

    void release(VertexId v)
    {
        surgery_->release_vertex(v);
        ++report_.released;
    }

    /// What a site takes again begins anew.
    void forget_released()
    {
        std::erase_if(eol_, [this](const EolVertex& e) { return !is_on_trace(e.vertex_id); });
        const auto is_gone = [this](const auto& of) { return !is_on_trace(of.first); };
        std::erase_if(flow_, is_gone);
        std::erase_if(ways_, is_gone);
        std::erase_if(needed_, is_gone);
    }

    bool is_on_trace(VertexId v) const
    {
        return surgery_->has_vertex(v) && surgery_->role(v) != TraceRole::Free;
    }

    /// Where a vertex is in `eol_`, or would be.
    std::vector<EolVertex>::const_iterator place_of(VertexId v) const
    {
        return std::lower_bound(eol_.begin(), eol_.end(), v,
                                [](const EolVertex& e, VertexId id) { return e.vertex_id < id; });
    }

    const EolVertex* find_eol(VertexId v) const
    {
        const auto at = place_of(v);
        return at != eol_.end() && at->vertex_id == v ? &*at : nullptr;
    }

    /// Why the cloth's border leaves no room for a vertex; nothing where it does. `v` is the site's vertex,
    /// `flow` (m/s) the material's over the feature there.
    std::optional<RowCause> find_border_cause(const FeatureSite& site, int v, const Vec2& flow) const
    {
        const double h = target_.length(site.material);
        const EolVertex eol{site.near, site.obstacle, site.is_corner, site.feature, site.outward, 0};
        if (site.is_on_border && !site.is_corner && is_along_border(scene_, state_, stars_, site.edge, eol))
            return RowCause::AlongBorder;
        const auto room_at = [&](const Vec2& X) {
            return room_to_border(scene_, state_, stars_, X, v, site.is_on_border, eol);
        };
        const double room = room_at(site.material);
        if (room < (site.is_corner ? kCornerInsertRoom : kInsertRoom) * h) return RowCause::NearBorder;
        // What comes fast would have to go at once.
        constexpr double kAside = 1e-3;  // of the target length: to see how fast the room closes
        const Vec2 aside = kAside * h * flow.stableNormalized();
        const double closing = (room - room_at(site.material + aside)) / (kAside * h) * flow.norm();
        if (room < kClearSteps * dt_ * closing) return RowCause::BorderAhead;
        return std::nullopt;
    }

    /// Of edges nearer to each other than the cloth is thick one has a trace: between two there is no room.
    bool is_beside_other(const FeatureSite& site) const
    {
        if (site.is_corner) return false;
        const Obstacle& obstacle = scene_.obstacles[site.obstacle];
        const std::vector<FeatureEdge>& edges = obstacle.features().edges;
        const double h = target_.length(site.material);
        return std::any_of(eol_.begin(), eol_.end(), [&](const EolVertex& e) {
            if (e.obstacle != site.obstacle || e.is_corner || !is_on_trace(e.vertex_id) ||
                edges[e.feature].polyline == edges[site.feature].polyline ||
                !((surgery_->material(e.vertex_id) - site.material).norm() < 1.5 * h))
                return false;
            const Vec3 there = place_on_feature(obstacle, e.feature, placed(e).place).point;
            const Vec3 here = place_on_feature(obstacle, site.feature, there).point;
            return (there - here).norm() < scene_.material.thickness;
        });
    }

    /// Whether an EOL vertex is of a fold that has left its edge.
    bool has_left(const EolVertex& eol) const
    {
        const Obstacle& obstacle = scene_.obstacles[eol.obstacle];
        if (!is_on_convex_edge(obstacle, eol)) return false;
        const Vec3 place = placed(eol).place;
        return has_left_feature(place_on_feature(obstacle, eol.feature, place).point, place,
                                scene_.material.thickness);
    }

    /// Where a site on an edge of the cloth is.
    Vec3 world_at(const FeatureSite& site) const
    {
        const auto& [a, b] = site.edge;
        if (a < 0) return state_.mesh.world[state_.index_of(site.near)];
        const std::vector<Vec2>& X = state_.mesh.material;
        const double length = (X[b] - X[a]).norm();
        const double s = length > 0.0 ? (site.material - X[a]).norm() / length : 0.0;
        return (1.0 - s) * state_.mesh.world[a] + s * state_.mesh.world[b];
    }

    /// Where a fold has left an edge, what follows it over the edge, as much material away as the fold is
    /// from the edge, is not folded. What is in one line with the fold is, where some of it has come back.
    bool follows_free_fold(const FeatureSite& site) const
    {
        if (site.is_corner) return false;
        const Obstacle& obstacle = scene_.obstacles[site.obstacle];
        const std::vector<FeatureEdge>& edges = obstacle.features().edges;
        const Vec3 here = obstacle.at(state_.time).inverse(world_at(site));
        const auto [from, to] = feature_segment(obstacle, site.feature);
        const double h = target_.length(site.material);
        return std::any_of(eol_.begin(), eol_.end(), [&](const EolVertex& e) {
            if (e.obstacle != site.obstacle || e.is_corner || !is_on_trace(e.vertex_id) ||
                edges[e.feature].polyline != edges[site.feature].polyline || !has_left(e))
                return false;
            constexpr double kShare = 0.5;  // of the fold's way from the edge
            constexpr double kSoon = 0.05;  // s, in which it flows through the fold
            const Vec3 off = placed(e).place - here;
            const double along = std::abs((to - from).normalized().dot(off));
            const double way = (surgery_->material(e.vertex_id) - site.material).norm();
            const double across = std::sqrt(std::max(way * way - along * along, 0.0));
            const double reach = std::min(kFreeCells * h, kSoon * flow_.at(e.vertex_id).norm());
            return way < reach && along < h &&
                   across > kShare * std::sqrt(std::max(off.squaredNorm() - along * along, 0.0));
        });
    }

    void insert(const FeatureSite& site)
    {
        const std::optional<RowCause> cause = try_insert(site);
        if (cause && site.contact >= 0) refuse(state_.active[site.contact], *cause);
    }

    /// Why there is no new EOL vertex; nothing where there is one.
    std::optional<RowCause> try_insert(const FeatureSite& site)
    {
        const int tag = tags_.tag(site.obstacle, site.is_corner, site.feature);
        if (has_failed_) return RowCause::GivenUp;  // the step has failed on the vertices there were
        const int v = state_.index_of(site.near);
        const Vec2 flow = find_feature_flow(scene_, state_, stars_, v, site.obstacle);
        if (const std::optional<RowCause> border = find_border_cause(site, v, flow)) return border;
        if (is_beside_other(site)) return RowCause::OtherFeature;
        if (follows_free_fold(site)) return RowCause::BesideEol;
        if (site.is_corner && has_vertex_on(site)) return RowCause::BesideEol;
        const VertexId near = surgery_->has_vertex(site.near) ? site.near : nearest_to(site.material);
        const TraceInsertion made = insert_trace_point(
            *surgery_, target_, site.material, near,
            {site.is_corner ? TraceRole::Node : TraceRole::OnTrace, tag, kClearSteps * dt_ * flow});
        if (made.verdict != Verdict::Done)
            return made.verdict == Verdict::Guard ? RowCause::Guard : RowCause::Quality;
        if (find_eol(made.vertex)) return RowCause::BesideEol;
        const EolVertex vertex{made.vertex, site.obstacle, site.is_corner, site.feature, site.outward, 0};
        if (!is_in_plane(vertex) || !is_on_side(vertex)) {
            surgery_->release_vertex(made.vertex);
            return RowCause::OffPlane;
        }
        eol_.insert(place_of(made.vertex), vertex);
        flow_.try_emplace(made.vertex, flow);
        if (site.contact >= 0) contact_of_[made.vertex] = site.contact;
        ++report_.inserted;
        return std::nullopt;
    }

    RowCause cause_of_release(VertexId v) const
    {
        const int entry = state_.eol_entry(v);
        const EolVertex& eol = state_.eol[entry];
        const Obstacle& obstacle = scene_.obstacles[eol.obstacle];
        const Placement now = obstacle.at(state_.time);
        const EolPlacing placing =
            place_eol_vertex(obstacle, scene_.material.thickness, state_, entry, stars_, now);
        if (!placing.coordinates) return cause_of(placing.refusal);
        return is_at_border(scene_, state_, stars_, eol) ? RowCause::NearBorder : RowCause::Released;
    }

    /// A vertex that is EOL, or has just been made, is none from now on: what presses there is a row.
    void give_up(VertexId v, RowCause cause)
    {
        release(v);
        const int entry = state_.eol_entry(v);
        const auto made = contact_of_.find(v);
        constexpr std::uint32_t kNone = ActiveContact::kNoVertex;
        if (entry >= 0)
            refused_.push_back(
                {{v, kNone, kNone}, ContactKind::Vertex, state_.eol[entry].obstacle, -1, cause});
        else if (made != contact_of_.end())
            refuse(state_.active[made->second], cause);
    }

    void refuse(const ActiveContact& contact, RowCause cause)
    {
        refused_.push_back({contact.vertex_ids, contact.kind, contact.obstacle, contact.element, cause});
    }

    /// Surgery at one site bends the surface a little differently at the next. Off the plane of a convex edge
    /// a vertex would stay off it, as it may only move in it.
    bool is_in_plane(const EolVertex& eol) const
    {
        constexpr double kOff = 0.1;  // thicknesses
        const Obstacle& obstacle = scene_.obstacles[eol.obstacle];
        const Vec3 place = placed(eol).place;
        if (eol.is_corner || has_left(eol)) return true;
        if (obstacle.features().edges[eol.feature].kind != FeatureKind::Convex)
            return (place - place_on_feature(obstacle, eol.feature, place).point).norm() <=
                   kOnFeature * scene_.material.thickness;
        const std::optional<FeatureFrame> frame =
            find_edge_frame(obstacle, eol.feature, place, {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()});
        const Vec3 across = frame->tangent.cross(frame->outward);
        return std::abs(across.dot(place - frame->point)) <= kOff * scene_.material.thickness;
    }

    /// Whether a vertex that is to be on a wire or border is on the side to which that has pressed. Its
    /// outward direction is where it is, and would be against what presses beside it.
    bool is_on_side(const EolVertex& eol) const
    {
        constexpr double kAlong = 0.5;  // cosine
        const Obstacle& obstacle = scene_.obstacles[eol.obstacle];
        if (eol.is_corner || obstacle.features().edges[eol.feature].kind == FeatureKind::Convex) return true;
        const Vec3 place = placed(eol).place;
        const Vec3 from = place - place_on_feature(obstacle, eol.feature, place).point;
        return from.dot(eol.outward) >= kAlong * from.norm();
    }

    /// A corner holds one vertex of a cloth that lies over it.
    bool has_vertex_on(const FeatureSite& corner) const
    {
        const double h = target_.length(corner.material);
        return std::any_of(eol_.begin(), eol_.end(), [&](const EolVertex& e) {
            return e.is_corner && e.obstacle == corner.obstacle && e.feature == corner.feature &&
                   is_on_trace(e.vertex_id) && (surgery_->material(e.vertex_id) - corner.material).norm() < h;
        });
    }

    VertexId nearest_to(const Vec2& material) const
    {
        VertexId nearest = kNoVertex;
        double least = 0.0;
        for (std::size_t v = 0; v < state_.ids.size(); ++v) {
            if (!surgery_->has_vertex(state_.ids[v])) continue;
            const double distance = (state_.mesh.material[v] - material).squaredNorm();
            if (nearest != kNoVertex && distance >= least) continue;
            nearest = state_.ids[v];
            least = distance;
        }
        return nearest;
    }

    /// Neighbours along a feature that are neighbours in the mesh, too, get a mesh edge between them.
    void join()
    {
        std::vector<PlacedEol> on_trace;
        for (const EolVertex& e : eol_)
            if (is_on_trace(e.vertex_id)) on_trace.push_back(placed(e));
        for (const auto& [a, b] : find_trace_neighbours(scene_.obstacles, on_trace)) join(*a, *b);
    }

    void join(const EolVertex& a, const EolVertex& b)
    {
        if (!is_on_trace(a.vertex_id) || !is_on_trace(b.vertex_id)) return;
        if (!is_trace_edge(scene_.obstacles[a.obstacle], placed(a), placed(b))) return;
        if (surgery_->edge_tag(a.vertex_id, b.vertex_id) != kNoTag) return;
        const int tag = tags_.tag(a.is_corner ? b : a);
        if (surgery_->has_edge(a.vertex_id, b.vertex_id))
            surgery_->set_edge_tag(a.vertex_id, b.vertex_id, tag);
        else if (share_neighbours(a.vertex_id, b.vertex_id))
            join_trace_vertices(*surgery_, target_, a.vertex_id, b.vertex_id, tag);
    }

    /// Two vertices across one edge.
    bool share_neighbours(VertexId a, VertexId b) const
    {
        for (const IdFace& face : surgery_->faces_at(a))
            if (surgery_->apex(face[2], face[1]) == b) return true;
        return false;
    }

    ConformedMesh result() const
    {
        ConformedMesh made{surgery_->result(), surgery_->events(), {}, report_};
        for (std::size_t v = 0; v < made.surgery.ids.size(); ++v) {
            if (made.surgery.roles[v] == TraceRole::Free) continue;
            const VertexId id = made.surgery.ids[v];
            if (const EolVertex* known = find_eol(id))
                made.eol.push_back(*known);
            else if (const auto between = on_trace_of(id, made.surgery.tags[v]);
                     between && is_in_plane(*between))
                made.eol.push_back(*between);
        }
        return made;
    }

    /// A vertex that clean-up or a join has put on a trace is like its neighbour on it.
    std::optional<EolVertex> on_trace_of(VertexId id, int tag) const
    {
        for (const VertexId w : surgery_->ring(id).vertices) {
            const EolVertex* known = find_eol(w);
            if (!known || known->is_corner) continue;
            if (tags_.tag(*known) != tag) continue;
            EolVertex made = *known;
            made.vertex_id = id;
            made.idle = 0;
            const Obstacle& obstacle = scene_.obstacles[made.obstacle];
            made.feature = follow_polyline(obstacle, made.feature, placed(made).place).feature;
            return made;
        }
        return std::nullopt;
    }

    const Scene& scene_;
    double dt_;
    const State& state_;
    const ClothStars& stars_;
    const FeatureChanges& changes_;
    const MeshTarget& target_;
    FeatureTags tags_;
    std::optional<ClothSurgery> surgery_;
    std::vector<EolVertex> eol_;
    std::map<VertexId, Vec2> flow_;  ///< m/s, of those in `eol_`
    EolGuard guard_;
    TraceWays ways_;    ///< of the vertices that flow, as far as is well
    TraceWays needed_;  ///< as far as they may soon go: new vertices leave that much
    bool is_inserting_ = false;
    std::map<VertexId, int> contact_of_;  ///< index in State::active, of vertices made where one pressed
    std::vector<RefusedContact> refused_;
    bool has_failed_ = false;  ///< an attempt, on the vertices there were
    ConformReport report_;
};

}  // namespace

FeatureChanges find_feature_changes(const Scene& scene, const State& state, const ClothStars& stars)
{
    if (!scene.eol) return {};
    return {find_releases(scene, state, stars), find_feature_sites(scene, state, stars)};
}

ConformOutcome conform_mesh(const Scene& scene, double dt, const State& state, const ClothStars& stars,
                            const FeatureChanges& changes, const FailedFlow& failed, StrainLimit limit)
{
    if (!scene.eol || (state.eol.empty() && state.active.empty())) return {};
    return Conforming(scene, dt, state, stars, changes, limit).run(failed);
}

}  // namespace arris
