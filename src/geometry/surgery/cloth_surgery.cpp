// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surgery/cloth_surgery.h"

#include <algorithm>
#include <cassert>
#include <functional>
#include <utility>

#include "geometry/surgery/cloth_surgery_implementation.h"

namespace arris {

ClothSurgery::ClothSurgery(const ClothMesh& mesh, const std::vector<VertexId>& ids, VertexId next_id,
                           const std::vector<VertexId>& fixed)
    : ClothSurgery(mesh, ids, next_id, fixed, make_topology(mesh.vertex_count(), mesh.faces).edges)
{
}

ClothSurgery::ClothSurgery(const ClothMesh& mesh, const std::vector<VertexId>& ids, VertexId next_id,
                           const std::vector<VertexId>& fixed, const std::vector<MeshEdge>& edges)
    : implementation_(std::make_unique<Implementation>(mesh, ids, next_id, edges))
{
    assert(ids.size() == mesh.world.size() && "one id a vertex");
    assert(std::adjacent_find(ids.begin(), ids.end(), std::greater_equal<>()) == ids.end());
    assert((ids.empty() || ids.back() < next_id) && "ids must be below the next");
    SurgeryMesh& inner = implementation_->mesh;
    for (const MeshEdge& edge : edges) {
        if (edge.face_right >= 0) continue;
        for (const VertexId v : {ids[edge.a], ids[edge.b]})
            if (implementation_->is_corner(v)) inner.fix(v);
    }
    for (const VertexId v : fixed) inner.fix(v);
}

ClothSurgery::~ClothSurgery() = default;
ClothSurgery::ClothSurgery(ClothSurgery&& other) noexcept = default;
ClothSurgery& ClothSurgery::operator=(ClothSurgery&& other) noexcept = default;

void ClothSurgery::set_guard(SurgeryGuard guard)
{
    implementation_->guard = std::move(guard);
}

// --- queries

int ClothSurgery::vertex_count() const
{
    return implementation_->mesh.vertex_count();
}

bool ClothSurgery::has_vertex(VertexId v) const
{
    return implementation_->mesh.has(v);
}

bool ClothSurgery::has_edge(VertexId a, VertexId b) const
{
    return implementation_->has_edge(a, b);
}

VertexId ClothSurgery::apex(VertexId a, VertexId b) const
{
    return implementation_->apex(a, b);
}

bool ClothSurgery::is_border(VertexId v) const
{
    return implementation_->mesh.is_on_border(v);
}

bool ClothSurgery::is_border_edge(VertexId a, VertexId b) const
{
    return has_edge(a, b) && implementation_->is_border_edge(a, b);
}

bool ClothSurgery::is_fixed(VertexId v) const
{
    return implementation_->mesh.is_fixed(v);
}

Vec2 ClothSurgery::material(VertexId v) const
{
    return implementation_->mesh.material(v);
}

Vec3 ClothSurgery::world(VertexId v) const
{
    return implementation_->mesh.world(v);
}

TraceRole ClothSurgery::role(VertexId v) const
{
    return implementation_->mesh.role(v);
}

int ClothSurgery::tag(VertexId v) const
{
    return implementation_->mesh.tag(v);
}

int ClothSurgery::edge_tag(VertexId a, VertexId b) const
{
    const SurgeryMesh& mesh = implementation_->mesh;
    const auto is_free = [&](VertexId v) { return !mesh.has(v) || mesh.role(v) == TraceRole::Free; };
    if (is_free(a) || is_free(b)) return kNoTag;
    const SurgeryMesh::Halfedge h = mesh.halfedge(a, b);
    return h == SurgeryMesh::Mesh::null_halfedge() ? kNoTag : mesh.edge_tag(h);
}

VertexRing ClothSurgery::ring(VertexId v) const
{
    return implementation_->mesh.ring(v);
}

std::vector<IdFace> ClothSurgery::faces_at(VertexId v) const
{
    return implementation_->faces_at(v);
}

PatchFace ClothSurgery::patch_face(const IdFace& face) const
{
    return implementation_->patch_face(face);
}

// --- roles and tags

void ClothSurgery::set_role(VertexId v, TraceRole role, int tag)
{
    implementation_->mesh.set_role(v, role, tag);
}

void ClothSurgery::set_edge_tag(VertexId a, VertexId b, int tag)
{
    SurgeryMesh& mesh = implementation_->mesh;
    assert((tag == kNoTag || (role(a) != TraceRole::Free && role(b) != TraceRole::Free)) &&
           "a trace's vertices have a role");
    mesh.set_edge_tag(mesh.halfedge(a, b), tag);
}

void ClothSurgery::release_edge(VertexId a, VertexId b)
{
    SurgeryMesh& mesh = implementation_->mesh;
    mesh.set_edge_tag(mesh.halfedge(a, b), kNoTag);
    for (const VertexId v : {a, b}) {
        touch(v);
        if (role(v) == TraceRole::OnTrace && mesh.trace_neighbours(v).empty())
            mesh.set_role(v, TraceRole::Free, kNoTag);
    }
}

void ClothSurgery::release_vertex(VertexId v)
{
    for (const VertexId n : implementation_->mesh.trace_neighbours(v)) release_edge(v, n);
    set_role(v, TraceRole::Free, kNoTag);
    touch(v);
}

// --- changes

Verdict ClothSurgery::commit(const SurgeryProposal& proposal)
{
    if (!proposal.is_legal()) return proposal.verdict;
    if (implementation_->guard && !implementation_->guard(proposal.event)) return Verdict::Guard;
    implementation_->apply(proposal.event);
    if (proposal.event.operation == SurgeryOperation::Collapse)
        implementation_->touched.erase(proposal.event.edge[0]);
    for (const PatchFace& face : proposal.event.after)
        implementation_->touched.insert(face.vertices.begin(), face.vertices.end());
    implementation_->events.push_back(proposal.event);
    return Verdict::Done;
}

// --- record of changes

const std::vector<SurgeryEvent>& ClothSurgery::events() const
{
    return implementation_->events;
}

std::vector<VertexId> ClothSurgery::take_touched()
{
    std::vector<VertexId> taken(implementation_->touched.begin(), implementation_->touched.end());
    implementation_->touched.clear();
    return taken;
}

void ClothSurgery::touch(VertexId v)
{
    implementation_->touched.insert(v);
}

SurgeryResult ClothSurgery::result() const
{
    const SurgeryMesh& mesh = implementation_->mesh;
    SurgeryResult result;
    result.next_id = implementation_->next_id;
    mesh.write(result);
    const auto index_of = [&](VertexId v) {
        return static_cast<int>(std::lower_bound(result.ids.begin(), result.ids.end(), v) -
                                result.ids.begin());
    };
    for (std::size_t v = 0; v < result.ids.size(); ++v) {
        if (result.roles[v] == TraceRole::Free) continue;
        const VertexId id = result.ids[v];
        for (const VertexId n : mesh.trace_neighbours(id))
            if (id < n) result.tagged_edges.push_back({static_cast<int>(v), index_of(n), edge_tag(id, n)});
    }
    std::sort(result.tagged_edges.begin(), result.tagged_edges.end(),
              [](const auto& e, const auto& f) { return std::pair(e.a, e.b) < std::pair(f.a, f.b); });
    return result;
}

const char* to_string(Verdict verdict)
{
    switch (verdict) {
        case Verdict::Done:
            return "done";
        case Verdict::Missing:
            return "missing";
        case Verdict::Argument:
            return "argument";
        case Verdict::Fixed:
            return "fixed";
        case Verdict::Border:
            return "border";
        case Verdict::Trace:
            return "trace";
        case Verdict::Topology:
            return "topology";
        case Verdict::Orientation:
            return "orientation";
        case Verdict::Quality:
            return "quality";
        case Verdict::Guard:
            return "guard";
        case Verdict::Budget:
            return "budget";
    }
    return "";
}

}  // namespace arris
