// SPDX-License-Identifier: GPL-3.0-or-later
//
// A trace is inserted from node to node:
//
//        p1      p2              From a vertex of the trace, the line to the end leaves through one edge of
//       /  \    /  \             the vertex's ring. There the line gets its next vertex: the nearer end of
//   a *----x--x------* b         that edge, moved onto the line if it is near, or a new one. Each vertex is
//       \  /    \  /             nearer to the end b than the last, so the walk ends. The bound on its
//        q1      q2              steps is for faces so thin that rounding decides.
//
// A line through an inner vertex uses that vertex. Every change is checked by ClothSurgery, so a walk that
// fails leaves a valid mesh.
#include "geometry/surgery/trace_insertion.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "geometry/cgal.h"
#include "geometry/cloth/material_box.h"
#include "geometry/cloth/mesh_limits.h"
#include "geometry/surgery/material_location.h"
#include "geometry/surgery/material_walk.h"

namespace arris {
namespace {

constexpr double kTraceFraction = 1e-3;  // as kSplitFromEnd, if the end is on another trace or is left behind
constexpr double kLeastApart = 0.1;  // of the target length: a vertex nearer to a trace may not stay ahead
constexpr double kSnapAngle = 5.0;   // degrees: a vertex does not move if that leaves a thinner face

// Moves v to `place` unless that makes a face thin that was not.
Verdict snap(ClothSurgery& surgery, VertexId v, const Vec2& place)
{
    if (surgery.role(v) != TraceRole::Free) return Verdict::Trace;
    const SurgeryProposal proposal = surgery.propose_moves({{v, place}});
    if (!proposal.is_legal()) return proposal.verdict;
    if (least_angle(proposal.event.after) < std::min(kSnapAngle, least_angle(proposal.event.before)))
        return Verdict::Quality;
    return surgery.commit(proposal);
}

// Whether v counts as at X. Border vertices have a tolerance, as they may be unable to move; inner ones can
// move.
bool is_at(const ClothSurgery& surgery, const MeshTarget& target, VertexId v, const Vec2& X)
{
    const double distance = (surgery.material(v) - X).norm();
    return surgery.is_border(v) ? distance <= kMaterialTolerance * target.length(X)
                                : surgery.material(v) == X;
}

// Whether v may be used as the new vertex. One that slides along the trace cannot be used as a node.
bool is_like(const ClothSurgery& surgery, VertexId v, const TraceVertex& made)
{
    const TraceRole role = surgery.role(v);
    return role != TraceRole::Free && surgery.tag(v) == made.tag &&
           (role == TraceRole::Node || made.role == TraceRole::OnTrace);
}

// Whether a trace at X that moves by `way` leaves v behind: thin faces between them then open.
bool is_behind(const ClothSurgery& surgery, VertexId v, const Vec2& X, const Vec2& way)
{
    return (surgery.material(v) - X).dot(way) < 0.0;
}

// Whether a vertex that cannot move onto a trace at X may stay beside it: the trace leaves it behind, or does
// not reach it soon. If it were nearer, the face between them would stay thin.
bool may_stay(const ClothSurgery& surgery, const MeshTarget& target, VertexId v, const Vec2& X,
              const Vec2& way)
{
    const double apart = (surgery.material(v) - X).norm();
    return is_behind(surgery, v, X, way) || (apart > kLeastApart * target.length(X) && apart > way.norm());
}

// Whether a split is too near to an end, so that the new faces would stay thin. They open where the trace
// leaves the end behind, if at the end of its way it is no longer too near.
bool is_crowded(const ClothSurgery& surgery, VertexId a, VertexId b, double s, const Vec2& way)
{
    const Vec2 edge = surgery.material(b) - surgery.material(a), X = surgery.material(a) + s * edge;
    const auto opens = [&](VertexId v) {
        return is_behind(surgery, v, X, way) &&
               (X + way - surgery.material(v)).norm() > kSplitFromEnd * edge.norm();
    };
    const auto least = [&](VertexId v) {
        return surgery.role(v) != TraceRole::Free || opens(v) ? kTraceFraction : kSplitFromEnd;
    };
    return s < least(a) || 1.0 - s < least(b);
}

Verdict split(ClothSurgery& surgery, VertexId a, VertexId b, double s, const TraceVertex& made,
              VertexId& vertex)
{
    if (surgery.edge_tag(a, b) != kNoTag && surgery.edge_tag(a, b) != made.tag) return Verdict::Trace;
    if (is_crowded(surgery, a, b, s, made.way)) return Verdict::Quality;
    const SurgeryProposal proposal = surgery.propose_edge_split(a, b, s, made.role, made.tag);
    if (proposal.is_legal()) vertex = proposal.event.changes[0].vertex;
    return surgery.commit(proposal);
}

// Flips the edge a-b beside a new vertex if that opens angles. A trace along a-b then goes through the
// vertex.
void flip_away(ClothSurgery& surgery, VertexId a, VertexId b, VertexId vertex, int tag)
{
    const bool is_of_trace = surgery.edge_tag(a, b) == tag;
    if (is_of_trace) surgery.set_edge_tag(a, b, kNoTag);
    const SurgeryProposal flip = surgery.propose_flip(a, b);
    const bool is_flipped = flip.is_legal() &&
                            least_angle(flip.event.after) > least_angle(flip.event.before) &&
                            surgery.commit(flip) == Verdict::Done;
    if (!is_of_trace) return;
    if (!is_flipped) return surgery.set_edge_tag(a, b, tag);
    for (const VertexId end : {a, b}) surgery.set_edge_tag(end, vertex, tag);
}

// --- the walk

// Number of edges and vertices that the line crosses, for the bound of the walk.
int count_crossings(const ClothSurgery& surgery, VertexId from, VertexId end)
{
    MaterialWalk walk(surgery, from, surgery.material(end));
    int count = 0;
    for (; !walk.has_left() && walk.hit().p != end && count < 4 * surgery.vertex_count(); ++count)
        walk.cross_next();
    return count;
}

struct Line {
    Vec2 from, to;

    double length() const { return (to - from).norm(); }
    double along(const Vec2& p) const { return (p - from).dot(to - from) / (to - from).squaredNorm(); }
    double off(const Vec2& p) const { return std::abs(twice_area(from, to, p)) / length(); }
    Vec2 foot(const Vec2& p) const { return from + along(p) * (to - from); }
};

class TraceWalk {
  public:
    TraceWalk(ClothSurgery& surgery, const MeshTarget& target, VertexId end, int tag)
        : surgery_(surgery), target_(target), end_(end), tag_(tag)
    {
    }

    TraceJoin run(VertexId begin)
    {
        TraceJoin join{Verdict::Done, {begin}};
        std::set<VertexId> visited = {begin};
        int steps = 4 * count_crossings(surgery_, begin, end_) + 16;
        while (join.vertices.back() != end_ && join.verdict == Verdict::Done) {
            if (steps-- == 0) {
                join.verdict = Verdict::Budget;
                break;
            }
            join.verdict = find_next(join.vertices.back());
            if (join.verdict == Verdict::Done && !visited.insert(next_).second)
                join.verdict = Verdict::Budget;
            if (join.verdict == Verdict::Done) join.verdict = connect(join.vertices.back(), next_);
            if (join.verdict == Verdict::Done) join.vertices.push_back(next_);
        }
        if (join.verdict != Verdict::Done) undo();
        return join;
    }

  private:
    // Finds or makes the next vertex, a neighbour of `current`, and stores it in `next_`.
    Verdict find_next(VertexId current)
    {
        // The loop ends, as each further round has one vertex less.
        for (;;) {
            next_ = end_;
            if (surgery_.has_edge(current, end_)) return Verdict::Done;
            const RingHit hit = first_hit(surgery_, current, surgery_.material(end_));
            if (hit.p == kNoVertex) return Verdict::Border;
            if (hit.q == kNoVertex) return take(hit.p);
            if (snap_end(current, hit, kCrowded)) return Verdict::Done;
            if (surgery_.apex(hit.q, hit.p) == end_ && flip(hit)) return Verdict::Done;
            const Verdict crossed = cross(current, hit);
            if (crossed != Verdict::Quality) return crossed;
            // A vertex is near both the line and a vertex of the line. Move it onto the line nevertheless
            // (clean-up merges the short trace edge), or merge it into the vertex of the line.
            if (snap_end(current, hit, 0.0)) return Verdict::Done;
            if (!absorb_end(current, hit)) return crossed;
        }
    }

    bool absorb_end(VertexId current, const RingHit& hit)
    {
        for (const VertexId v : {hit.p, hit.q}) {
            const Vec2 X = surgery_.material(v);
            const double apart = (X - surgery_.material(current)).norm();
            if (surgery_.role(v) != TraceRole::Free || !(apart <= kCrowded * target_.length(X))) continue;
            const SurgeryProposal proposal = surgery_.propose_collapse(v, current);
            if (!proposal.is_legal()) continue;
            if (least_angle(proposal.event.after) < std::min(kSnapAngle, least_angle(proposal.event.before)))
                continue;
            if (surgery_.commit(proposal) == Verdict::Done) return true;
        }
        return false;
    }

    // Uses a vertex that is exactly on the line.
    Verdict take(VertexId v)
    {
        if (surgery_.role(v) != TraceRole::Free && surgery_.tag(v) != tag_) return Verdict::Trace;
        if (surgery_.is_fixed(v)) return Verdict::Fixed;
        if (surgery_.is_border(v)) return Verdict::Border;
        next_ = v;
        return Verdict::Done;
    }

    // Moves an end of the crossed edge onto the line, the nearer one if possible. It must then be at least
    // `clearance` target lengths from `current` and from the end of the line.
    bool snap_end(VertexId current, const RingHit& hit, double clearance)
    {
        const Line line{surgery_.material(current), surgery_.material(end_)};
        std::array<VertexId, 2> ends = {hit.p, hit.q};
        if (line.off(surgery_.material(ends[1])) < line.off(surgery_.material(ends[0])))
            std::swap(ends[0], ends[1]);
        for (const VertexId v : ends) {
            const Vec2 X = surgery_.material(v);
            const double reach = kCrowded * target_.length(X);
            const double along = line.along(X) * line.length();
            const double apart = clearance * target_.length(X);
            const bool is_clear = along > apart && line.length() - along > apart;
            if (line.off(X) > reach || !is_clear || surgery_.is_border(v)) continue;
            if (snap(surgery_, v, line.foot(X)) != Verdict::Done) continue;
            next_ = v;
            return true;
        }
        return false;
    }

    bool flip(const RingHit& hit)
    {
        const SurgeryProposal proposal = surgery_.propose_flip(hit.p, hit.q);
        if (!proposal.is_legal()) return false;
        if (least_angle(proposal.event.after) < std::min(kSnapAngle, least_angle(proposal.event.before)))
            return false;
        next_ = end_;
        return surgery_.commit(proposal) == Verdict::Done;
    }

    Verdict cross(VertexId current, const RingHit& hit)
    {
        const int tag = surgery_.edge_tag(hit.p, hit.q);
        if (tag != kNoTag) return Verdict::Trace;
        const Vec2 from = surgery_.material(current);
        const Vec2 to = surgery_.material(end_);
        const double right = -twice_area(from, to, surgery_.material(hit.p));
        const double left = twice_area(from, to, surgery_.material(hit.q));
        const Verdict verdict =
            split(surgery_, hit.p, hit.q, right / (right + left), {TraceRole::OnTrace, tag_}, next_);
        if (verdict == Verdict::Done) added_.push_back(next_);
        return verdict;
    }

    Verdict connect(VertexId current, VertexId next)
    {
        const int tag = surgery_.edge_tag(current, next);
        if (tag == tag_) return Verdict::Done;
        if (tag != kNoTag) return Verdict::Trace;
        if (surgery_.role(next) == TraceRole::Free) {
            surgery_.set_role(next, TraceRole::OnTrace, tag_);
            added_.push_back(next);
        }
        surgery_.set_edge_tag(current, next, tag_);
        tagged_.push_back({current, next});
        return Verdict::Done;
    }

    void undo()
    {
        // Only what this walk made is removed; the ends keep their role.
        for (const auto& [a, b] : tagged_) {
            surgery_.set_edge_tag(a, b, kNoTag);
            surgery_.touch(a);
            surgery_.touch(b);
        }
        for (const VertexId v : added_) surgery_.release_vertex(v);
    }

    ClothSurgery& surgery_;
    const MeshTarget& target_;
    VertexId end_;
    int tag_;
    VertexId next_ = kNoVertex;
    std::vector<VertexId> added_;
    std::vector<std::array<VertexId, 2>> tagged_;
};

}  // namespace

TraceInsertion insert_edge_crossing(ClothSurgery& surgery, const MeshTarget& target, VertexId a, VertexId b,
                                    double s, const TraceVertex& made)
{
    if (!surgery.has_edge(a, b)) return {Verdict::Missing, kNoVertex};
    if (!(s >= 0.0 && s <= 1.0)) return {Verdict::Argument, kNoVertex};
    const Vec2 X = surgery.material(a) + s * (surgery.material(b) - surgery.material(a));
    const double reach = kCrowded * target.length(X);
    std::array<VertexId, 2> ends = {a, b};
    if (s > 0.5) std::swap(ends[0], ends[1]);
    for (const VertexId v : ends) {
        if (!((surgery.material(v) - X).norm() <= reach)) continue;
        if (is_like(surgery, v, made)) return {Verdict::Done, v};
        if (surgery.role(v) != TraceRole::Free) continue;
        if (!is_at(surgery, target, v, X)) {
            if (surgery.is_border(v) && !surgery.is_border_edge(a, b)) continue;
            const Verdict snapped = snap(surgery, v, X);
            if (snapped == Verdict::Guard && !may_stay(surgery, target, v, X, made.way))
                return {snapped, kNoVertex};
            if (snapped != Verdict::Done) continue;
        } else if (surgery.is_fixed(v)) {
            return {Verdict::Fixed, kNoVertex};
        }
        surgery.set_role(v, made.role, made.tag);
        surgery.touch(v);
        return {Verdict::Done, v};
    }
    TraceInsertion insertion;
    insertion.verdict = split(surgery, a, b, s, made, insertion.vertex);
    return insertion;
}

TraceInsertion insert_face_point(ClothSurgery& surgery, const MeshTarget& target, const IdFace& face,
                                 const Vec3& weights, const TraceVertex& made)
{
    if (surgery.apex(face[0], face[1]) != face[2]) return {Verdict::Missing, kNoVertex};
    if (!(weights.minCoeff() >= 0.0 && std::isfinite(weights.sum()) && weights.sum() > 0.0))
        return {Verdict::Argument, kNoVertex};
    const auto corners = surgery.patch_face(face).material;
    const Vec2 X =
        (weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2]) / weights.sum();
    std::array<int, 3> order = {0, 1, 2};
    std::sort(order.begin(), order.end(), [&](int i, int j) {
        return std::pair((corners[i] - X).norm(), face[i]) < std::pair((corners[j] - X).norm(), face[j]);
    });
    for (const int k : order) {
        const VertexId v = face[k];
        if (!((corners[k] - X).norm() <= kCrowded * target.length(X))) break;
        if (is_like(surgery, v, made)) return {Verdict::Done, v};
        if (surgery.is_border(v)) continue;
        const Verdict snapped = snap(surgery, v, X);
        if (snapped == Verdict::Guard && !may_stay(surgery, target, v, X, made.way))
            return {snapped, kNoVertex};
        if (snapped != Verdict::Done) continue;
        surgery.set_role(v, made.role, made.tag);
        return {Verdict::Done, v};
    }
    const SurgeryProposal proposal = surgery.propose_face_split(face, weights, made.role, made.tag);
    if (const Verdict verdict = surgery.commit(proposal); verdict != Verdict::Done)
        return {verdict, kNoVertex};
    // The face between the point and the edge opposite the least weight is the thinnest.
    int thin = 0;
    weights.minCoeff(&thin);
    const VertexId vertex = proposal.event.changes[0].vertex;
    flip_away(surgery, face[(thin + 1) % 3], face[(thin + 2) % 3], vertex, made.tag);
    return {Verdict::Done, vertex};
}

TraceInsertion insert_trace_point(ClothSurgery& surgery, const MeshTarget& target, const Vec2& material,
                                  VertexId near, const TraceVertex& made)
{
    const auto found = locate(surgery, material, near);
    if (!found) return {Verdict::Missing, kNoVertex};
    const auto& [face, weights] = *found;
    int least = 0;
    weights.minCoeff(&least);
    const VertexId a = face[(least + 1) % 3];
    const VertexId b = face[(least + 2) % 3];
    const Line edge{surgery.material(a), surgery.material(b)};
    if (edge.off(material) > kMaterialTolerance * target.length(material))
        return insert_face_point(surgery, target, face, weights, made);
    return insert_edge_crossing(surgery, target, a, b, std::clamp(edge.along(material), 0.0, 1.0), made);
}

TraceJoin join_trace_vertices(ClothSurgery& surgery, const MeshTarget& target, VertexId a, VertexId b,
                              int tag)
{
    if (!surgery.has_vertex(a) || !surgery.has_vertex(b)) return {Verdict::Missing, {}};
    if (a == b || surgery.role(a) == TraceRole::Free || surgery.role(b) == TraceRole::Free)
        return {Verdict::Argument, {}};
    return TraceWalk(surgery, target, b, tag).run(a);
}

}  // namespace arris
