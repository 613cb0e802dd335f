// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "geometry/cloth/cloth_mesh.h"
#include "geometry/cloth/mesh_topology.h"

namespace arris {

inline constexpr VertexId kNoVertex = 0xffffffffu;

/// Counter-clockwise in material space.
using IdFace = std::array<VertexId, 3>;

/// Tag of a vertex or edge on no feature. Tags of features are chosen by the caller: any number from 0.
inline constexpr int kNoTag = -1;

/// Role of a vertex in a trace, the line of mesh edges that lies on a feature. Clean-up may remove a Free
/// vertex, and may merge an OnTrace vertex with its neighbour along the trace. It leaves a Node (an end, a
/// bend, a corner of the obstacle) unchanged.
enum class TraceRole { Free, OnTrace, Node };

/// Result of an operation. Every verdict but Done leaves the mesh unchanged.
enum class Verdict {
    Done,
    Missing,      ///< no such vertex, edge or face
    Argument,     ///< a fraction outside (0, 1), weights of no inner point, a number not finite
    Fixed,        ///< the vertex is a corner of the cloth, fixed by the caller, or a node
    Border,       ///< the operation would leave, change or cross the border
    Trace,        ///< the operation would cut, bend or merge a trace
    Topology,     ///< no triangulated surface with boundary would remain
    Orientation,  ///< a face would not be counter-clockwise (exact)
    Quality,      ///< a face would be too thin, or a vertex that cannot move is too close
    Guard,        ///< the caller's guard refused
    Budget,       ///< a walk exceeded its bound on steps
};

enum class SurgeryOperation { SplitEdge, SplitFace, Move, Collapse, Flip };

/// A face with its corners' positions.
struct PatchFace {
    IdFace vertices;
    std::array<Vec2, 3> material;  ///< m
    std::array<Vec3, 3> world;     ///< m
    IdFace cloth_vertices;         ///< `vertices`, or on seams those of the cloth (ClothSurgery::vertex_of)
};

/// A vertex that an operation makes (a split), moves, or removes (a collapse).
/// On a seam there is a change for each of the vertex's points, in the faces of its own.
/// New or moved vertex: the old surface has `new_world` at `new_material`, with `weights` of `parents` there.
/// The third weight of an edge split is 0. A moved vertex may keep its world position instead (VertexMove).
/// Removed vertex: the old position is its own. The first parent, with weight 1, is the vertex it was merged
/// into.
struct VertexChange {
    VertexId vertex;
    Vec2 old_material, new_material;
    Vec3 old_world, new_world;
    IdFace parents;
    Vec3 weights;
};

/// One operation: a proposal, and after the commit its record. The faces `after` replace the faces `before`;
/// both cover the same part of the material.
struct SurgeryEvent {
    SurgeryOperation operation;
    std::array<VertexId, 2> edge = {kNoVertex, kNoVertex};  ///< split, collapsed (first into second), flipped
    TraceRole role = TraceRole::Free;                       ///< of a new vertex
    int tag = kNoTag;                                       ///< tag of the new vertex's feature
    std::vector<VertexChange> changes;  ///< one; none for a flip; for a move one per vertex; two on a seam
    std::vector<PatchFace> before, after;
};

struct SurgeryProposal {
    Verdict verdict = Verdict::Done;
    SurgeryEvent event;  ///< meaningful if the verdict is Done

    bool is_legal() const { return verdict == Verdict::Done; }
};

struct VertexMove {
    VertexId vertex;
    Vec2 material;  ///< new position, m
    /// True: the world position stays, as the vertex flows through the material and the time step gives its
    /// place. False: the surface stays, and the world position is interpolated on it.
    bool keeps_world = false;
};

/// The neighbours of a vertex, counter-clockwise. They start at the least id, or run from border to border.
struct VertexRing {
    std::vector<VertexId> vertices;
    bool is_closed = true;
};

/// Called before each commit; false refuses the operation.
using SurgeryGuard = std::function<bool(const SurgeryEvent&)>;

struct SurgeryResult {
    ClothMesh mesh;                  ///< vertices ascend by id; faces start at their least vertex and ascend
    std::vector<VertexId> ids;       ///< ascending
    std::vector<VertexId> seam_ids;  ///< of further points, ascending
    VertexId next_id = 0;
    std::vector<TraceRole> roles;
    std::vector<int> tags;
    struct TaggedEdge {
        int a, b;  ///< indices in the mesh, a < b; ascending
        int tag;
    };
    std::vector<TaggedEdge> tagged_edges;
};

/// The cloth's mesh under surgery in material space. The mesh is always an oriented manifold whose faces are
/// counter-clockwise by exact predicate. The border's polygon, the cloth's corners and fixed vertices stay; a
/// vertex put on a slanted border is off the border by rounding. Both ends of a tagged edge have a role other
/// than Free. An operation is proposed (const, nothing changes), inspected, and committed or dropped. Every
/// commit calls the guard and is recorded in order. A proposal is valid until the next change.
///
/// Sewn cloth lies in the material as its panels do: here every point is a vertex, and a seam is a border of
/// each side. What splits or merges a seam's edge does so on both sides at once, and what moves a point along
/// a seam moves the one beyond by the same share of its edge. Where seams meet, end,
/// bend or are eased their points are fixed: what is sewn to what never changes. Points of one vertex have
/// the same role.
///
/// No result depends on the history of the mesh: a surgery rebuilt from `result()` behaves identically.
/// Queries of one vertex take constant time on average, plus time for its degree.
class ClothSurgery {
  public:
    /// `mesh` must pass `validate`; `ids` ascend, one per vertex, all below `next_id`. `fixed` vertices
    /// (pins) are neither moved nor removed. Corners of the border are fixed, too: border vertices off the
    /// line between their border neighbours by more than rounding. `seam_ids`: of the mesh's further points,
    /// ascending, each greater than its vertex's.
    ClothSurgery(const ClothMesh& mesh, const std::vector<VertexId>& ids, VertexId next_id,
                 const std::vector<VertexId>& fixed = {}, const std::vector<VertexId>& seam_ids = {});
    /// As above, for a mesh without seams whose edges are known (make_topology).
    ClothSurgery(const ClothMesh& mesh, const std::vector<VertexId>& ids, VertexId next_id,
                 const std::vector<VertexId>& fixed, const std::vector<MeshEdge>& edges);
    ~ClothSurgery();
    ClothSurgery(ClothSurgery&& other) noexcept;
    ClothSurgery& operator=(ClothSurgery&& other) noexcept;

    void set_guard(SurgeryGuard guard);

    // --- queries; the vertices given must exist

    int vertex_count() const;
    bool has_vertex(VertexId v) const;
    bool has_edge(VertexId a, VertexId b) const;
    /// The vertex left of a -> b, or kNoVertex where there is no face.
    VertexId apex(VertexId a, VertexId b) const;
    bool is_border(VertexId v) const;
    bool is_border_edge(VertexId a, VertexId b) const;
    bool is_fixed(VertexId v) const;
    bool is_on_seam(VertexId v) const;
    /// Id of the cloth's vertex at which this point is: its own, but on a seam.
    VertexId vertex_of(VertexId point) const;
    /// The points at that vertex, ascending.
    std::vector<VertexId> points_at(VertexId point) const;
    /// Edge a-b as it is on the other side of a seam, from the point beyond a to the one beyond b; nothing
    /// where the edge is on no seam.
    std::optional<std::array<VertexId, 2>> partner(VertexId a, VertexId b) const;
    /// An edge of the mesh between points at these two vertices.
    std::optional<std::array<VertexId, 2>> edge_between(VertexId a, VertexId b) const;
    /// Map of material directions at one point of a vertex to those at another, across a seam with two
    /// sides; the identity elsewhere.
    Mat2 turn_over(VertexId from, VertexId to) const;
    Vec2 material(VertexId v) const;
    Vec3 world(VertexId v) const;
    TraceRole role(VertexId v) const;
    int tag(VertexId v) const;
    int edge_tag(VertexId a, VertexId b) const;  ///< kNoTag also if there is no such edge
    VertexRing ring(VertexId v) const;
    /// The faces at v, each with v first, in the order of the ring of v.
    std::vector<IdFace> faces_at(VertexId v) const;
    PatchFace patch_face(const IdFace& face) const;

    // --- roles and tags: changes are never refused

    void set_role(VertexId v, TraceRole role, int tag);
    /// The edge must exist. For a tag other than kNoTag, both its ends must have a role.
    void set_edge_tag(VertexId a, VertexId b, int tag);
    /// Makes v Free and removes the tags of its trace edges. OnTrace neighbours left without a trace edge
    /// become Free, too.
    void release_vertex(VertexId v);
    void release_edge(VertexId a, VertexId b);

    // --- proposals

    /// Makes a vertex at (1 - s) a + s b. On a tagged edge the vertex is OnTrace with the tag of the edge,
    /// unless `role` is given.
    SurgeryProposal propose_edge_split(VertexId a, VertexId b, double s, TraceRole role = TraceRole::Free,
                                       int tag = kNoTag) const;
    /// Makes a vertex in the face, at `weights` of its corners; these are positive and are scaled to sum 1.
    SurgeryProposal propose_face_split(const IdFace& face, const Vec3& weights,
                                       TraceRole role = TraceRole::Free, int tag = kNoTag) const;
    /// Moves all the vertices at once. Border vertices move only along the line of the border, those of a
    /// seam only where it has two sides and is straight on both.
    SurgeryProposal propose_moves(const std::vector<VertexMove>& moves) const;
    /// Removes v and gives its faces to w, which does not move. v must be Free, or have exactly two trace
    /// edges, of one tag, one of which ends at w. Along a seam, only between vertices of two points each.
    SurgeryProposal propose_collapse(VertexId v, VertexId w) const;
    SurgeryProposal propose_flip(VertexId a, VertexId b) const;

    /// Returns Done, Guard, or the proposal's own verdict. A new vertex has the id that the event states.
    Verdict commit(const SurgeryProposal& proposal);

    // --- record of changes

    const std::vector<SurgeryEvent>& events() const;
    /// Returns the vertices touched since the last call that still exist, ascending. Touched are the vertices
    /// of new faces, released vertices and the arguments of `touch`.
    std::vector<VertexId> take_touched();
    void touch(VertexId v);
    SurgeryResult result() const;

  private:
    class Implementation;
    void make(const ClothMesh& mesh, const std::vector<VertexId>& ids, const std::vector<VertexId>& vertices,
              VertexId next_id, const std::vector<VertexId>& fixed, const std::vector<MeshEdge>& edges);
    std::unique_ptr<Implementation> implementation_;
};

/// Short name of a verdict, for reports and tests.
const char* to_string(Verdict verdict);

}  // namespace arris
