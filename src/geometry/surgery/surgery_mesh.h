// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CGAL/Surface_mesh.h>

#include <cassert>
#include <map>
#include <unordered_map>

#include "geometry/cgal.h"
#include "geometry/surgery/cloth_surgery.h"
#include "geometry/surgery/vertex_table.h"

namespace arris {

/// CGAL's half-edge mesh in the material plane with persistent ids: bookkeeping and changes of connectivity,
/// without decisions. For .cpp files of the surgery only. Every id given must exist. The caller must know
/// that a change is legal.
class SurgeryMesh {
  public:
    using Mesh = CGAL::Surface_mesh<Point2>;
    using Vertex = Mesh::Vertex_index;
    using Halfedge = Mesh::Halfedge_index;

    /// `mesh` has no seams. `vertices`: whose vertex of the cloth each one is (ClothSurgery::vertex_of).
    SurgeryMesh(const ClothMesh& mesh, const std::vector<VertexId>& ids, const std::vector<MeshEdge>& edges,
                const std::vector<VertexId>& vertices);

    int vertex_count() const { return vertices_.count(); }
    bool has(VertexId v) const { return vertices_.find(v) != VertexTable::kNone; }
    Vertex vertex(VertexId v) const
    {
        assert(has(v) && "a vertex of this mesh");
        return Vertex(vertices_.find(v));
    }
    VertexId id(Vertex v) const { return id_[v]; }
    /// The half-edge from a to b; null if they are not neighbours.
    Halfedge halfedge(VertexId a, VertexId b) const;
    bool has_face(Halfedge h) const { return !mesh_.is_border(h); }
    VertexId apex(Halfedge h) const { return id_[mesh_.target(mesh_.next(h))]; }
    bool is_border_edge(Halfedge h) const { return mesh_.is_border(mesh_.edge(h)); }
    VertexRing ring(VertexId v) const;
    bool is_on_border(VertexId v) const { return mesh_.is_border(vertex(v)); }

    VertexId vertex_of(VertexId point) const
    {
        const auto at = vertex_of_.find(point);
        return at == vertex_of_.end() ? point : at->second;
    }
    bool is_on_seam(VertexId point) const { return vertex_of_.contains(point); }
    /// The points of the vertex that has this one, ascending.
    std::vector<VertexId> points_at(VertexId point) const;
    /// Makes a point one of a vertex.
    void sew(VertexId point, VertexId vertex);

    Vec2 material(VertexId v) const { return to_eigen(mesh_.point(vertex(v))); }
    Vec3& world(VertexId v) { return world_[vertex(v)]; }
    const Vec3& world(VertexId v) const { return world_[vertex(v)]; }
    bool is_fixed(VertexId v) const { return is_fixed_[vertex(v)]; }
    void fix(VertexId v) { is_fixed_[vertex(v)] = true; }
    TraceRole role(VertexId v) const { return role_[vertex(v)]; }
    int tag(VertexId v) const { return tag_[vertex(v)]; }
    void set_role(VertexId v, TraceRole role, int tag);
    int edge_tag(Halfedge h) const { return edge_tag_[mesh_.edge(h)]; }
    void set_edge_tag(Halfedge h, int tag) { edge_tag_[mesh_.edge(h)] = tag; }
    /// The neighbours of v along its trace, that is along edges with a tag, in the order of the ring of v.
    std::vector<VertexId> trace_neighbours(VertexId v) const;

    void move(VertexId v, const Vec2& material, const Vec3& world);
    /// Both halves keep the edge's tag.
    void split_edge(VertexId a, VertexId b, const VertexChange& made);
    void split_face(const IdFace& face, const VertexChange& made);
    /// Where two edges merge into one, the tag of either is kept.
    void collapse(VertexId removed, VertexId kept);
    void flip(VertexId a, VertexId b);

    /// Writes the vertices and faces to `result`.
    void write(SurgeryResult& result) const;

  private:
    void write_points(SurgeryResult& result) const;
    void sew_points(SurgeryResult& result) const;
    void connect(const ClothMesh& mesh, const std::vector<MeshEdge>& edges);
    void name_new_vertex(Vertex v, const VertexChange& made);

    Mesh mesh_;
    Mesh::Property_map<Vertex, VertexId> id_;
    Mesh::Property_map<Vertex, Vec3> world_;
    Mesh::Property_map<Vertex, bool> is_fixed_;
    Mesh::Property_map<Vertex, TraceRole> role_;
    Mesh::Property_map<Vertex, int> tag_;
    Mesh::Property_map<Mesh::Edge_index, int> edge_tag_;
    VertexTable vertices_;
    std::unordered_map<VertexId, VertexId> vertex_of_;       // of points on seams
    std::map<VertexId, std::vector<VertexId>> seam_points_;  // by vertex
};

}  // namespace arris
