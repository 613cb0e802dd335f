// SPDX-License-Identifier: GPL-3.0-or-later
//
// Every operation has three parts. A proposal lists the faces before and after, and checks the orientation of
// each new face by exact predicate. Only the commit changes the half-edges. A patch whose outline stays and
// whose new faces are all counter-clockwise again triangulates the same part of the plane. So no further
// geometric check is needed.
#include <algorithm>
#include <cmath>
#include <set>

#include "geometry/surgery/cloth_surgery_implementation.h"

namespace arris {

SurgeryProposal ClothSurgery::propose_edge_split(VertexId a, VertexId b, double s, TraceRole role,
                                                 int tag) const
{
    if (!has_edge(a, b)) return {Verdict::Missing, {}};
    if (!(s > 0.0 && s < 1.0)) return {Verdict::Argument, {}};
    SurgeryProposal proposal;
    SurgeryEvent& event = proposal.event;
    const std::optional<std::array<VertexId, 2>> other_side = partner(a, b);
    const bool is_on_trace = role == TraceRole::Free && edge_tag(a, b) != kNoTag;
    event.operation = SurgeryOperation::SplitEdge;
    event.edge = {a, b};
    event.role = is_on_trace ? TraceRole::OnTrace : role;
    event.tag = is_on_trace ? edge_tag(a, b) : tag;
    const VertexId made = implementation_->next_id;
    implementation_->add_edge_split(a, b, s, made, event);
    if (other_side) implementation_->add_edge_split((*other_side)[0], (*other_side)[1], s, made + 1, event);
    Implementation::check_orientation(proposal);
    return proposal;
}

SurgeryProposal ClothSurgery::propose_face_split(const IdFace& face, const Vec3& weights, TraceRole role,
                                                 int tag) const
{
    if (apex(face[0], face[1]) != face[2]) return {Verdict::Missing, {}};
    const double sum = weights.sum();
    if (!(weights.minCoeff() > 0.0) || !std::isfinite(sum)) return {Verdict::Argument, {}};
    SurgeryProposal proposal;
    SurgeryEvent& event = proposal.event;
    event.operation = SurgeryOperation::SplitFace;
    event.role = role;
    event.tag = tag;
    event.changes = {implementation_->change_at(face, weights / sum, implementation_->next_id)};
    event.before = {patch_face(face)};
    for (int k = 0; k < 3; ++k)
        implementation_->add_after(event, {face[k], face[(k + 1) % 3], event.changes[0].vertex});
    Implementation::check_orientation(proposal);
    return proposal;
}

SurgeryProposal ClothSurgery::propose_moves(const std::vector<VertexMove>& wanted) const
{
    SurgeryProposal proposal;
    SurgeryEvent& event = proposal.event;
    event.operation = SurgeryOperation::Move;
    std::vector<VertexMove> moves = wanted;
    std::set<VertexId> moved;
    for (const VertexMove& move : wanted) {
        if (!has_vertex(move.vertex)) return {Verdict::Missing, {}};
        if (!move.material.allFinite() || !moved.insert(move.vertex).second) return {Verdict::Argument, {}};
        if (is_fixed(move.vertex)) return {Verdict::Fixed, {}};
        if (!is_on_seam(move.vertex)) continue;
        const std::optional<VertexMove> beyond = implementation_->move_beyond(move);
        if (!beyond) return {Verdict::Border, {}};
        if (!moved.insert(beyond->vertex).second) return {Verdict::Argument, {}};
        if (is_fixed(beyond->vertex)) return {Verdict::Fixed, {}};
        moves.push_back(*beyond);
    }
    // Orientation is checked first: this is cheap, and ensures that the new places are inside the old faces.
    for (const VertexMove& move : moves)
        event.changes.push_back({move.vertex, material(move.vertex), move.material, world(move.vertex),
                                 world(move.vertex), IdFace{move.vertex, move.vertex, move.vertex},
                                 Vec3::UnitX()});
    std::set<IdFace> faces;
    for (const VertexMove& move : moves) {
        if (!implementation_->keeps_border(event, move.vertex)) return {Verdict::Border, {}};
        for (IdFace face : faces_at(move.vertex)) {
            std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
            faces.insert(face);
        }
    }
    for (const IdFace& face : faces) implementation_->add_after(event, face);
    Implementation::check_orientation(proposal);
    if (!proposal.is_legal()) return proposal;
    event.after.clear();
    for (std::size_t k = 0; k < moves.size(); ++k)
        if (!moves[k].keeps_world)
            event.changes[k] = implementation_->interpolated(*this, moves[k].vertex, moves[k].material);
    for (VertexChange& change : event.changes)  // both sides of a seam are at one place
        for (const VertexChange& first : event.changes)
            if (&first < &change && vertex_of(first.vertex) == vertex_of(change.vertex))
                change.new_world = first.new_world;
    for (const IdFace& face : faces) {
        event.before.push_back(patch_face(face));
        implementation_->add_after(event, face);
    }
    return proposal;
}

SurgeryProposal ClothSurgery::propose_collapse(VertexId v, VertexId w) const
{
    if (!has_edge(v, w)) return {Verdict::Missing, {}};
    SurgeryProposal proposal;
    SurgeryEvent& event = proposal.event;
    event.operation = SurgeryOperation::Collapse;
    event.edge = {v, w};
    proposal.verdict = implementation_->add_collapse(v, w, event);
    if (!proposal.is_legal()) return proposal;
    if (is_on_seam(v)) {
        const auto [v_beyond, w_beyond] = *partner(v, w);
        proposal.verdict = implementation_->add_collapse(v_beyond, w_beyond, event);
        if (!proposal.is_legal()) return proposal;
    }
    Implementation::check_orientation(proposal);
    return proposal;
}

SurgeryProposal ClothSurgery::propose_flip(VertexId a, VertexId b) const
{
    if (!has_edge(a, b)) return {Verdict::Missing, {}};
    if (edge_tag(a, b) != kNoTag) return {Verdict::Trace, {}};
    const VertexId c = apex(a, b);
    const VertexId d = apex(b, a);
    if (c == kNoVertex || d == kNoVertex) return {Verdict::Border, {}};
    if (implementation_->are_joined(c, d)) return {Verdict::Topology, {}};
    SurgeryProposal proposal;
    SurgeryEvent& event = proposal.event;
    event.operation = SurgeryOperation::Flip;
    event.edge = {a, b};
    event.before = {patch_face({a, b, c}), patch_face({b, a, d})};
    event.after = {patch_face({a, d, c}), patch_face({b, c, d})};
    Implementation::check_orientation(proposal);
    return proposal;
}

}  // namespace arris
