// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/surgery/cloth_surgery.h"

namespace arris {

/// What a line from a vertex meets on the outline of a face or ring: a vertex p (q == kNoVertex) or the
/// inside of the edge from p to q, p right of the line. Nothing: p == kNoVertex.
struct RingHit {
    VertexId p = kNoVertex;
    VertexId q = kNoVertex;

    bool is_vertex() const { return q == kNoVertex; }
};

/// What the line from a vertex to a point meets first on that vertex's ring (exact); nothing where it leads
/// off the cloth at once.
RingHit first_hit(const ClothSurgery& surgery, VertexId from, const Vec2& to);

/// Along a straight line through the material, from one crossing to the next. Each is farther from the
/// beginning; in a valid mesh no face is met twice, so it ends. It does not stop at the line's end.
class MaterialWalk {
  public:
    MaterialWalk(const ClothSurgery& surgery, VertexId from, const Vec2& to);

    bool has_left() const { return hit_.p == kNoVertex; }  ///< the cloth
    const RingHit& hit() const { return hit_; }
    /// Whether the line's end is at or before the present crossing.
    bool is_past_end() const;
    void advance();

  private:
    const ClothSurgery& surgery_;
    Vec2 from_, to_;
    RingHit hit_;
};

/// Whether a vertex that went that way through the material would get beyond the cloth's border; one that is
/// on it goes along it, and would get beyond the next fixed vertex.
bool leads_off(const ClothSurgery& surgery, VertexId v, const Vec2& way);

}  // namespace arris
