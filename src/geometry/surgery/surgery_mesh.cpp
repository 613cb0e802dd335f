// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surgery/surgery_mesh.h"

#include <CGAL/boost/graph/Euler_operations.h>

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

#include "geometry/cloth/sewing.h"
#include "geometry/from_least.h"

namespace arris {
namespace {

// Faces start at their least vertex: bucket sort by this vertex, then a sort of the few faces of each.
void sort_faces(int vertex_count, std::vector<Face>& faces)
{
    std::vector<std::ptrdiff_t> next(static_cast<std::size_t>(vertex_count) + 1, 0);
    for (const Face& face : faces) ++next[face[0] + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    std::vector<Face> sorted(faces.size());
    for (const Face& face : faces) sorted[next[face[0]]++] = face;
    std::ptrdiff_t begin = 0;  // next[v] is now the end of vertex v's faces
    for (int v = 0; v < vertex_count; begin = next[v++])
        std::sort(sorted.begin() + begin, sorted.begin() + next[v],
                  [](const Face& f, const Face& g) { return f[1] < g[1] || (f[1] == g[1] && f[2] < g[2]); });
    faces.swap(sorted);
}

}  // namespace

SurgeryMesh::SurgeryMesh(const ClothMesh& mesh, const std::vector<VertexId>& ids,
                         const std::vector<MeshEdge>& edges, const std::vector<VertexId>& vertices)
    : vertices_(ids.size())
{
    id_ = mesh_.add_property_map<Vertex, VertexId>("v:id", kNoVertex).first;
    world_ = mesh_.add_property_map<Vertex, Vec3>("v:world", Vec3::Zero()).first;
    is_fixed_ = mesh_.add_property_map<Vertex, bool>("v:is_fixed", false).first;
    role_ = mesh_.add_property_map<Vertex, TraceRole>("v:role", TraceRole::Free).first;
    tag_ = mesh_.add_property_map<Vertex, int>("v:tag", kNoTag).first;
    edge_tag_ = mesh_.add_property_map<Mesh::Edge_index, int>("e:tag", kNoTag).first;
    mesh_.resize(static_cast<Mesh::size_type>(mesh.vertex_count()),
                 static_cast<Mesh::size_type>(edges.size()), static_cast<Mesh::size_type>(mesh.face_count()));
    for (const Vertex v : mesh_.vertices()) {
        mesh_.point(v) = to_cgal(mesh.material[v]);
        id_[v] = ids[v];
        world_[v] = mesh.world[v];
        vertices_.add(ids[v], v);
    }
    connect(mesh, edges);
    for (std::size_t v = 0; v < ids.size(); ++v)
        if (vertices[v] != ids[v]) sew(ids[v], vertices[v]);
}

std::vector<VertexId> SurgeryMesh::points_at(VertexId point) const
{
    const auto at = seam_points_.find(vertex_of(point));
    return at == seam_points_.end() ? std::vector<VertexId>{point} : at->second;
}

void SurgeryMesh::sew(VertexId point, VertexId vertex)
{
    std::vector<VertexId>& points = seam_points_[vertex];
    for (const VertexId p : {vertex, point}) {
        if (!vertex_of_.try_emplace(p, vertex).second) continue;
        points.insert(std::lower_bound(points.begin(), points.end(), p), p);
    }
}

// Connects the half-edges of the whole mesh at once: CGAL's add_face would search for existing ones at each
// face.
void SurgeryMesh::connect(const ClothMesh& mesh, const std::vector<MeshEdge>& edges)
{
    const auto at = [](int v) { return Vertex(static_cast<Mesh::size_type>(v)); };
    std::vector<std::array<Halfedge, 3>> sides(mesh.faces.size());  // half-edge that leaves each corner
    std::vector<Halfedge> border;
    const auto take_side = [&](int f, int a, Halfedge from_a) {
        const Face& face = mesh.faces[f];
        const auto k = std::find(face.begin(), face.end(), a) - face.begin();
        const bool is_forward = mesh_.target(from_a) == at(face[(k + 1) % 3]);
        if (is_forward)
            sides[f][k] = from_a;
        else
            sides[f][(k + 2) % 3] = mesh_.opposite(from_a);
        return is_forward;
    };
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const MeshEdge& edge = edges[e];
        const Halfedge from_a = mesh_.halfedge(Mesh::Edge_index(static_cast<Mesh::size_type>(e)));
        mesh_.set_target(from_a, at(edge.b));
        mesh_.set_target(mesh_.opposite(from_a), at(edge.a));
        const bool is_forward = take_side(edge.face_left, edge.a, from_a);
        if (edge.face_right >= 0)
            take_side(edge.face_right, edge.a, from_a);
        else
            border.push_back(is_forward ? mesh_.opposite(from_a) : from_a);
    }
    for (const auto face : mesh_.faces()) {
        const std::array<Halfedge, 3>& around = sides[face];
        mesh_.set_halfedge(face, around[0]);
        for (int k = 0; k < 3; ++k) {
            mesh_.set_face(around[k], face);
            mesh_.set_next(around[k], around[(k + 1) % 3]);
            mesh_.set_halfedge(mesh_.target(around[k]), around[k]);
        }
    }
    // The next of a border half-edge is the one that leaves its target. A border vertex's own half-edge is on
    // the border.
    std::vector<Halfedge> leaving(static_cast<std::size_t>(mesh.vertex_count()));
    for (const Halfedge h : border) leaving[mesh_.source(h)] = h;
    for (const Halfedge h : border) {
        mesh_.set_next(h, leaving[mesh_.target(h)]);
        mesh_.set_halfedge(mesh_.target(h), h);
    }
    assert(mesh_.is_valid(false) && "the mesh must be an oriented manifold");
}

SurgeryMesh::Halfedge SurgeryMesh::halfedge(VertexId a, VertexId b) const
{
    const std::uint32_t at_a = vertices_.find(a), at_b = vertices_.find(b);
    if (at_a == VertexTable::kNone || at_b == VertexTable::kNone) return Mesh::null_halfedge();
    return mesh_.halfedge(Vertex(at_a), Vertex(at_b));
}

VertexRing SurgeryMesh::ring(VertexId v) const
{
    // The next half-edge that arrives at the vertex, counter-clockwise, is the one before the opposite of the
    // last.
    const Halfedge first = mesh_.halfedge(vertex(v));
    VertexRing ring;
    ring.vertices.reserve(8);  // most vertices have no more neighbours
    std::size_t start = 0;
    for (Halfedge h = first;;) {
        if (mesh_.is_border(h)) {
            ring.is_closed = false;
            start = ring.vertices.size();
        }
        ring.vertices.push_back(id_[mesh_.source(h)]);
        h = mesh_.prev(mesh_.opposite(h));
        if (h == first) break;
    }
    if (ring.is_closed)
        start = std::min_element(ring.vertices.begin(), ring.vertices.end()) - ring.vertices.begin();
    std::rotate(ring.vertices.begin(), ring.vertices.begin() + static_cast<std::ptrdiff_t>(start),
                ring.vertices.end());
    return ring;
}

void SurgeryMesh::set_role(VertexId v, TraceRole role, int tag)
{
    role_[vertex(v)] = role;
    tag_[vertex(v)] = role == TraceRole::Free ? kNoTag : tag;
}

std::vector<VertexId> SurgeryMesh::trace_neighbours(VertexId v) const
{
    std::vector<VertexId> found;
    for (const VertexId n : ring(v).vertices)
        if (edge_tag(halfedge(v, n)) != kNoTag) found.push_back(n);
    return found;
}

void SurgeryMesh::move(VertexId v, const Vec2& material, const Vec3& world)
{
    mesh_.point(vertex(v)) = to_cgal(material);
    world_[vertex(v)] = world;
}

void SurgeryMesh::name_new_vertex(Vertex v, const VertexChange& made)
{
    id_[v] = made.vertex;
    vertices_.add(made.vertex, v);
    move(made.vertex, made.new_material, made.new_world);
}

void SurgeryMesh::split_edge(VertexId a, VertexId b, const VertexChange& made)
{
    // CGAL puts the new vertex between the half-edge's source and the half-edge.
    const Halfedge old = halfedge(a, b);
    const int tag = edge_tag(old);
    const Halfedge added = CGAL::Euler::split_edge(old, mesh_);
    set_edge_tag(added, tag);
    name_new_vertex(mesh_.target(added), made);
    if (has_face(old)) CGAL::Euler::split_face(added, mesh_.next(old), mesh_);
    const Halfedge back = mesh_.opposite(old);
    if (has_face(back)) CGAL::Euler::split_face(back, mesh_.next(mesh_.opposite(added)), mesh_);
}

void SurgeryMesh::split_face(const IdFace& face, const VertexChange& made)
{
    const Halfedge spoke = CGAL::Euler::add_center_vertex(halfedge(face[0], face[1]), mesh_);
    name_new_vertex(mesh_.target(spoke), made);
}

void SurgeryMesh::collapse(VertexId removed, VertexId kept)
{
    std::vector<std::pair<VertexId, int>> tags;
    for (const VertexId end : {removed, kept})
        for (const VertexId n : trace_neighbours(end))
            if (n != removed && n != kept) tags.emplace_back(n, edge_tag(halfedge(end, n)));
    // CGAL keeps the target of the half-edge that the edge is made of.
    [[maybe_unused]] const Vertex left =
        CGAL::Euler::collapse_edge(mesh_.edge(halfedge(removed, kept)), mesh_);
    assert(left == vertex(kept) && "the other vertex was removed");
    vertices_.remove(removed);
    if (const auto at = vertex_of_.find(removed); at != vertex_of_.end()) {
        if (std::erase(seam_points_[at->second], removed) > 0 && seam_points_[at->second].empty())
            seam_points_.erase(at->second);
        vertex_of_.erase(at);
    }
    for (const auto& [n, tag] : tags) set_edge_tag(halfedge(kept, n), tag);
}

void SurgeryMesh::flip(VertexId a, VertexId b)
{
    CGAL::Euler::flip_edge(halfedge(a, b), mesh_);
}

void SurgeryMesh::write(SurgeryResult& result) const
{
    write_points(result);
    if (!vertex_of_.empty()) sew_points(result);
}

void SurgeryMesh::write_points(SurgeryResult& result) const
{
    std::vector<int> index(mesh_.number_of_vertices() + mesh_.number_of_removed_vertices());
    const auto count = static_cast<std::size_t>(vertices_.count());
    result.ids.reserve(count);
    result.mesh.material.reserve(count);
    result.mesh.world.reserve(count);
    result.roles.reserve(count);
    result.tags.reserve(count);
    for (const std::uint32_t at : vertices_.in_order()) {
        const Vertex v(at);
        index[v] = static_cast<int>(result.ids.size());
        result.ids.push_back(id_[v]);
        result.mesh.material.push_back(to_eigen(mesh_.point(v)));
        result.mesh.world.push_back(world_[v]);
        result.roles.push_back(role_[v]);
        result.tags.push_back(tag_[v]);
    }
    result.mesh.faces.reserve(mesh_.number_of_faces());
    for (const auto f : mesh_.faces()) {
        const Halfedge h = mesh_.halfedge(f);
        Face face = {index[mesh_.source(h)], index[mesh_.target(h)], index[mesh_.target(mesh_.next(h))]};
        result.mesh.faces.push_back(from_least(face));
    }
    sort_faces(result.mesh.vertex_count(), result.mesh.faces);
}

// Makes of every point but the first of its vertex a further point.
void SurgeryMesh::sew_points(SurgeryResult& result) const
{
    std::vector<VertexId> firsts;
    std::vector<int> vertex_of;
    SurgeryResult sewn;
    for (std::size_t p = 0; p < result.ids.size(); ++p) {
        const VertexId id = result.ids[p], first = this->vertex_of(id);
        vertex_of.push_back(
            static_cast<int>(std::lower_bound(firsts.begin(), firsts.end(), first) - firsts.begin()));
        if (first != id) {
            sewn.seam_ids.push_back(id);
            continue;
        }
        firsts.push_back(id);
        sewn.roles.push_back(result.roles[p]);
        sewn.tags.push_back(result.tags[p]);
    }
    sewn.ids = std::move(firsts);
    sewn.next_id = result.next_id;
    sewn.mesh = arris::sew(std::move(result.mesh), vertex_of);
    // Faces start at their least vertex again.
    ClothMesh& mesh = sewn.mesh;
    std::vector<std::array<Face, 2>> corners;
    for (int f = 0; f < mesh.face_count(); ++f) {
        Face face = mesh.faces[f], points = mesh.points_of(f);
        const auto least = std::min_element(face.begin(), face.end()) - face.begin();
        std::rotate(face.begin(), face.begin() + least, face.end());
        std::rotate(points.begin(), points.begin() + least, points.end());
        corners.push_back({face, points});
    }
    std::sort(corners.begin(), corners.end());
    for (int f = 0; f < mesh.face_count(); ++f) {
        mesh.faces[f] = corners[f][0];
        mesh.face_points[f] = corners[f][1];
    }
    result = std::move(sewn);
}

}  // namespace arris
