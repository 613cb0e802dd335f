// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh_change/conform.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/obstacle/feature_nodes.h"
#include "geometry/surgery/material_walk.h"
#include "geometry/surgery/surgery_cleanup.h"
#include "geometry/surgery/trace_clearing.h"
#include "geometry/surgery/trace_insertion.h"
#include "solver/eol/eol_coordinates.h"
#include "solver/eol/eol_features.h"
#include "solver/model/pin_targets.h"
#include "solver/sites/eol_release.h"
#include "solver/sites/feature_flow.h"
#include "solver/sites/site_admission.h"
#include "solver/sites/trace_mesh.h"
#include "solver/sites/trace_order.h"

namespace arris {

namespace {

// Of flow that must find material ahead. A step may take 60 % of a face's material: of what has room for four
// no more than that also where the flow gets faster, or those beside it do.
constexpr double kClearSteps = 4.0;

// Of a tip's the next must be. There is no trace that would carry the cloth on, and what stands in the
// way of a point is a pleat, which takes the less strain to merge the nearer it is: one that is let go for a
// step slips into the pleat, and is held there by rows for good.
constexpr double kPointSteps = 1.0;

// Of cloth folded over a wire or a sheet's border: as long as a step can be made, which takes 60 % of what is
// there at most. What is ahead may hang on the fold's other side for some steps, as both sides swing, and
// cannot be merged past the wire; and rows at a vertex that is let go hold the fold from both sides.
constexpr double kWireSteps = 1.0 / 0.6;

std::vector<VertexId> find_pinned(const Scene& scene, const State& state, double end)
{
    std::vector<VertexId> ids;
    for (const PinTarget& held : find_pin_targets(scene, state, end)) ids.push_back(state.ids[held.vertex]);
    return ids;
}

bool is_flowing(const State& state)
{
    return std::any_of(state.eol.begin(), state.eol.end(), [&](const EolVertex& e) {
        return !state.material_velocity[state.index_of(e.vertex_id)].isZero();
    });
}

class Conforming {
  public:
    Conforming(const Scene& scene, double dt, const State& state, const ClothStars& stars,
               const ConformLimits& limits, RelaxationMemo& relaxations)
        : scene_(scene),
          state_(state),
          stars_(stars),
          target_(*scene.eol),
          soon_(kClearSteps * dt),
          trace_(scene, state, stars, find_pinned(scene, state, state.time + dt)),
          surgery_(trace_.surgery()),
          admission_(scene, state, stars, trace_, soon_),
          placer_(scene.obstacles, scene.material.thickness, state, stars),
          limits_(limits),
          guard_(scene, state, limits.strain, limits.careful_at, relaxations)
    {
        guard_.watch(surgery_);
        surgery_.set_guard(
            [this](const SurgeryEvent& event) { return keeps_way(event) && guard_.allows(event); });
    }

    ConformOutcome run(const FeatureChanges& changes, const FailedFlow& failed)
    {
        std::optional<ConformedMesh> mesh = find_mesh(changes, failed);
        return {std::move(mesh), std::move(refused_), lost_, blocked_, guard_.relies_at()};
    }

  private:
    std::optional<ConformedMesh> find_mesh(const FeatureChanges& changes, const FailedFlow& failed)
    {
        for (const VertexId v : changes.released) demote_to_row(v, cause_of_release(v));
        for (const VertexId v : failed.given_up)
            if (trace_.is_on_trace(v)) demote_to_row(v, RowCause::GivenUp);
        for (const auto& [v, flow] : failed.flow) expect_flow(v, flow);
        clear_way();
        if (lost_ > limits_.lost || blocked_ > limits_.blocked) return std::nullopt;
        forget_released();
        insert(changes.sites, failed);
        join();
        report_.operations += clean_up(surgery_, target_).operations();
        if (report_.inserted > 0) {  // theirs, too, must be clear
            clear_way();
            report_.operations += clean_up(surgery_, target_).operations();
        }
        if (surgery_.events().empty() && report_.released == 0 && report_.inserted == 0) return std::nullopt;
        return result(failed);
    }

    /// With which an attempt has failed. That may be wild: what is cleared for it is a cell, or twice what
    /// the flow that is there asks for.
    void expect_flow(VertexId v, const Vec2& failed)
    {
        if (!trace_.is_on_trace(v)) return;
        const double cell = target_.length(surgery_.material(v)) / soon_;
        const double most = std::max(2.0 * trace_.flow(v).norm(), cell);
        trace_.set_flow(v, failed * std::min(1.0, most / failed.norm()));
    }

    /// Of its flow, without which a vertex is let go.
    double least_steps(const EolVertex& eol) const
    {
        const Obstacle& obstacle = scene_.obstacles[eol.on.obstacle];
        if (eol.on.is_corner()) return is_tip(obstacle, eol.on.index) ? kPointSteps : kClearSteps;
        return is_on_convex_edge(obstacle, eol) ? kClearSteps : kWireSteps;
    }

    TraceAdvance advance_of(const EolVertex& e) const
    {
        return {e.vertex_id, soon_ * trace_.flow(e.vertex_id), least_steps(e) / kClearSteps};
    }

    /// Where the cloth's border comes so soon no clearing helps, and as ordinary vertices they are in no
    /// one's way.
    void demote_leaving()
    {
        for (const EolVertex& e : trace_.eol()) {
            if (!trace_.is_on_trace(e.vertex_id)) continue;
            const TraceAdvance advance = advance_of(e);
            if (leads_off(surgery_, e.vertex_id, advance.least * advance.ahead))
                demote_to_row(e.vertex_id, RowCause::Blocked);
        }
    }

    void clear_way()
    {
        demote_leaving();
        std::vector<TraceAdvance> advances;
        for (const EolVertex& e : trace_.eol())
            if (trace_.is_on_trace(e.vertex_id)) advances.push_back(advance_of(e));
        if (advances.empty()) return;
        guard_.set_clearing(true);
        const ClearanceReport cleared = clear_ahead(surgery_, target_, advances);
        guard_.set_clearing(false);
        report_.operations += cleared.operations;
        ways_ = cleared.ways;
        needed_ = cleared.needed;
        // What stands in the way and cannot give way: there the feature is met by rows. Only there: the rest
        // of the trace carries the cloth on.
        for (const VertexId v : cleared.blocked) demote_to_row(v, RowCause::Blocked);
        blocked_ += static_cast<int>(cleared.blocked.size());
        for (const TraceAdvance& advance : advances) lost_ += trace_.is_on_trace(advance.vertex) ? 0 : 1;
    }

    /// What has been cleared stays clear.
    bool keeps_way(const SurgeryEvent& event)
    {
        if (making_ && !event.changes.empty()) name_made(event.changes[0].vertex);
        const auto is_in_way = [&](const PatchFace& face) { return stands_in_way(face); };
        return kept_->empty() || std::none_of(event.after.begin(), event.after.end(), is_in_way) ||
               std::any_of(event.before.begin(), event.before.end(), is_in_way);
    }

    /// A new vertex may be in the way only where it is also as it goes its own: beside others on its obstacle
    /// it goes with them.
    bool stands_in_way(const PatchFace& face) const
    {
        if (!turns_over(face, *kept_)) return false;
        TraceWays together;
        for (const VertexId v : face.vertices)
            for (const TraceWays* ways : {&coming_, kept_})
                if (const auto at = ways->find(v); at != ways->end()) together[v] = at->second;
        return turns_over(face, together);
    }

    void release(VertexId v)
    {
        surgery_.release_vertex(v);
        ++report_.released;
    }

    /// What a site takes again begins anew.
    void forget_released()
    {
        trace_.forget_released();
        const auto is_gone = [this](const auto& of) { return !trace_.is_on_trace(of.first); };
        std::erase_if(ways_, is_gone);
        std::erase_if(needed_, is_gone);
    }

    void insert(const std::vector<FeatureSite>& sites, const FailedFlow& failed)
    {
        kept_ = &needed_;
        for (const FeatureSite& site : sites) {
            // The step has failed on the vertices there were, or on one that was made here.
            const bool has_failed = !failed.given_up.empty() || is_near_failed(site.material, failed);
            const std::optional<RowCause> cause = has_failed ? RowCause::GivenUp : try_insert(site);
            if (cause && site.contact >= 0) refuse(state_.active[site.contact], *cause);
        }
        kept_ = &ways_;
    }

    /// Where a new vertex was, a moment ago, that had not enough material.
    bool is_near_failed(const Vec2& material, const FailedFlow& failed) const
    {
        constexpr double kNear = 0.5;  // target lengths: clean-up may have moved it
        const double reach = kNear * target_.length(material);
        return std::any_of(failed.made_at.begin(), failed.made_at.end(),
                           [&](const Vec2& at) { return (at - material).norm() < reach; });
    }

    /// Why there is no new EOL vertex; nothing where there is one.
    std::optional<RowCause> try_insert(const FeatureSite& site)
    {
        const int v = state_.index_of(site.near);
        const Vec2 flow = find_feature_flow(scene_, state_, stars_, site);
        if (const std::optional<RowCause> cause = admission_.find_refusal(site, v, flow)) return cause;
        if (site.on.is_bend()) {
            const std::optional<VertexId> beside = find_beside(site);
            if (beside && surgery_.role(*beside) == TraceRole::Node) return RowCause::BesideEol;
            if (beside && lock_at_bend(*beside, site)) return std::nullopt;
        }
        const TraceVertex wanted{site.on.is_fixed() ? TraceRole::Node : TraceRole::OnTrace,
                                 trace_.tags().tag(site.on), soon_ * flow};
        const VertexId near = surgery_.has_vertex(site.near) ? site.near : trace_.nearest_to(site.material);
        const TraceInsertion made = make_vertex(site.material, near, wanted);
        if (made.verdict != Verdict::Done)
            return made.verdict == Verdict::Guard ? RowCause::Guard : RowCause::Quality;
        if (trace_.find(made.vertex))
            return site.is_in_face() && slide_to(made.vertex, site) ? std::nullopt
                                                                    : std::optional(RowCause::BesideEol);
        EolVertex vertex{made.vertex, site.on, site.outward, 0};
        vertex.side = trace_.side_beside(wanted.tag, site.material);
        if (!admission_.is_in_plane(vertex) || !admission_.is_on_side(vertex)) {
            surgery_.release_vertex(made.vertex);
            coming_.erase(made.vertex);
            return RowCause::OffPlane;
        }
        trace_.add(vertex, flow);
        if (site.contact >= 0) contact_of_[made.vertex] = site.contact;
        ++report_.inserted;
        return std::nullopt;
    }

    TraceInsertion make_vertex(const Vec2& material, VertexId near, const TraceVertex& wanted)
    {
        making_ = &wanted;
        const TraceInsertion made = insert_trace_point(surgery_, target_, material, near, wanted);
        coming_.erase(made_);  // proposed last, which need not be the one that was made
        if (made.verdict == Verdict::Done && !trace_.find(made.vertex)) coming_[made.vertex] = wanted.way;
        making_ = nullptr;
        made_ = kNoVertex;
        return made;
    }

    /// The vertex that is proposed to become the one that is being made.
    void name_made(VertexId v)
    {
        coming_.erase(made_);
        made_ = v;
        coming_[v] = making_->way;
    }

    /// The vertex of its trace that is in a turn's way: one that is held, nearer than two may be, else one
    /// that slides, nearer than clean-up lets two be.
    std::optional<VertexId> find_beside(const FeatureSite& bend) const
    {
        constexpr double kLocked = 0.2, kSliding = 0.5;  // target lengths
        const int tag = trace_.tags().tag(bend.on);
        const double h = target_.length(bend.material);
        double least = kSliding * h;
        std::optional<VertexId> nearest;
        for (const EolVertex& e : trace_.eol()) {
            if (!trace_.is_on_trace(e.vertex_id) || surgery_.tag(e.vertex_id) != tag) continue;
            const double distance = (surgery_.material(e.vertex_id) - bend.material).norm();
            const bool is_locked = surgery_.role(e.vertex_id) == TraceRole::Node;
            if (is_locked && distance < kLocked * h) return e.vertex_id;
            if (is_locked || !(distance < least)) continue;
            nearest = e.vertex_id;
            least = distance;
        }
        return nearest;
    }

    /// One that slides beside a bend that presses goes there.
    bool slide_to(VertexId v, const FeatureSite& bend)
    {
        if (trace_.find(v)->on.is_fixed() ||
            surgery_.commit(surgery_.propose_moves({{v, bend.material}})) != Verdict::Done)
            return false;
        trace_.slide(v, bend.on.index);
        return true;
    }

    bool lock_at_bend(VertexId v, const FeatureSite& bend)
    {
        if (surgery_.commit(surgery_.propose_moves({{v, bend.material}})) != Verdict::Done) return false;
        trace_.lock(v, bend.on);
        ++report_.inserted;
        return true;
    }

    RowCause cause_of_release(VertexId v)
    {
        const int entry = state_.eol_entry(v);
        const EolPlacing placing = placer_.place(entry);
        if (!placing.coordinates) return placing.refusal;
        return is_at_border(scene_, state_, stars_, state_.eol[entry]) ? RowCause::NearBorder
                                                                       : RowCause::Released;
    }

    /// A vertex that is EOL, or has just been made, is none from now on: what presses there is a row.
    void demote_to_row(VertexId v, RowCause cause)
    {
        release(v);
        const int entry = state_.eol_entry(v);
        const auto made = contact_of_.find(v);
        constexpr std::uint32_t kNone = ActiveContact::kNoVertex;
        if (entry >= 0)
            refused_.push_back(
                {{v, kNone, kNone}, ContactKind::Vertex, state_.eol[entry].on.obstacle, -1, cause});
        else if (made != contact_of_.end())
            refuse(state_.active[made->second], cause);
    }

    void refuse(const ActiveContact& contact, RowCause cause)
    {
        refused_.push_back({contact.vertex_ids, contact.kind, contact.obstacle, contact.element, cause});
    }

    /// Neighbours along a feature that are neighbours in the mesh, too, get a mesh edge between them.
    void join()
    {
        const std::vector<PlacedEol> placed = trace_.placed();
        for (const auto& [a, b] : find_trace_neighbours(scene_.obstacles, placed)) join(*a, *b);
    }

    void join(const EolVertex& p, const EolVertex& q)
    {
        const VertexId a = p.vertex_id, b = q.vertex_id;
        if (!trace_.is_on_trace(a) || !trace_.is_on_trace(b)) return;
        if (!is_trace_edge(scene_.obstacles[p.on.obstacle], trace_.placed(p), trace_.placed(q))) return;
        if (surgery_.edge_tag(a, b) != kNoTag) return;
        const int tag = trace_.tags().tag(p.on.is_corner() ? q : p);
        if (surgery_.has_edge(a, b))
            surgery_.set_edge_tag(a, b, tag);
        else if (share_neighbours(a, b))
            join_trace_vertices(surgery_, target_, a, b, tag);
    }

    /// Two vertices across one edge.
    bool share_neighbours(VertexId a, VertexId b) const
    {
        for (const IdFace& face : surgery_.faces_at(a))
            if (surgery_.apex(face[2], face[1]) == b) return true;
        return false;
    }

    ConformedMesh result(const FailedFlow& failed) const
    {
        ConformedMesh made{surgery_.result(), surgery_.events(), {}, report_};
        for (std::size_t v = 0; v < made.surgery.ids.size(); ++v) {
            if (made.surgery.roles[v] == TraceRole::Free) continue;
            const VertexId id = made.surgery.ids[v];
            if (const EolVertex* known = trace_.find(id))
                made.eol.push_back(*known);
            else if (const auto between = trace_.like_neighbour(id, made.surgery.tags[v]);
                     between && admission_.is_in_plane(*between) &&
                     !is_near_failed(surgery_.material(id), failed))
                made.eol.push_back(*between);
        }
        return made;
    }

    const Scene& scene_;
    const State& state_;
    const ClothStars& stars_;
    const MeshTarget& target_;
    double soon_;  ///< s
    TraceMesh trace_;
    ClothSurgery& surgery_;  ///< its own
    SiteAdmission admission_;
    EolPlacer placer_;
    const ConformLimits& limits_;
    EolGuard guard_;
    TraceWays ways_;                       ///< of the vertices that flow, as far as is well
    TraceWays needed_;                     ///< as far as they may soon go: new vertices leave that much
    const TraceWays* kept_ = &ways_;       ///< of the two
    TraceWays coming_;                     ///< of new vertices
    const TraceVertex* making_ = nullptr;  ///< the one that is being made
    VertexId made_ = kNoVertex;            ///< which vertex that would be
    std::map<VertexId, int> contact_of_;   ///< index in State::active, of vertices made where one pressed
    std::vector<RefusedContact> refused_;
    int lost_ = 0, blocked_ = 0;  ///< of ConformOutcome
    ConformReport report_;
};

}  // namespace

FeatureChanges find_feature_changes(const Scene& scene, const State& state, const ClothStars& stars)
{
    if (!scene.eol) return {};
    return {find_releases(scene, state, stars), find_feature_sites(scene, state, stars)};
}

ConformOutcome conform_mesh(const Scene& scene, double dt, const State& state, const ClothStars& stars,
                            const FeatureChanges& changes, const FailedFlow& failed,
                            const ConformLimits& limits, RelaxationMemo& relaxations)
{
    if (!scene.eol || (state.eol.empty() && state.active.empty())) return {};
    if (changes.empty() && failed.empty() && !is_flowing(state)) return {};
    return Conforming(scene, dt, state, stars, limits, relaxations).run(changes, failed);
}

}  // namespace arris
