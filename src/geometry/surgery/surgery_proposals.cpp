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
namespace {

bool has(const IdFace& face, VertexId v)
{
    return std::find(face.begin(), face.end(), v) != face.end();
}

IdFace replaced(IdFace face, VertexId v, VertexId by)
{
    std::replace(face.begin(), face.end(), v, by);
    return face;
}

}  // namespace

SurgeryProposal ClothSurgery::propose_edge_split(VertexId a, VertexId b, double s, TraceRole role,
                                                 int tag) const
{
    if (!has_edge(a, b)) return {Verdict::Missing, {}};
    if (!(s > 0.0 && s < 1.0)) return {Verdict::Argument, {}};
    SurgeryProposal proposal;
    SurgeryEvent& event = proposal.event;
    const bool is_on_trace = role == TraceRole::Free && edge_tag(a, b) != kNoTag;
    event.operation = SurgeryOperation::SplitEdge;
    event.edge = {a, b};
    event.role = is_on_trace ? TraceRole::OnTrace : role;
    event.tag = is_on_trace ? edge_tag(a, b) : tag;
    event.changes = {implementation_->change_at({a, b, b}, {1.0 - s, s, 0.0})};
    const VertexId m = event.changes[0].vertex;
    const std::array<std::array<VertexId, 2>, 2> sides = {{{a, b}, {b, a}}};
    for (const auto& [from, to] : sides) {
        const VertexId c = apex(from, to);
        if (c == kNoVertex) continue;
        event.before.push_back(patch_face({from, to, c}));
        implementation_->add_after(event, {from, m, c});
        implementation_->add_after(event, {m, to, c});
    }
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
    event.changes = {implementation_->change_at(face, weights / sum)};
    event.before = {patch_face(face)};
    for (int k = 0; k < 3; ++k)
        implementation_->add_after(event, {face[k], face[(k + 1) % 3], event.changes[0].vertex});
    Implementation::check_orientation(proposal);
    return proposal;
}

SurgeryProposal ClothSurgery::propose_moves(const std::vector<VertexMove>& moves) const
{
    SurgeryProposal proposal;
    SurgeryEvent& event = proposal.event;
    event.operation = SurgeryOperation::Move;
    std::set<VertexId> moved;
    for (const VertexMove& move : moves) {
        if (!has_vertex(move.vertex)) return {Verdict::Missing, {}};
        if (!move.material.allFinite() || !moved.insert(move.vertex).second) return {Verdict::Argument, {}};
        if (is_fixed(move.vertex)) return {Verdict::Fixed, {}};
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
    for (const IdFace& face : faces) {
        event.before.push_back(patch_face(face));
        implementation_->add_after(event, face);
    }
    return proposal;
}

SurgeryProposal ClothSurgery::propose_collapse(VertexId v, VertexId w) const
{
    const Implementation& inner = *implementation_;
    if (!has_edge(v, w)) return {Verdict::Missing, {}};
    if (is_fixed(v)) return {Verdict::Fixed, {}};
    const VertexRing ring = this->ring(v);
    for (const Verdict verdict : {inner.check_trace_collapse(v, w), inner.check_border_collapse(v, w, ring),
                                  inner.check_link(v, w, ring)})
        if (verdict != Verdict::Done) return {verdict, {}};
    SurgeryProposal proposal;
    SurgeryEvent& event = proposal.event;
    event.operation = SurgeryOperation::Collapse;
    event.edge = {v, w};
    event.before.reserve(ring.vertices.size());
    event.after.reserve(ring.vertices.size());
    for (const IdFace& face : faces_at(v)) {
        event.before.push_back(patch_face(face));
        if (!has(face, w)) event.after.push_back(patch_face(replaced(face, v, w)));
    }
    event.changes = {{v, material(v), material(w), world(v), world(w), IdFace{w, w, w}, Vec3::UnitX()}};
    if (event.after.empty()) return {Verdict::Topology, {}};
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
    if (has_edge(c, d)) return {Verdict::Topology, {}};
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
