// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/surgery/patch_quality.h"

namespace arris {

/// Result of an insertion on a feature. `vertex` was there already, was moved there, or is new.
struct TraceInsertion {
    Verdict verdict = Verdict::Done;
    VertexId vertex = kNoVertex;
};

/// Properties of a new trace vertex.
struct TraceVertex {
    TraceRole role = TraceRole::OnTrace;
    int tag = 0;
    Vec2 way = Vec2::Zero();  ///< coming displacement in the material, m; zero if none
};

/// Puts a trace vertex where a feature crosses the edge a-b, at (1 - s) a + s b. The nearer end moves there
/// if it is within 0.3 of the target length, else the edge is split. A border vertex moves only along the
/// border; a fixed vertex or one on a trace never moves. An end on a trace of the same tag is used where it
/// is, and keeps its role if it is a Node. A border vertex within 1e-9 of the target length is used where it
/// is. Refused with
///  - Fixed: the vertex there is a corner.
///  - Quality: an end that cannot move is nearer than 5 % of the edge; or 0.1 % if it is on another trace, or
///    if at the end of its way the trace has left that end behind by 5 % of the edge.
///  - Trace: the edge itself belongs to another feature.
///  - Guard: the guard does not let an end move there, as where cloth is folded beside its feature.
/// The edge is split instead of Guard, unless that would be refused with Quality, in two cases. The trace is
/// about to move away from that end; or the end is farther than both a tenth of the target length and the
/// trace's way.
TraceInsertion insert_edge_crossing(ClothSurgery& surgery, const MeshTarget& target, VertexId a, VertexId b,
                                    double s, const TraceVertex& made);

/// Puts a trace vertex inside a face, at `weights` of its corners. The nearest corner that may move and is
/// within 0.3 of the target length moves there. Otherwise the face is split, and its edge nearest to the
/// point is flipped if that opens angles.
TraceInsertion insert_face_point(ClothSurgery& surgery, const MeshTarget& target, const IdFace& face,
                                 const Vec3& weights, const TraceVertex& made);

/// Inserts a trace vertex at a material point, which is searched from the vertex `near` outwards. It is
/// inserted on an edge if one is within 1e-9 of the target length, else inside the face. Missing if no face
/// holds the point.
TraceInsertion insert_trace_point(ClothSurgery& surgery, const MeshTarget& target, const Vec2& material,
                                  VertexId near, const TraceVertex& made);

struct TraceJoin {
    Verdict verdict = Verdict::Done;
    std::vector<VertexId> vertices;  ///< from a to b, if the verdict is Done
};

/// Makes mesh edges along the straight line from one trace vertex to another, and tags them. Free vertices
/// within 0.3 of the target length of the line move onto it. An edge whose flip joins the ends is flipped;
/// other edges are split where the line crosses them. The walk never comes to a vertex twice and takes at
/// most 4 * crossings + 16 steps (Budget).
/// Refused are what insert_edge_crossing refuses, a line through another trace (Trace), and one through the
/// border or a fixed vertex (Border, Fixed). A walk refused midway removes the tags it has set; the mesh is
/// then valid, but may be finer.
TraceJoin join_trace_vertices(ClothSurgery& surgery, const MeshTarget& target, VertexId a, VertexId b,
                              int tag);

}  // namespace arris
