// SPDX-License-Identifier: GPL-3.0-or-later
//
// A fixed sequence of passes over a patch P of vertices. P is chosen at the start; splits add their vertices.
//
//   merge short edges -> flip -> split long edges -> flip (while there are any, at most 8 rounds)
//                     -> open thin faces (at most 3 rounds) -> flip
//
// Termination, whatever the mesh is and whatever the guard refuses:
//   merge   Each success removes a vertex of P: at most |P|. A refused edge is tried again only after a
//           success beside it.
//   flip    Only if the opposite vertex is strictly inside the circumcircle (exact predicate). The surface
//           (X, Y, X^2 + Y^2) over the faces then sinks strictly, so no triangulation of the points recurs,
//           and there are finitely many. That bound is far too large, so flips have a cap, linear in the
//           patch.
//   split   The list of a round is made once, and each edge in it is split at most once. Halves, and edges
//           that flips make of them, may still be long, so there are several rounds. A later clean-up may
//           never come here: none does once the trace that has left the place is gone from the cloth.
//   open    The list of a round is made once; a face costs at most one operation.
// `most_operations` is the sum of these bounds.
//
// A flip is made only if a face has an angle below kFlipAngle. On folded cloth each flip moves the surface,
// so a mesh that is good enough is left unchanged.
#include "geometry/surgery/surgery_cleanup.h"

#include <CGAL/predicates_on_points_2.h>

#include <algorithm>
#include <optional>
#include <set>
#include <tuple>

#include "geometry/cgal.h"
#include "geometry/cloth/mesh_limits.h"
#include "geometry/sort_unique.h"

namespace arris {
namespace {

constexpr double kFlipAngle = 30.0;  // degrees
constexpr double kKeepAngle = 10.0;  // degrees: below this, a merge may not leave thinner faces than before
constexpr int kSplitRounds = 8;      // enough for edges of 500 target lengths
constexpr int kThinRounds = 3;
constexpr int kFlipsPerEdge = 8;
constexpr double kLeastFoot = 0.15;  // of an edge: least distance of a split from its ends

using Edge = std::array<VertexId, 2>;

Edge edge_of(VertexId a, VertexId b)
{
    return {std::min(a, b), std::max(a, b)};
}

class Cleanup {
  public:
    Cleanup(ClothSurgery& surgery, const MeshTarget& target) : surgery_(surgery), target_(target)
    {
        patch_ = surgery_.take_touched();
        for (const VertexId v : std::vector<VertexId>(patch_)) {
            const VertexRing ring = surgery_.ring(v);
            patch_.insert(patch_.end(), ring.vertices.begin(), ring.vertices.end());
        }
        sort_unique(patch_);
        report_.patch_vertices = static_cast<int>(patch_.size());
    }

    CleanupReport run()
    {
        merge_short_edges();
        flip_edges();
        for (int round = 0; round < kSplitRounds && split_long_edges(); ++round) flip_edges();
        for (int round = 0; round < kThinRounds; ++round)
            if (!open_thin_faces()) break;
        flip_edges();
        surgery_.take_touched();
        return report_;
    }

  private:
    // --- the patch

    std::vector<Edge> patch_edges() const
    {
        std::vector<Edge> edges;
        for (const VertexId v : patch_)
            for (const VertexId n : surgery_.ring(v).vertices)
                if (is_first_in_patch(v, n)) edges.push_back(edge_of(v, n));
        return edges;
    }

    // The faces of the patch, each from its least vertex.
    std::vector<IdFace> patch_faces() const
    {
        std::vector<IdFace> faces;
        for (const VertexId v : patch_)
            for (IdFace face : surgery_.faces_at(v)) {
                if (!is_first_in_patch(v, face[1]) || !is_first_in_patch(v, face[2])) continue;
                std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
                faces.push_back(face);
            }
        return faces;
    }

    bool in_patch(VertexId v) const { return std::binary_search(patch_.begin(), patch_.end(), v); }

    // Lists an edge or face with several vertices in the patch only once.
    bool is_first_in_patch(VertexId v, VertexId other) const { return v < other || !in_patch(other); }

    double length(const Edge& e) const { return (surgery_.material(e[1]) - surgery_.material(e[0])).norm(); }

    // Length of an edge in target lengths.
    double relative_length(const Edge& e) const
    {
        return length(e) / target_.length(0.5 * (surgery_.material(e[0]) + surgery_.material(e[1])));
    }

    // A seam's edge is short if both its sides are.
    bool is_short(const Edge& e) const
    {
        const auto is_short_side = [&](const Edge& side) {
            return length(side) < kShortEdge * target_.longest && relative_length(side) < kShortEdge;
        };
        if (!is_short_side(e)) return false;
        const std::optional<Edge> other_side = surgery_.partner(e[0], e[1]);
        return !other_side || is_short_side(*other_side);
    }

    bool is_long(const Edge& e) const
    {
        return length(e) > kLongEdge * target_.shortest && relative_length(e) > kLongEdge;
    }

    bool is_thin(const PatchFace& face, double angle) const
    {
        return angle < target_.most_angle && angle < target_.least_angle(material_centre(face));
    }

    bool commit(const SurgeryProposal& proposal)
    {
        const Verdict verdict = surgery_.commit(proposal);
        const SurgeryEvent& event = proposal.event;
        if (verdict == Verdict::Guard && event.operation == SurgeryOperation::Collapse)
            kept_apart_.insert(edge_of(event.edge[0], event.edge[1]));
        if (verdict != Verdict::Done) return false;
        switch (event.operation) {
            case SurgeryOperation::Collapse:
                ++report_.collapses;
                std::erase_if(patch_, [&](VertexId v) { return !surgery_.has_vertex(v); });
                break;
            case SurgeryOperation::Flip:
                ++report_.flips;
                break;
            default:
                ++report_.splits;
                for (const VertexChange& made : event.changes) patch_.push_back(made.vertex);  // ascend
        }
        return true;
    }

    // --- merging

    bool is_too_long(const SurgeryEvent& event) const
    {
        const double allowed = kLongEdge * target_.length(event.changes[0].new_material);
        return longest_edge(event.after) > std::max(allowed, longest_edge(event.before));
    }

    // Merges an edge into one of its ends, first trying the end that leaves the larger least angle. `accepts`
    // is called with the event and that angle.
    template <typename Accepts>
    bool merge(const Edge& e, const Accepts& accepts)
    {
        std::optional<SurgeryProposal> ways[2];
        double angle[2] = {-1.0, -1.0};
        for (int k = 0; k < 2; ++k) {
            if (!in_patch(e[k])) continue;
            SurgeryProposal proposal = surgery_.propose_collapse(e[k], e[1 - k]);
            if (!proposal.is_legal() || is_too_long(proposal.event)) continue;
            angle[k] = least_angle(proposal.event.after);
            if (accepts(proposal.event, angle[k])) ways[k] = std::move(proposal);
        }
        const int first = angle[1] > angle[0] ? 1 : 0;
        for (const int k : {first, 1 - first})
            if (ways[k] && commit(*ways[k])) return true;
        return false;
    }

    // Merges an edge if that leaves no thinner face than before, or none that is thin. A very short edge
    // makes faces about as thin as itself. Removing them sometimes takes two merges (two vertices beside a
    // corner of the cloth).
    bool merge_short(const Edge& e)
    {
        const double floor = kKeepAngle * std::min(1.0, relative_length(e) / kShortEdge);
        return merge(e, [floor](const SurgeryEvent& event, double angle) {
            return angle >= std::min(floor, least_angle(event.before));
        });
    }

    void merge_short_edges()
    {
        report_.most_operations += static_cast<int>(patch_.size());
        std::set<std::tuple<double, Edge>> queue;
        const auto add = [&](const Edge& e) {
            if (is_short(e)) queue.insert({length(e), e});
        };
        for (const Edge& e : patch_edges()) add(e);
        while (!queue.empty()) {
            const Edge e = std::get<Edge>(*queue.begin());
            queue.erase(queue.begin());
            if (!surgery_.has_edge(e[0], e[1]) || !is_short(e)) continue;
            if (!merge_short(e)) continue;
            const VertexId kept = surgery_.has_vertex(e[0]) ? e[0] : e[1];
            for (const VertexId n : surgery_.ring(kept).vertices)
                if (in_patch(kept) || in_patch(n)) add(edge_of(kept, n));
        }
    }

    // --- flips

    bool is_locally_delaunay(VertexId a, VertexId b, VertexId c, VertexId d) const
    {
        const auto at = [&](VertexId v) { return to_cgal(surgery_.material(v)); };
        return CGAL::side_of_oriented_circle(at(a), at(b), at(c), at(d)) != CGAL::ON_POSITIVE_SIDE;
    }

    bool is_locally_delaunay(const Edge& e) const
    {
        const VertexId c = surgery_.apex(e[0], e[1]);
        const VertexId d = surgery_.apex(e[1], e[0]);
        return c == kNoVertex || d == kNoVertex || is_locally_delaunay(e[0], e[1], c, d);
    }

    bool wants_flip(const Edge& e, SurgeryProposal& proposal) const
    {
        if (!surgery_.has_edge(e[0], e[1]) || is_locally_delaunay(e)) return false;
        proposal = surgery_.propose_flip(e[0], e[1]);
        return proposal.is_legal() && least_angle(proposal.event.before) < kFlipAngle;
    }

    void flip_edges()
    {
        const std::vector<Edge> edges = patch_edges();
        int left = kFlipsPerEdge * static_cast<int>(edges.size());
        report_.most_operations += left;
        // Most edges are locally Delaunay. Only a flip beside such an edge can change this.
        std::set<Edge> queue;
        for (const Edge& e : edges)
            if (!is_locally_delaunay(e)) queue.insert(e);
        SurgeryProposal proposal;
        while (!queue.empty()) {
            const Edge e = *queue.begin();
            queue.erase(queue.begin());
            if (!wants_flip(e, proposal)) continue;
            if (left == 0) return;  // the mesh is valid, perhaps not as good as it could be
            if (!commit(proposal)) continue;
            --left;
            for (const PatchFace& face : proposal.event.after)
                for (int k = 0; k < 3; ++k) {
                    const VertexId a = face.vertices[k];
                    const VertexId b = face.vertices[(k + 1) % 3];
                    if (in_patch(a) || in_patch(b)) queue.insert(edge_of(a, b));
                }
        }
    }

    // --- splits

    bool split_long_edges()
    {
        const int splits = report_.splits;
        std::vector<std::tuple<double, Edge>> edges;
        for (const Edge& e : patch_edges())
            if (is_long(e)) edges.emplace_back(-length(e), e);
        std::sort(edges.begin(), edges.end());
        report_.most_operations += static_cast<int>(edges.size());
        for (const auto& [minus_length, e] : edges)
            if (surgery_.has_edge(e[0], e[1])) commit(surgery_.propose_edge_split(e[0], e[1], 0.5));
        return report_.splits > splits;
    }

    // --- thin faces

    bool open_thin_faces()
    {
        std::vector<std::tuple<double, IdFace>> thin;
        for (const IdFace& face : patch_faces()) {
            const PatchFace patch = surgery_.patch_face(face);
            const double angle = least_angle(patch);
            if (is_thin(patch, angle)) thin.emplace_back(angle, face);
        }
        std::sort(thin.begin(), thin.end());
        report_.most_operations += static_cast<int>(thin.size());
        bool has_opened = false;
        for (const auto& [angle, face] : thin)
            if (surgery_.apex(face[0], face[1]) == face[2] && open(face, angle)) has_opened = true;
        return has_opened;
    }

    bool open(const IdFace& face, double angle)
    {
        std::array<int, 3> by_length = {0, 1, 2};
        const auto side = [&](int k) { return edge_of(face[k], face[(k + 1) % 3]); };
        std::sort(by_length.begin(), by_length.end(), [&](int i, int j) {
            return std::pair(length(side(i)), side(i)) < std::pair(length(side(j)), side(j));
        });
        const Edge longest = side(by_length[2]);
        if (improves(surgery_.propose_flip(longest[0], longest[1]))) return true;
        // A merge may leave no face as thin as the one to be opened.
        const auto opens = [&](const SurgeryEvent&, double after) { return after > angle; };
        for (const int k : by_length)
            if (merge(side(k), opens)) return true;
        // If the guard refuses to merge a side, a split would only make more such sides.
        for (int k = 0; k < 3; ++k)
            if (kept_apart_.contains(side(k))) return false;
        return split_thin(face, by_length[2]);
    }

    bool improves(const SurgeryProposal& proposal)
    {
        return proposal.is_legal() &&
               least_angle(proposal.event.after) > least_angle(proposal.event.before) && commit(proposal);
    }

    // Parameter along face side k of the foot of the opposite corner, clamped.
    double foot(const IdFace& face, int k) const
    {
        const Vec2 a = surgery_.material(face[k]);
        const Vec2 d = surgery_.material(face[(k + 1) % 3]) - a;
        const double s = (surgery_.material(face[(k + 2) % 3]) - a).dot(d) / d.squaredNorm();
        return std::clamp(s, kLeastFoot, 1.0 - kLeastFoot);
    }

    // A split may at most halve an angle. If nothing follows, a thinner face would be worse than the one to
    // be opened.
    static bool is_opening(const SurgeryProposal& proposal)
    {
        return proposal.is_legal() &&
               least_angle(proposal.event.after) >= 0.5 * least_angle(proposal.event.before);
    }

    // A thin face that can be neither flipped nor merged gets a new vertex. Flips and merges of the next
    // round can then open the face. The edge to be split is the one opposite a single trace vertex, the trace
    // edge between two trace vertices, or an edge on no trace between three.
    bool split_thin(const IdFace& face, int longest)
    {
        int traced = 0;
        for (const VertexId v : face) traced += surgery_.role(v) != TraceRole::Free ? 1 : 0;
        for (int i = 0; i < 3; ++i) {
            const int k = (longest + i) % 3;
            const VertexId a = face[k];
            const VertexId b = face[(k + 1) % 3];
            const bool is_traced = surgery_.edge_tag(a, b) != kNoTag;
            const bool is_opposite = surgery_.role(face[(k + 2) % 3]) != TraceRole::Free;
            const bool is_chosen =
                traced == 1 ? is_opposite : (traced == 2 ? is_traced : traced == 3 && !is_traced);
            if (!is_chosen) continue;
            const SurgeryProposal proposal = surgery_.propose_edge_split(a, b, foot(face, k));
            if (is_opening(proposal) && commit(proposal)) return true;
        }
        return false;
    }

    ClothSurgery& surgery_;
    const MeshTarget& target_;
    std::vector<VertexId> patch_;  // ascending
    std::set<Edge> kept_apart_;    // edges that the guard refused to merge
    CleanupReport report_;
};

}  // namespace

CleanupReport clean_up(ClothSurgery& surgery, const MeshTarget& target)
{
    return Cleanup(surgery, target).run();
}

}  // namespace arris
