// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surgery/material_walk.h"

#include "geometry/cgal.h"

namespace arris {
namespace {

// For border vertices. Every border has corners, which are fixed, and is straight between them: so the loop
// ends.
bool leads_off_border(const ClothSurgery& surgery, VertexId v, const Vec2& way)
{
    const Vec2 X = surgery.material(v);
    const auto ends = [&](VertexId at) {
        const VertexRing ring = surgery.ring(at);
        return std::array<VertexId, 2>{ring.vertices.front(), ring.vertices.back()};
    };
    VertexId last = v, at = ends(v)[0];
    if (!((surgery.material(at) - X).dot(way) > 0.0)) at = ends(v)[1];
    while ((surgery.material(at) - X).norm() < way.norm()) {
        if (surgery.is_fixed(at)) return true;
        const auto [a, b] = ends(at);
        const VertexId next = a == last ? b : a;
        last = at;
        at = next;
    }
    return false;
}

}  // namespace

RingHit first_hit(const ClothSurgery& surgery, VertexId from, const Vec2& to)
{
    const Vec2 origin = surgery.material(from);
    const auto side = [&](VertexId v) { return exact_orientation(origin, to, surgery.material(v)); };
    const auto is_ahead = [&](VertexId v) { return (surgery.material(v) - origin).dot(to - origin) > 0.0; };
    for (const IdFace& face : surgery.faces_at(from)) {
        const int right = side(face[1]);
        const int left = side(face[2]);
        if (right == 0 && is_ahead(face[1])) return {face[1], kNoVertex};
        if (left == 0 && is_ahead(face[2])) return {face[2], kNoVertex};
        if (right < 0 && left > 0) return {face[1], face[2]};
    }
    return {};
}

MaterialWalk::MaterialWalk(const ClothSurgery& surgery, VertexId from, const Vec2& to)
    : surgery_(surgery), from_(surgery.material(from)), to_(to), hit_(first_hit(surgery, from, to))
{
}

bool MaterialWalk::is_past_end() const
{
    const Vec2 p = surgery_.material(hit_.p);
    if (hit_.is_vertex()) return (p - to_).dot(to_ - from_) >= 0.0;
    return exact_orientation(p, surgery_.material(hit_.q), to_) >= 0;
}

void MaterialWalk::cross_next()
{
    if (hit_.is_vertex()) {
        hit_ = first_hit(surgery_, hit_.p, to_);
        return;
    }
    const VertexId apex = surgery_.apex(hit_.q, hit_.p);
    if (apex == kNoVertex) {
        hit_ = {};
        return;
    }
    const int side = exact_orientation(from_, to_, surgery_.material(apex));
    if (side == 0) hit_ = {apex, kNoVertex};
    if (side < 0) hit_.p = apex;
    if (side > 0) hit_.q = apex;
}

bool leads_off(const ClothSurgery& surgery, VertexId v, const Vec2& way)
{
    const Vec2 to = surgery.material(v) + way;
    if (to == surgery.material(v)) return false;  // also if the way is below rounding
    if (surgery.is_border(v)) return leads_off_border(surgery, v, way);
    MaterialWalk walk(surgery, v, to);
    // In a valid mesh the walk ends long before this bound.
    for (int left = 4 * surgery.vertex_count(); left > 0; --left) {
        if (walk.has_left()) return true;
        if (walk.is_past_end()) return false;
        if (walk.hit().is_vertex() && surgery.is_border(walk.hit().p)) return true;
        walk.cross_next();
    }
    return false;
}

}  // namespace arris
