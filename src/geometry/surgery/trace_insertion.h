// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/surgery/patch_quality.h"

namespace arris {

/// A vertex on a feature: `vertex` is one that was there already, was moved there, or is new.
struct TraceInsertion {
    Verdict verdict = Verdict::Done;
    VertexId vertex = kNoVertex;
};

/// What a new trace vertex is.
struct TraceVertex {
    TraceRole role = TraceRole::OnTrace;
    int tag = 0;
    Vec2 way = Vec2::Zero();  ///< m, that it is about to go through the material, if any
};

/// Puts a trace vertex where a feature crosses the edge a-b, at (1 - s) a + s b. The nearer end, if it is
/// within 0.3 of the target length, moves there (a border vertex only along the border, a fixed or traced one
/// never; a traced one of the same tag is taken as it is, a Node's role staying), else the edge is split.
/// A border vertex within 1e-9 of the target length is taken where it is. Fixed: that is a corner.
/// Quality: nearer than 5 % of the edge to an end that cannot give way (0.1 % if that end is itself on
/// another trace: features may be close). Trace: the edge itself is another feature's.
/// An end that the guard does not let move there, as where cloth is folded beside its feature: Guard, but
/// where the trace is about to go away from it the edge is split however near it is (0.1 %), and where it is
/// farther than a tenth of the target length and the way that the trace is about to go.
TraceInsertion insert_edge_crossing(ClothSurgery& surgery, const MeshTarget& target, VertexId a, VertexId b,
                                    double s, const TraceVertex& made);

/// Puts a trace vertex inside a face, at `weights` of its corners: the nearest corner moves there if it may
/// and is within 0.3 of the target length, else the face is split, and its edge nearest to the point flipped
/// where that opens angles.
TraceInsertion insert_face_point(ClothSurgery& surgery, const MeshTarget& target, const IdFace& face,
                                 const Vec3& weights, const TraceVertex& made);

/// One of both, for a material point that is searched from the vertex `near` outwards; on an edge where it is
/// within 1e-9 of the target length of it. Missing where no face holds the point.
TraceInsertion insert_trace_point(ClothSurgery& surgery, const MeshTarget& target, const Vec2& material,
                                  VertexId near, const TraceVertex& made);

struct TraceJoin {
    Verdict verdict = Verdict::Done;
    std::vector<VertexId> vertices;  ///< from a to b, if it is done
};

/// Mesh edges along the straight line from one trace vertex to another, all tagged. Free vertices within 0.3
/// of the target length of the line move onto it, an edge whose flip joins the ends is flipped, others are
/// split where the line crosses them. The walk never comes to a vertex twice and takes at most
/// 4 * crossings + 16 steps (Budget). Refused: what the insertion of a crossing refuses, a line through
/// another trace (Trace), through the border or a fixed vertex (Border, Fixed). Refused in the middle, what
/// was tagged on the way is released again, and the mesh is valid and may be finer.
TraceJoin join_trace_vertices(ClothSurgery& surgery, const MeshTarget& target, VertexId a, VertexId b,
                              int tag);

}  // namespace arris
