// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "geometry/cgal.h"
#include "geometry/cloth/sewing.h"
#include "geometry/surgery/cloth_surgery.h"
#include "geometry/surgery/material_location.h"
#include "geometry/surgery/surgery_mesh.h"
#include "geometry/tolerances.h"

// ClothSurgery's data and the parts of its proposals. For its .cpp files only.
namespace arris {

// A computed point on the line between two others is off the line by rounding.
inline bool is_on_line(const Vec2& a, const Vec2& b, const Vec2& p)
{
    const double scale =
        std::max({a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff(), p.cwiseAbs().maxCoeff()});
    const double slack = kProductRounding * scale;
    return std::abs(twice_area(a, b, p)) <= slack * (b - a).norm();
}

inline bool is_between(const Vec2& a, const Vec2& b, const Vec2& p)
{
    return is_on_line(a, b, p) && (p - a).dot(b - a) > 0.0 && (p - b).dot(a - b) > 0.0;
}

inline bool is_counter_clockwise(const PatchFace& face)
{
    const auto& X = face.material;
    return X[0].allFinite() && X[1].allFinite() && X[2].allFinite() &&
           exact_orientation(X[0], X[1], X[2]) > 0;
}

class ClothSurgery::Implementation {
  public:
    Implementation(const ClothMesh& cloth, const std::vector<VertexId>& ids,
                   const std::vector<VertexId>& vertices, VertexId first_free_id,
                   const std::vector<MeshEdge>& edges)
        : mesh(cloth, ids, edges, vertices), next_id(first_free_id)
    {
    }

    // --- parts of proposals

    PatchFace patch_face(const IdFace& face) const
    {
        PatchFace patch{face, {}, {}, face};
        for (int k = 0; k < 3; ++k) {
            patch.material[k] = mesh.material(face[k]);
            patch.world[k] = mesh.world(face[k]);
            patch.cloth_vertices[k] = mesh.vertex_of(face[k]);
        }
        return patch;
    }

    // As `patch_face`, with the event's new and moved vertices at their new places.
    PatchFace changed_face(const SurgeryEvent& event, const IdFace& face) const
    {
        PatchFace patch{face, {}, {}, face};
        for (int k = 0; k < 3; ++k) {
            const auto change = std::find_if(event.changes.begin(), event.changes.end(),
                                             [&](const VertexChange& c) { return c.vertex == face[k]; });
            const bool is_changed = change != event.changes.end();
            patch.material[k] = is_changed ? change->new_material : mesh.material(face[k]);
            patch.world[k] = is_changed ? change->new_world : mesh.world(face[k]);
            const bool is_made = is_changed && event.operation == SurgeryOperation::SplitEdge;
            patch.cloth_vertices[k] = is_made ? event.changes[0].vertex : mesh.vertex_of(face[k]);
        }
        return patch;
    }

    void add_after(SurgeryEvent& event, const IdFace& face) const
    {
        event.after.push_back(changed_face(event, face));
    }

    static void check_orientation(SurgeryProposal& proposal)
    {
        if (!std::all_of(proposal.event.after.begin(), proposal.event.after.end(), is_counter_clockwise))
            proposal.verdict = Verdict::Orientation;
    }

    VertexChange change_at(const IdFace& parents, const Vec3& weights, VertexId made) const
    {
        // Interpolates from the first parent: a point between two parents of equal coordinate has it exactly.
        VertexChange change{
            made,   mesh.material(parents[0]), Vec2::Zero(), mesh.world(parents[0]), Vec3::Zero(), parents,
            weights};
        change.new_material = change.old_material;
        change.new_world = change.old_world;
        for (int k = 1; k < 3; ++k) {
            change.new_material += weights[k] * (mesh.material(parents[k]) - mesh.material(parents[0]));
            change.new_world += weights[k] * (mesh.world(parents[k]) - mesh.world(parents[0]));
        }
        change.old_material = change.new_material;
        change.old_world = change.new_world;
        return change;
    }

    std::vector<IdFace> faces_at(VertexId v) const
    {
        const VertexRing ring = mesh.ring(v);
        const std::size_t n = ring.vertices.size();
        std::vector<IdFace> faces;
        faces.reserve(n);
        for (std::size_t k = 0; k + (ring.is_closed ? 0 : 1) < n; ++k)
            faces.push_back({v, ring.vertices[k], ring.vertices[(k + 1) % n]});
        return faces;
    }

    VertexId apex(VertexId a, VertexId b) const
    {
        const auto h = mesh.halfedge(a, b);
        if (h == SurgeryMesh::Mesh::null_halfedge() || !mesh.has_face(h)) return kNoVertex;
        return mesh.apex(h);
    }

    bool has_edge(VertexId a, VertexId b) const
    {
        return mesh.halfedge(a, b) != SurgeryMesh::Mesh::null_halfedge();
    }

    bool is_border_edge(VertexId a, VertexId b) const { return mesh.is_border_edge(mesh.halfedge(a, b)); }

    // --- seams

    /// Calls `visit` with every edge between points at the vertices of a and b, until it returns true.
    template <typename Visit>
    bool any_edge_between(VertexId a, VertexId b, const Visit& visit) const
    {
        for (const VertexId p : mesh.points_at(a))
            for (const VertexId q : mesh.points_at(b))
                if (has_edge(p, q) && visit(p, q)) return true;
        return false;
    }

    std::optional<std::array<VertexId, 2>> partner(VertexId a, VertexId b) const
    {
        std::optional<std::array<VertexId, 2>> found;
        if (!mesh.is_on_seam(a) && !mesh.is_on_seam(b)) return found;
        any_edge_between(a, b, [&](VertexId p, VertexId q) {
            if (p == a && q == b) return false;
            found = {p, q};
            return true;
        });
        return found;
    }

    /// Whether the cloth has an edge between the vertices of two points, or they are at one vertex: a further
    /// edge between them would fold the mesh onto itself.
    bool are_joined(VertexId a, VertexId b) const
    {
        if (!mesh.is_on_seam(a) || !mesh.is_on_seam(b)) return has_edge(a, b);
        return mesh.vertex_of(a) == mesh.vertex_of(b) ||
               any_edge_between(a, b, [](VertexId, VertexId) { return true; });
    }

    bool is_corner(VertexId v) const
    {
        if (!mesh.is_on_border(v)) return false;
        const VertexRing ring = mesh.ring(v);
        return !ring.is_closed && !is_between(mesh.material(ring.vertices.front()),
                                              mesh.material(ring.vertices.back()), mesh.material(v));
    }

    // --- conditions for a collapse, except orientation

    Verdict check_trace_collapse(VertexId v, VertexId w) const
    {
        if (mesh.role(v) == TraceRole::Node) return Verdict::Fixed;
        if (mesh.role(v) == TraceRole::Free) return Verdict::Done;
        const std::vector<VertexId> along = mesh.trace_neighbours(v);
        if (along.size() != 2 || (along[0] != w && along[1] != w)) return Verdict::Trace;
        const VertexId other = along[0] == w ? along[1] : along[0];
        if (mesh.edge_tag(mesh.halfedge(v, w)) != mesh.edge_tag(mesh.halfedge(v, other)))
            return Verdict::Trace;
        // The two trace edges become one edge, which must not be on a trace yet.
        const bool is_loop = has_edge(w, other) && mesh.edge_tag(mesh.halfedge(w, other)) != kNoTag;
        return is_loop ? Verdict::Trace : Verdict::Done;
    }

    Verdict check_border_collapse(VertexId v, VertexId w, const VertexRing& ring) const
    {
        if (ring.is_closed) return Verdict::Done;
        const VertexId first = ring.vertices.front();
        const VertexId last = ring.vertices.back();
        if (w != first && w != last) return Verdict::Border;
        return is_between(mesh.material(first), mesh.material(last), mesh.material(v)) ? Verdict::Done
                                                                                       : Verdict::Border;
    }

    // Common neighbours other than the apexes of v-w would be joined to w twice.
    Verdict check_link(VertexId v, VertexId w, const VertexRing& ring) const
    {
        const VertexId left = apex(v, w);
        const VertexId right = apex(w, v);
        for (const VertexId n : ring.vertices)
            if (n != left && n != right && n != w && are_joined(n, w)) return Verdict::Topology;
        return Verdict::Done;
    }

    /// Whether v may go along its seam: inside one of two sides, where it divides both in the same share.
    /// If one side is eased from v on, a shifted v would sew other material together.
    bool is_inside_seam(VertexId v, const VertexRing& ring) const
    {
        if (mesh.points_at(v).size() != 2 || ring.is_closed) return false;
        const auto first = partner(v, ring.vertices.front()), last = partner(v, ring.vertices.back());
        if (!first || !last) return false;
        const auto length = [&](VertexId a, VertexId b) {
            return (mesh.material(b) - mesh.material(a)).norm();
        };
        return has_one_share(length(v, ring.vertices.front()), length(v, ring.vertices.back()),
                             length((*first)[0], (*first)[1]), length((*last)[0], (*last)[1]));
    }

    /// The move, on the other side of a seam, that goes with one along it; nothing where none does.
    std::optional<VertexMove> move_beyond(const VertexMove& move) const
    {
        const VertexRing ring = mesh.ring(move.vertex);
        if (!is_inside_seam(move.vertex, ring)) return std::nullopt;
        const Vec2 X = mesh.material(move.vertex), way = move.material - X;
        VertexId end = ring.vertices.front();
        if ((mesh.material(end) - X).dot(way) < 0.0) end = ring.vertices.back();
        const Vec2 edge = mesh.material(end) - X;
        const auto [other, other_end] = *partner(move.vertex, end);
        const Vec2 start = mesh.material(other);
        const double share = way.dot(edge) / edge.squaredNorm();
        return VertexMove{other, start + share * (mesh.material(other_end) - start), move.keeps_world};
    }

    // Adds to a collapse of v into w what it does on this side: its faces, and the change of v.
    Verdict add_collapse(VertexId v, VertexId w, SurgeryEvent& event) const
    {
        if (mesh.is_fixed(v)) return Verdict::Fixed;
        const VertexRing ring = mesh.ring(v);
        if (mesh.is_on_seam(v) && !is_inside_seam(v, ring)) return Verdict::Border;
        for (const Verdict verdict :
             {check_trace_collapse(v, w), check_border_collapse(v, w, ring), check_link(v, w, ring)})
            if (verdict != Verdict::Done) return verdict;
        const std::size_t known = event.after.size();
        event.before.reserve(event.before.size() + ring.vertices.size());
        event.after.reserve(known + ring.vertices.size());
        for (IdFace face : faces_at(v)) {
            event.before.push_back(patch_face(face));
            if (std::find(face.begin(), face.end(), w) != face.end()) continue;
            std::replace(face.begin(), face.end(), v, w);
            event.after.push_back(patch_face(face));
        }
        event.changes.push_back({v, mesh.material(v), mesh.material(w), mesh.world(v), mesh.world(w),
                                 IdFace{w, w, w}, Vec3::UnitX()});
        return event.after.size() == known ? Verdict::Topology : Verdict::Done;
    }

    // Adds to a split of a-b what it does on this side: its faces, and the new vertex `m`.
    void add_edge_split(VertexId a, VertexId b, double s, VertexId m, SurgeryEvent& event) const
    {
        event.changes.push_back(change_at({a, b, b}, {1.0 - s, s, 0.0}, m));
        const std::array<std::array<VertexId, 2>, 2> sides = {{{a, b}, {b, a}}};
        for (const auto& [from, to] : sides) {
            const VertexId c = apex(from, to);
            if (c == kNoVertex) continue;
            event.before.push_back(patch_face({from, to, c}));
            add_after(event, {from, m, c});
            add_after(event, {m, to, c});
        }
    }

    // --- moves

    // The change that moves `v` to a material point of the present surface. If no face holds the point (by
    // rounding on a slanted border), the nearest place in the faces of `v` is used.
    VertexChange interpolated(const ClothSurgery& surgery, VertexId v, const Vec2& material) const
    {
        FaceLocation best;
        if (const auto found = locate(surgery, material, v)) {
            best = *found;
        } else {
            double least_error = std::numeric_limits<double>::infinity();
            for (const IdFace& face : faces_at(v)) {
                const auto X = patch_face(face).material;
                const Vec3 weights = clamped_weights(X, material);
                const double error =
                    (weights[0] * X[0] + weights[1] * X[1] + weights[2] * X[2] - material).norm();
                if (!(error < least_error)) continue;
                least_error = error;
                best = {face, weights};
            }
        }
        VertexChange change = change_at(best.face, best.weights, v);
        change.old_material = mesh.material(v);
        change.old_world = mesh.world(v);
        change.new_material = material;
        return change;
    }

    // A border vertex must end between its border neighbours' new places. As corners are fixed, this keeps
    // the vertex on its line of the border.
    bool keeps_border(const SurgeryEvent& event, VertexId v) const
    {
        const VertexRing ring = mesh.ring(v);
        if (ring.is_closed) return true;
        const PatchFace places = changed_face(event, {ring.vertices.front(), v, ring.vertices.back()});
        return is_between(places.material[0], places.material[2], places.material[1]);
    }

    void apply(const SurgeryEvent& event)
    {
        const auto [a, b] = event.edge;
        switch (event.operation) {
            case SurgeryOperation::SplitEdge:
                for (const VertexChange& c : event.changes) mesh.split_edge(c.parents[0], c.parents[1], c);
                break;
            case SurgeryOperation::SplitFace:
                mesh.split_face(event.before[0].vertices, event.changes[0]);
                break;
            case SurgeryOperation::Move:
                for (const VertexChange& c : event.changes) mesh.move(c.vertex, c.new_material, c.new_world);
                break;
            case SurgeryOperation::Collapse:
                for (const VertexChange& c : event.changes) mesh.collapse(c.vertex, c.parents[0]);
                break;
            case SurgeryOperation::Flip:
                mesh.flip(a, b);
                break;
        }
        const bool is_split =
            event.operation == SurgeryOperation::SplitEdge || event.operation == SurgeryOperation::SplitFace;
        if (!is_split) return;
        const VertexId made = event.changes[0].vertex;
        assert(made == next_id && "the mesh changed since the proposal was made");
        next_id += static_cast<VertexId>(event.changes.size());
        for (const VertexChange& change : event.changes) {
            if (change.vertex != made) mesh.sew(change.vertex, made);
            mesh.set_role(change.vertex, event.role, event.tag);
        }
    }

    SurgeryMesh mesh;
    VertexId next_id;
    SurgeryGuard guard;
    std::vector<SurgeryEvent> events;
    std::set<VertexId> touched;
};

}  // namespace arris
