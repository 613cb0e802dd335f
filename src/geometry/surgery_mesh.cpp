// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surgery_mesh.h"

#include <CGAL/boost/graph/Euler_operations.h>

#include <algorithm>
#include <cassert>
#include <utility>

namespace arris {

SurgeryMesh::SurgeryMesh(const ClothMesh& mesh, const std::vector<VertexId>& ids)
{
    id_ = mesh_.add_property_map<Vertex, VertexId>("v:id", kNoVertex).first;
    world_ = mesh_.add_property_map<Vertex, Vec3>("v:world", Vec3::Zero()).first;
    is_fixed_ = mesh_.add_property_map<Vertex, bool>("v:is_fixed", false).first;
    role_ = mesh_.add_property_map<Vertex, TraceRole>("v:role", TraceRole::Free).first;
    tag_ = mesh_.add_property_map<Vertex, int>("v:tag", kNoTag).first;
    edge_tag_ = mesh_.add_property_map<Mesh::Edge_index, int>("e:tag", kNoTag).first;
    const auto vertices = static_cast<Mesh::size_type>(mesh.vertex_count());
    const auto faces = static_cast<Mesh::size_type>(mesh.face_count());
    mesh_.reserve(vertices, vertices + faces, faces);
    vertex_of_.reserve(ids.size());
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Vertex added = mesh_.add_vertex(to_cgal(mesh.material[v]));
        id_[added] = ids[v];
        world_[added] = mesh.world[v];
        vertex_of_.emplace(ids[v], added);
    }
    const auto at = [](int v) { return Vertex(static_cast<Mesh::size_type>(v)); };
    for (const Face& f : mesh.faces) {
        [[maybe_unused]] const auto added = mesh_.add_face(at(f[0]), at(f[1]), at(f[2]));
        assert(added != Mesh::null_face() && "the mesh must be an oriented manifold");
    }
}

SurgeryMesh::Halfedge SurgeryMesh::halfedge(VertexId a, VertexId b) const
{
    if (!has(a) || !has(b)) return Mesh::null_halfedge();
    return mesh_.halfedge(vertex(a), vertex(b));
}

VertexRing SurgeryMesh::ring(VertexId v) const
{
    // Of two half-edges that arrive one after the other, counter-clockwise, the second is the one before the
    // first's opposite.
    const Halfedge first = mesh_.halfedge(vertex(v));
    VertexRing ring;
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
    vertex_of_.emplace(made.vertex, v);
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
    vertex_of_.erase(removed);
    for (const auto& [n, tag] : tags) set_edge_tag(halfedge(kept, n), tag);
}

void SurgeryMesh::flip(VertexId a, VertexId b)
{
    CGAL::Euler::flip_edge(halfedge(a, b), mesh_);
}

std::vector<VertexId> SurgeryMesh::ids() const
{
    std::vector<VertexId> ids;
    ids.reserve(vertex_of_.size());
    for (const Vertex v : mesh_.vertices()) ids.push_back(id_[v]);
    std::sort(ids.begin(), ids.end());
    return ids;
}

std::vector<IdFace> SurgeryMesh::faces() const
{
    std::vector<IdFace> faces;
    faces.reserve(mesh_.number_of_faces());
    for (const auto f : mesh_.faces()) {
        const Halfedge h = mesh_.halfedge(f);
        IdFace face = {id_[mesh_.source(h)], id_[mesh_.target(h)], apex(h)};
        std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
        faces.push_back(face);
    }
    std::sort(faces.begin(), faces.end());
    return faces;
}

}  // namespace arris
