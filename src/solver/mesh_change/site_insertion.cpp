// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh_change/site_insertion.h"

#include "solver/sites/feature_flow.h"

namespace arris {

SiteInsertion::SiteInsertion(const Scene& scene, const State& state, const ClothStars& stars, double soon,
                             TraceMesh& trace, const EolAdmission& admission, WayClearing& ways,
                             RefusedContacts& refused)
    : scene_(scene),
      state_(state),
      stars_(stars),
      soon_(soon),
      trace_(trace),
      admission_(admission),
      ways_(ways),
      refused_(refused)
{
}

std::optional<ConstraintCause> SiteInsertion::try_insert(const FeatureSite& site)
{
    const int v = state_.index_of(site.near);
    const Vec2 flow = find_feature_flow(scene_, state_, stars_, site);
    if (const std::optional<ConstraintCause> cause = admission_.find_refusal(site, v, flow)) return cause;
    if (site.on.is_bend()) {
        const std::optional<VertexId> beside = find_beside(site);
        if (beside && trace_.surgery().role(*beside) == TraceRole::Node) return ConstraintCause::BesideEol;
        if (beside && lock_at_bend(*beside, site)) return std::nullopt;
    }
    return insert_vertex(site, flow);
}

std::optional<ConstraintCause> SiteInsertion::insert_vertex(const FeatureSite& site, const Vec2& flow)
{
    ClothSurgery& surgery = trace_.surgery();
    const TraceVertex wanted{site.on.is_fixed() ? TraceRole::Node : TraceRole::OnTrace,
                             trace_.tags().tag(site.on), soon_ * flow};
    const VertexId near = surgery.has_vertex(site.near) ? site.near : trace_.nearest_to(site.material);
    const TraceInsertion made = make_vertex(site.material, near, wanted);
    if (made.verdict != Verdict::Done)
        return made.verdict == Verdict::Guard ? ConstraintCause::Guard : ConstraintCause::Quality;
    const VertexId v = surgery.vertex_of(made.vertex);
    if (trace_.find(v)) {
        const bool has_slid = site.is_in_face() && slide_to(v, site);
        return has_slid ? std::nullopt : std::optional(ConstraintCause::BesideEol);
    }
    EolVertex vertex{v, site.on, site.outward, 0};
    vertex.side = trace_.side_beside(wanted.tag, site.material);
    if (const std::optional<ConstraintCause> cause = admission_.refuse_inserted(vertex, site)) {
        surgery.release_vertex(v);
        for (const VertexId point : surgery.points_at(v)) ways_.erase_coming(point);
        return cause;
    }
    trace_.add(vertex, made.vertex, flow);
    if (site.contact >= 0) refused_.note_inserted(v, site.contact);
    ++inserted_;
    return std::nullopt;
}

TraceInsertion SiteInsertion::make_vertex(const Vec2& material, VertexId near, const TraceVertex& wanted)
{
    making_ = &wanted;
    const TraceInsertion made = insert_trace_point(trace_.surgery(), trace_.target(), material, near, wanted);
    forget_proposal();  // the last one need not be the one that was made
    const ClothSurgery& surgery = trace_.surgery();
    if (made.verdict == Verdict::Done && !trace_.find(surgery.vertex_of(made.vertex)))
        for (const VertexId point : surgery.points_at(made.vertex))
            ways_.add_coming(point, surgery.turn_over(made.vertex, point) * wanted.way);
    making_ = nullptr;
    return made;
}

void SiteInsertion::forget_proposal()
{
    for (const VertexId point : proposed_) ways_.erase_coming(point);
    proposed_.clear();
}

void SiteInsertion::note_proposal(const SurgeryEvent& event)
{
    if (!making_ || event.changes.empty()) return;
    forget_proposal();
    // Beyond a seam the way leads along that side; a split's new points are in no mesh yet.
    const ClothSurgery& surgery = trace_.surgery();
    const auto along = [&](const VertexChange& change) {
        return Vec2(surgery.material(change.parents[1]) - surgery.material(change.parents[0]));
    };
    const VertexChange& first = event.changes[0];
    for (const VertexChange& change : event.changes) {
        Mat2 turn = Mat2::Identity();
        if (change.vertex != first.vertex)
            turn = event.operation == SurgeryOperation::SplitEdge
                       ? turn_between(along(first), along(change))
                       : surgery.turn_over(first.vertex, change.vertex);
        proposed_.push_back(change.vertex);
        ways_.add_coming(change.vertex, turn * making_->way);
    }
}

/// Vertex of the bend's trace that is too near to the bend for a new one. A fixed vertex within
/// kBesideBend.fixed comes first, then the nearest sliding one within kBesideBend.sliding, with which
/// clean-up would merge a new vertex.
std::optional<VertexId> SiteInsertion::find_beside(const FeatureSite& bend) const
{
    const ClothSurgery& surgery = trace_.surgery();
    const int tag = trace_.tags().tag(bend.on);
    const double h = trace_.target().length(bend.material);
    double least = kBesideBend.sliding * h;
    std::optional<VertexId> nearest;
    for (const EolVertex& e : trace_.eol()) {
        if (!trace_.is_on_trace(e.vertex_id) || surgery.tag(e.vertex_id) != tag) continue;
        const double distance = trace_.distance(e, bend.material);
        const bool is_fixed = surgery.role(e.vertex_id) == TraceRole::Node;
        if (is_fixed && distance < kBesideBend.fixed * h) return e.vertex_id;
        if (is_fixed || !(distance < least)) continue;
        nearest = e.vertex_id;
        least = distance;
    }
    return nearest;
}

/// Moves a sliding vertex to the bend of a rim that presses beside it.
bool SiteInsertion::slide_to(VertexId v, const FeatureSite& bend)
{
    ClothSurgery& surgery = trace_.surgery();
    if (trace_.find(v)->on.is_fixed() ||
        surgery.commit(surgery.propose_moves({{v, bend.material}})) != Verdict::Done)
        return false;
    trace_.slide(v, bend.on.index);
    return true;
}

/// Moves a sliding vertex to the bend of a wire, and fixes it there.
bool SiteInsertion::lock_at_bend(VertexId v, const FeatureSite& bend)
{
    ClothSurgery& surgery = trace_.surgery();
    if (surgery.commit(surgery.propose_moves({{v, bend.material}})) != Verdict::Done) return false;
    trace_.lock(v, bend.on);
    ++inserted_;
    return true;
}

}  // namespace arris
