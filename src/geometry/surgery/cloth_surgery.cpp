// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surgery/cloth_surgery.h"

#include <algorithm>
#include <cassert>
#include <functional>
#include <numeric>
#include <utility>

#include "geometry/surgery/cloth_surgery_implementation.h"

namespace arris {

namespace {

std::vector<MeshEdge> find_edges(const ClothMesh& mesh)
{
    return make_topology(mesh.vertex_count(), mesh.faces).edges;
}

/// A mesh's points, in the order of their ids.
struct Points {
    ClothMesh mesh;
    std::vector<VertexId> ids, vertices;
};

Points list_points(const ClothMesh& mesh, const std::vector<VertexId>& ids,
                   const std::vector<VertexId>& seam_ids)
{
    assert(seam_ids.size() == mesh.seam_vertices.size() && "one id a further point");
    std::vector<VertexId> by_point = ids;
    by_point.insert(by_point.end(), seam_ids.begin(), seam_ids.end());
    std::vector<int> order(by_point.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int p, int q) { return by_point[p] < by_point[q]; });
    Points points;
    std::vector<int> place(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const int p = order[i];
        place[p] = static_cast<int>(i);
        points.mesh.material.push_back(mesh.material[p]);
        points.mesh.world.push_back(mesh.world[mesh.vertex_of(p)]);
        points.ids.push_back(by_point[p]);
        points.vertices.push_back(ids[mesh.vertex_of(p)]);
    }
    for (int f = 0; f < mesh.face_count(); ++f) {
        const auto& [a, b, c] = mesh.points_of(f);
        points.mesh.faces.push_back({place[a], place[b], place[c]});
    }
    return points;
}

}  // namespace

ClothSurgery::ClothSurgery(const ClothMesh& mesh, const std::vector<VertexId>& ids, VertexId next_id,
                           const std::vector<VertexId>& fixed, const std::vector<VertexId>& seam_ids)
{
    if (!mesh.has_seams()) {
        make(mesh, ids, ids, next_id, fixed, find_edges(mesh));
    } else {
        const Points points = list_points(mesh, ids, seam_ids);
        make(points.mesh, points.ids, points.vertices, next_id, fixed, find_edges(points.mesh));
    }
}

ClothSurgery::ClothSurgery(const ClothMesh& mesh, const std::vector<VertexId>& ids, VertexId next_id,
                           const std::vector<VertexId>& fixed, const std::vector<MeshEdge>& edges)
{
    assert(!mesh.has_seams() && "the edges of points would differ");
    make(mesh, ids, ids, next_id, fixed, edges);
}

void ClothSurgery::make(const ClothMesh& mesh, const std::vector<VertexId>& ids,
                        const std::vector<VertexId>& vertices, VertexId next_id,
                        const std::vector<VertexId>& fixed, const std::vector<MeshEdge>& edges)
{
    assert(ids.size() == mesh.world.size() && "one id a vertex");
    assert(std::adjacent_find(ids.begin(), ids.end(), std::greater_equal<>()) == ids.end());
    assert((ids.empty() || ids.back() < next_id) && "ids must be below the next");
    implementation_ = std::make_unique<Implementation>(mesh, ids, vertices, next_id, edges);
    SurgeryMesh& inner = implementation_->mesh;
    for (const MeshEdge& edge : edges) {
        if (edge.face_right >= 0) continue;
        for (const VertexId v : {ids[edge.a], ids[edge.b]})
            if (implementation_->is_corner(v)) inner.fix(v);
    }
    for (const VertexId v : ids)
        if (inner.is_on_seam(v) && !implementation_->is_inside_seam(v, inner.ring(v))) inner.fix(v);
    for (const VertexId v : fixed)
        for (const VertexId point : inner.points_at(v)) inner.fix(point);
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

bool ClothSurgery::is_on_seam(VertexId v) const
{
    return implementation_->mesh.is_on_seam(v);
}

VertexId ClothSurgery::vertex_of(VertexId point) const
{
    return implementation_->mesh.vertex_of(point);
}

std::vector<VertexId> ClothSurgery::points_at(VertexId point) const
{
    return implementation_->mesh.points_at(point);
}

std::optional<std::array<VertexId, 2>> ClothSurgery::partner(VertexId a, VertexId b) const
{
    return implementation_->partner(a, b);
}

std::optional<std::array<VertexId, 2>> ClothSurgery::edge_between(VertexId a, VertexId b) const
{
    std::optional<std::array<VertexId, 2>> found;
    implementation_->any_edge_between(a, b, [&](VertexId p, VertexId q) {
        found = {p, q};
        return true;
    });
    return found;
}

Mat2 ClothSurgery::turn_over(VertexId from, VertexId to) const
{
    const VertexRing ring = this->ring(from);
    const auto first = partner(from, ring.vertices.front()), last = partner(from, ring.vertices.back());
    if (from == to || !first || !last || (*first)[0] != to || (*last)[0] != to) return Mat2::Identity();
    return turn_between(material(ring.vertices.back()) - material(ring.vertices.front()),
                        material((*last)[1]) - material((*first)[1]));
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
    for (const VertexId point : points_at(v)) implementation_->mesh.set_role(point, role, tag);
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
        const std::vector<VertexId> points = points_at(v);
        if (role(v) == TraceRole::OnTrace && std::all_of(points.begin(), points.end(), [&](VertexId p) {
                return mesh.trace_neighbours(p).empty();
            }))
            set_role(v, TraceRole::Free, kNoTag);
    }
}

void ClothSurgery::release_vertex(VertexId v)
{
    for (const VertexId point : points_at(v)) {
        for (const VertexId n : implementation_->mesh.trace_neighbours(point)) release_edge(point, n);
        touch(point);
    }
    set_role(v, TraceRole::Free, kNoTag);
}

// --- changes

Verdict ClothSurgery::commit(const SurgeryProposal& proposal)
{
    if (!proposal.is_legal()) return proposal.verdict;
    if (implementation_->guard && !implementation_->guard(proposal.event)) return Verdict::Guard;
    implementation_->apply(proposal.event);
    if (proposal.event.operation == SurgeryOperation::Collapse)
        for (const VertexChange& gone : proposal.event.changes) implementation_->touched.erase(gone.vertex);
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
