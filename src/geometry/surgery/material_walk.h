// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/surgery/cloth_surgery.h"

namespace arris {

/// First hit of a line from a vertex on the outline of a face or ring. It is the vertex p (q == kNoVertex),
/// or a point inside the edge from p to q, with p right of the line. No hit: p == kNoVertex.
struct RingHit {
    VertexId p = kNoVertex;
    VertexId q = kNoVertex;

    bool is_vertex() const { return q == kNoVertex; }
};

/// First hit of the line from a vertex to a point on that vertex's ring (exact). No hit if the line leaves
/// the cloth at once.
RingHit first_hit(const ClothSurgery& surgery, VertexId from, const Vec2& to);

/// Walk along a straight line through the material, from one crossing to the next. Each crossing is farther
/// from the start. In a valid mesh the walk meets no face twice, so it ends. It does not stop at the end of
/// the line.
class MaterialWalk {
  public:
    MaterialWalk(const ClothSurgery& surgery, VertexId from, const Vec2& to);

    bool has_left() const { return hit_.p == kNoVertex; }  ///< whether the walk has left the cloth
    const RingHit& hit() const { return hit_; }
    /// Whether the line's end is at or before the present crossing.
    bool is_past_end() const;
    void cross_next();

  private:
    const ClothSurgery& surgery_;
    Vec2 from_, to_;
    RingHit hit_;
};

/// Whether a vertex that moves by `way` in the material passes the border of the cloth. A border vertex moves
/// along the border: whether it passes the next fixed vertex.
bool leads_off(const ClothSurgery& surgery, VertexId v, const Vec2& way);

}  // namespace arris
