// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "geometry/cloth/cloth_mesh.h"
#include "geometry/cloth/mesh_topology.h"

namespace arris {

inline constexpr VertexId kNoVertex = 0xffffffffu;

/// Counter-clockwise in material space.
using IdFace = std::array<VertexId, 3>;

/// The tag of what lies on no feature. Others are the caller's: any number from 0.
inline constexpr int kNoTag = -1;

/// What a vertex is to a trace, the line of mesh edges that lies on a feature. Clean-up may remove a free
/// vertex, may merge one on a trace with its neighbour along it, and leaves a node (an end, a turn, a corner
/// of the obstacle) alone.
enum class TraceRole { Free, OnTrace, Node };

/// How an operation ended. All but Done leave the mesh as it was.
enum class Verdict {
    Done,
    Missing,      ///< no such vertex, edge or face
    Argument,     ///< a fraction outside (0, 1), weights that are no inner point, a number not finite
    Fixed,        ///< a corner of the cloth, a vertex the caller fixed, a node
    Border,       ///< it would leave the border, or cut something off it
    Trace,        ///< it would cut, bend or merge a trace
    Topology,     ///< no triangulated surface with boundary would remain
    Orientation,  ///< a face would not be counter-clockwise (exact)
    Quality,      ///< a face would be too thin, or the place is too close to something that cannot give way
    Guard,        ///< the caller's guard said no
    Budget,       ///< a walk's bound was hit
};

enum class SurgeryOperation { SplitEdge, SplitFace, Move, Collapse, Flip };

/// A face with its corners' places.
struct PatchFace {
    IdFace vertices;
    std::array<Vec2, 3> material;  ///< m
    std::array<Vec3, 3> world;     ///< m
};

/// A vertex that an operation makes (a split), moves or removes (a collapse).
/// New and moved: the surface as it was has `new_world` at `new_material`: `weights` of `parents` there (a
/// split edge's third weight is 0), unless the caller gave a moved vertex's world position. Removed: the old
/// place; the first parent, weight 1, is the vertex it was merged into.
struct VertexChange {
    VertexId vertex;
    Vec2 old_material, new_material;
    Vec3 old_world, new_world;
    IdFace parents;
    Vec3 weights;
};

/// One operation: proposed, then, once committed, recorded. `before` are the faces it replaces and `after`
/// those in their place; both cover the same part of the material.
struct SurgeryEvent {
    SurgeryOperation operation;
    std::array<VertexId, 2> edge = {kNoVertex, kNoVertex};  ///< split, collapsed (first into second), flipped
    TraceRole role = TraceRole::Free;                       ///< of a new vertex
    int tag = kNoTag;                                       ///< and its feature
    std::vector<VertexChange> changes;                      ///< one; none for a flip; one a vertex for a move
    std::vector<PatchFace> before, after;
};

struct SurgeryProposal {
    Verdict verdict = Verdict::Done;
    SurgeryEvent event;  ///< meaningful if the verdict is Done

    bool is_legal() const { return verdict == Verdict::Done; }
};

struct VertexMove {
    VertexId vertex;
    Vec2 material;  ///< where to
    /// True where the world position is to stay (the vertex flows through the material, its place given by
    /// the time step); false where the surface is to stay and the position is interpolated on it.
    bool keeps_world = false;
};

/// The vertices next to one, counter-clockwise; from the least id, or from border to border.
struct VertexRing {
    std::vector<VertexId> vertices;
    bool is_closed = true;
};

/// Asked before each commit; false refuses it.
using SurgeryGuard = std::function<bool(const SurgeryEvent&)>;

struct SurgeryResult {
    ClothMesh mesh;             ///< vertices ascend by id; faces start at their least and ascend
    std::vector<VertexId> ids;  ///< ascending
    VertexId next_id = 0;
    std::vector<TraceRole> roles;
    std::vector<int> tags;
    struct TaggedEdge {
        int a, b;  ///< indices in the mesh, a < b; ascending
        int tag;
    };
    std::vector<TaggedEdge> tagged_edges;
};

/// The cloth's mesh under surgery in material space. At every moment an oriented manifold with every face
/// counter-clockwise by exact predicate; the border's polygon, the cloth's corners and fixed vertices stay
/// (a vertex put on a slanted border is off it by rounding). Both ends of a tagged edge have a role other
/// than Free. Operations are proposed (const, nothing changes), looked at, and committed or dropped; every
/// commit asks the guard and is recorded in order. A proposal is valid until the next change.
///
/// No result depends on how the mesh came to be: one rebuilt from `result()` answers and goes on alike.
/// Queries of one vertex take constant time on average, plus its degree.
class ClothSurgery {
  public:
    /// `mesh` must pass `validate`; `ids` ascend, one a vertex, all below `next_id`. `fixed` vertices (pins)
    /// neither move nor go; corners of the border are found: where a border vertex is off the line between
    /// its border neighbours by more than rounding.
    ClothSurgery(const ClothMesh& mesh, const std::vector<VertexId>& ids, VertexId next_id,
                 const std::vector<VertexId>& fixed = {});
    /// The same where the mesh's edges are known.
    ClothSurgery(const ClothMesh& mesh, const std::vector<VertexId>& ids, VertexId next_id,
                 const std::vector<VertexId>& fixed, const std::vector<MeshEdge>& edges);
    ~ClothSurgery();
    ClothSurgery(ClothSurgery&& other) noexcept;
    ClothSurgery& operator=(ClothSurgery&& other) noexcept;

    void set_guard(SurgeryGuard guard);

    // --- queries; a vertex named must exist

    int vertex_count() const;
    bool has_vertex(VertexId v) const;
    bool has_edge(VertexId a, VertexId b) const;
    /// The vertex left of a -> b, or kNoVertex where there is no face.
    VertexId apex(VertexId a, VertexId b) const;
    bool is_border(VertexId v) const;
    bool is_border_edge(VertexId a, VertexId b) const;
    bool is_fixed(VertexId v) const;
    Vec2 material(VertexId v) const;
    Vec3 world(VertexId v) const;
    TraceRole role(VertexId v) const;
    int tag(VertexId v) const;
    int edge_tag(VertexId a, VertexId b) const;  ///< kNoTag too where there is no such edge
    VertexRing ring(VertexId v) const;
    /// Each with v first, in the order of its ring.
    std::vector<IdFace> faces_at(VertexId v) const;
    PatchFace patch_face(const IdFace& face) const;

    // --- what is not geometry: never refused

    void set_role(VertexId v, TraceRole role, int tag);
    /// The edge must exist and, for a tag, join two vertices that have a role.
    void set_edge_tag(VertexId a, VertexId b, int tag);
    /// An ordinary vertex from now on; the trace's edges at it too, and neighbours on the trace that are left
    /// without an edge of it.
    void release_vertex(VertexId v);
    void release_edge(VertexId a, VertexId b);

    // --- proposals

    /// New vertex (1 - s) a + s b; on a tagged edge it is on the trace, with the edge's tag, unless `role`
    /// says otherwise.
    SurgeryProposal propose_edge_split(VertexId a, VertexId b, double s, TraceRole role = TraceRole::Free,
                                       int tag = kNoTag) const;
    /// `weights` of the face's corners, positive; scaled to sum 1.
    SurgeryProposal propose_face_split(const IdFace& face, const Vec3& weights,
                                       TraceRole role = TraceRole::Free, int tag = kNoTag) const;
    /// All at once. Border vertices move along the border's line only.
    SurgeryProposal propose_moves(const std::vector<VertexMove>& moves) const;
    /// Removes v and gives its faces to w, which stays where it is. v must be free, or lie on a trace of
    /// which both its edges are and w the other end of one.
    SurgeryProposal propose_collapse(VertexId v, VertexId w) const;
    SurgeryProposal propose_flip(VertexId a, VertexId b) const;

    /// Done, Guard, or the proposal's own verdict. New vertices have the id the event names.
    Verdict commit(const SurgeryProposal& proposal);

    // --- what happened

    const std::vector<SurgeryEvent>& events() const;
    /// Ascending: the vertices of all faces made, and those released or touched by hand, that are still
    /// there, since the last call.
    std::vector<VertexId> take_touched();
    void touch(VertexId v);
    SurgeryResult result() const;

  private:
    class Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// Short, for reports and tests.
const char* to_string(Verdict verdict);

}  // namespace arris
