// SPDX-License-Identifier: GPL-3.0-or-later
//
//        ahead                    A face turns over when a moving corner comes to the line of the other two.
//   *-----*-----*  trace          Such a face is threatened. It is saved by merging the vertex in the way
//    \   / \   /    |             into the trace or into one farther away, or by flipping the edge across
//     \ /   \ /     v             the way. Where two vertices of the trace approach each other, as at a
//      p-----q                    corner that slides along its edge, one is merged into the other.
//
// Clearing ends, as (vertices, threatened faces) decreases strictly in lexicographic order. A merge removes a
// vertex, and a flip is made only if it leaves fewer threatened faces.
#include "geometry/surgery/trace_clearing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "geometry/cloth/mesh_limits.h"
#include "geometry/from_least.h"
#include "geometry/surgery/material_walk.h"
#include "geometry/surgery/vertex_table.h"
#include "geometry/tolerances.h"

namespace arris {
namespace {

constexpr double kSoundAngle = 3.0;  // degrees: operations that leave no thinner face are preferred
constexpr double kLeastAngle = 0.1;  // degrees: below this, rounding decides the orientation of a face
constexpr int kInstants = 4;         // of the way, at which faces are tested; corners move on straight lines
constexpr int kMostStages = 100;

/// Ways, with fast look-up: they are looked up for the three corners of every face.
class WayTable {
  public:
    explicit WayTable(const TraceWays& ways) : places_(ways.size())
    {
        ways_.reserve(ways.size());
        for (const auto& [v, way] : ways) {
            places_.add(v, static_cast<std::uint32_t>(ways_.size()));
            ways_.push_back(way);
        }
    }

    bool contains(VertexId v) const { return places_.find(v) != VertexTable::kNone; }
    /// The way of a vertex; zero if it has none.
    Vec2 of(VertexId v) const
    {
        const std::uint32_t at = places_.find(v);
        return at != VertexTable::kNone ? ways_[at] : Vec2(Vec2::Zero());
    }

  private:
    VertexTable places_;
    std::vector<Vec2> ways_;
};

std::array<Vec2, 3> ways_of(const PatchFace& face, const WayTable& ways)
{
    return {ways.of(face.vertices[0]), ways.of(face.vertices[1]), ways.of(face.vertices[2])};
}

std::array<Vec2, 3> ways_of(const PatchFace& face, const TraceWays& ways)
{
    std::array<Vec2, 3> way;
    for (int k = 0; k < 3; ++k) {
        const auto at = ways.find(face.vertices[k]);
        way[k] = at != ways.end() ? at->second : Vec2(Vec2::Zero());
    }
    return way;
}

// The least doubled area of a face on the way, m^2.
double least_area(const PatchFace& face, const std::array<Vec2, 3>& way)
{
    double least = std::numeric_limits<double>::infinity();
    for (int i = 1; i <= kInstants; ++i) {
        std::array<Vec2, 3> X = face.material;
        for (int k = 0; k < 3; ++k) X[k] += double(i) / kInstants * way[k];
        least = std::min(least, twice_area(X[0], X[1], X[2]));
    }
    return least;
}

// The least doubled area on the way, over the square of the longest side: how far the face is from turning
// over.
double soundness(const PatchFace& face, const WayTable& ways)
{
    double side = 0.0;
    for (int k = 0; k < 3; ++k) side = std::max(side, (face.material[(k + 1) % 3] - face.material[k]).norm());
    return least_area(face, ways_of(face, ways)) / (side * side);
}

// False only if the doubled area, (b + t db) x (c + t dc), is certainly above zero at every t in [0, 1].
bool is_at_risk(const PatchFace& face, const WayTable& ways)
{
    constexpr double kRounding = 1e-6;  // relative to the squares of the sides; far above that of the area
    const auto cross = [](const Vec2& p, const Vec2& q) { return p.x() * q.y() - p.y() * q.x(); };
    const std::array<Vec2, 3> way = ways_of(face, ways);
    const Vec2 b = face.material[1] - face.material[0], c = face.material[2] - face.material[0];
    const Vec2 db = way[1] - way[0], dc = way[2] - way[0];
    const double slope = cross(b, dc) + cross(db, c), curvature = cross(db, dc);
    const double least = cross(b, c) + std::min(0.0, slope) + std::min(0.0, curvature);
    const double squares = b.squaredNorm() + c.squaredNorm() + db.squaredNorm() + dc.squaredNorm();
    return !(least > kRounding * squares);
}

// Collects moving vertices with a face that may turn over at some share of their ways. Around other vertices
// there is nothing to clear.
class RiskWatch {
  public:
    RiskWatch(const ClothSurgery& surgery, const TraceWays& ahead, const TraceWays& room)
        : surgery_(surgery), ways_{WayTable(ahead), WayTable(room)}, events_(surgery.events().size())
    {
        for (const auto& [v, way] : ahead)
            for (const IdFace& face : surgery.faces_at(v))
                if (is_at_risk(surgery.patch_face(face))) watched_.insert(v);
    }

    // Adds the vertices of faces that operations have made since the last call.
    void follow()
    {
        for (; events_ < surgery_.events().size(); ++events_)
            for (const PatchFace& face : surgery_.events()[events_].after) {
                if (!is_at_risk(face)) continue;
                for (const VertexId v : face.vertices)
                    if (ways_[0].contains(v)) watched_.insert(v);
            }
    }

    // The collected vertices that still exist, ascending.
    std::vector<VertexId> vertices() const
    {
        std::vector<VertexId> left;
        for (const VertexId v : watched_)
            if (surgery_.has_vertex(v)) left.push_back(v);
        return left;
    }

  private:
    bool is_at_risk(const PatchFace& face) const
    {
        return arris::is_at_risk(face, ways_[0]) || arris::is_at_risk(face, ways_[1]);
    }

    const ClothSurgery& surgery_;
    std::array<WayTable, 2> ways_;  // the ways to be cleared, and the ways with room
    std::size_t events_;            // number of events followed
    std::set<VertexId> watched_;
};

enum class Need {
    Way,  ///< the way itself: where trace vertices come upon each other, some are merged
    Room  ///< room ahead of a short way: none between traces, which do not come that near
};

class Clearing {
  public:
    Clearing(ClothSurgery& surgery, const TraceWays& ahead, Need need)
        : surgery_(surgery), ahead_(ahead), need_(need)
    {
    }

    /// Clears around `vertices`; returns the number of operations.
    int run(const std::vector<VertexId>& vertices)
    {
        int operations = 0;
        std::set<IdFace> queue;
        const auto add = [&](const PatchFace& face) {
            if (turns_over(face)) queue.insert(from_least(face.vertices));
        };
        for (const VertexId v : vertices)
            for (const IdFace& face : surgery_.faces_at(v)) add(surgery_.patch_face(face));
        while (!queue.empty()) {
            const IdFace face = *queue.begin();
            queue.erase(queue.begin());
            if (surgery_.apex(face[0], face[1]) != face[2] || !is_threatened(surgery_.patch_face(face)))
                continue;
            if (!save(face)) continue;
            ++operations;
            for (const PatchFace& made : surgery_.events().back().after) add(made);
        }
        return operations;
    }

  private:
    bool is_moving(VertexId v) const { return ahead_.contains(v); }

    double soundness(const PatchFace& face) const { return arris::soundness(face, ahead_); }
    bool is_threatened(const PatchFace& face) const
    {
        return !(need_ == Need::Room && is_between_traces(face)) && turns_over(face);
    }
    bool turns_over(const PatchFace& face) const { return !(least_area(face, ways_of(face, ahead_)) > 0.0); }

    bool is_between_traces(const PatchFace& face) const
    {
        for (int k = 0; k < 3; ++k) {
            const VertexId a = face.vertices[k], b = face.vertices[(k + 1) % 3];
            if (is_moving(a) && is_moving(b) && surgery_.edge_tag(a, b) == kNoTag) return true;
        }
        return false;
    }

    struct Candidate {
        int change;  // change in the number of threatened faces
        double soundness;
        bool is_into_trace;
        bool is_of_trace;  // the vertex to be removed is a moving one
        bool is_thin;      // the operation leaves thin faces
        SurgeryProposal proposal;

        // 0: fewer threatened faces. 1: as many, with the vertex in the way merged into the trace. 2: fewer,
        // at the cost of a trace vertex. 3: another merge, at best an intermediate step.
        int rank() const
        {
            if (is_of_trace) return 2;
            return change < 0 ? 0 : (change == 0 && is_into_trace ? 1 : 3);
        }
    };

    Candidate judge(SurgeryProposal proposal, bool is_thin) const
    {
        const bool is_merge = proposal.event.operation == SurgeryOperation::Collapse;
        Candidate candidate{0,
                            std::numeric_limits<double>::infinity(),
                            is_merge && is_moving(proposal.event.edge[1]),
                            is_merge && is_moving(proposal.event.edge[0]),
                            is_thin,
                            {}};
        for (const PatchFace& face : proposal.event.after) {
            candidate.change += is_threatened(face) ? 1 : 0;
            candidate.soundness = std::min(candidate.soundness, soundness(face));
        }
        for (const PatchFace& face : proposal.event.before) candidate.change -= is_threatened(face) ? 1 : 0;
        candidate.proposal = std::move(proposal);
        return candidate;
    }

    void consider(SurgeryProposal proposal, std::vector<Candidate>& candidates) const
    {
        if (!proposal.is_legal()) return;
        const double before = least_angle(proposal.event.before);
        const double after = least_angle(proposal.event.after);
        if (after < std::min(kLeastAngle, before)) return;
        const bool is_merge = proposal.event.operation == SurgeryOperation::Collapse;
        Candidate candidate = judge(std::move(proposal), after < std::min(kSoundAngle, before));
        if (candidate.is_of_trace && need_ == Need::Room) return;
        if (candidate.change < 0 || (is_merge && !candidate.is_of_trace))
            candidates.push_back(std::move(candidate));
    }

    // Best first: least rank, then no thin faces left, then fewest threatened faces, then greatest soundness.
    // The sort is stable, so ties keep the order in which candidates were found.
    static bool is_better(const Candidate& c, const Candidate& d)
    {
        const auto key = [](const Candidate& e) {
            return std::tuple(e.rank(), e.is_thin, e.change, -e.soundness);
        };
        return key(c) < key(d);
    }

    bool save(const IdFace& face)
    {
        std::vector<Candidate> candidates;
        for (int k = 0; k < 3; ++k) {
            consider(surgery_.propose_flip(face[k], face[(k + 1) % 3]), candidates);
            for (const VertexId w : surgery_.ring(face[k]).vertices)
                if (!is_moving(face[k]) || surgery_.edge_tag(face[k], w) != kNoTag)
                    consider(surgery_.propose_collapse(face[k], w), candidates);
        }
        std::stable_sort(candidates.begin(), candidates.end(), is_better);
        for (const Candidate& candidate : candidates)
            if (surgery_.commit(candidate.proposal) == Verdict::Done) return true;
        return false;
    }

    ClothSurgery& surgery_;
    const WayTable ahead_;
    const Need need_;
};

// The way lengthened by `times`, halved as often as needed to stay on the cloth; never shortened.
Vec2 find_room(const ClothSurgery& surgery, VertexId v, const Vec2& way, double times)
{
    while (times > 1.0 && leads_off(surgery, v, times * way)) times *= 0.5;
    return std::max(times, 1.0) * way;
}

std::vector<VertexId> find_blocked(const ClothSurgery& surgery, const TraceWays& ahead,
                                   const std::vector<VertexId>& vertices)
{
    std::vector<VertexId> blocked;
    for (const VertexId v : vertices) {
        const std::vector<IdFace> faces = surgery.faces_at(v);
        if (std::any_of(faces.begin(), faces.end(),
                        [&](const IdFace& face) { return turns_over(surgery.patch_face(face), ahead); }))
            blocked.push_back(v);
    }
    return blocked;
}

}  // namespace

bool turns_over(const PatchFace& face, const TraceWays& ways)
{
    return !(least_area(face, ways_of(face, ways)) > 0.0);
}

// Clears in stages of at most kCrowded target lengths, so that the nearest vertices are merged first. The
// vertices of one cell after the other can be merged into the trace, but not those behind others. Then
// shorter ways are cleared up to kCrowded target lengths: room ahead, which another trace may also take.
ClearanceReport clear_ahead(ClothSurgery& surgery, const MeshTarget& target,
                            const std::vector<TraceShift>& shifts)
{
    TraceWays ahead;
    for (const TraceShift& shift : shifts) {
        const bool is_cut = shift.least < 1.0 && leads_off(surgery, shift.vertex, shift.ahead);
        ahead[shift.vertex] = (is_cut ? shift.least : 1.0) * shift.ahead;
    }
    double stages = 1.0;
    TraceWays room;
    for (auto at = ahead.begin(); at != ahead.end();) {
        const auto& [v, way] = *at;
        const double length = way.norm();
        const double least = kCrowded * target.length(surgery.material(v));
        if (length > kComputed * least) room[v] = find_room(surgery, v, way, least / length);
        stages = std::max(stages, std::ceil(length / least));
        at = length > 0.0 ? std::next(at) : ahead.erase(at);
    }
    const int count = static_cast<int>(std::min(stages, double(kMostStages)));
    ClearanceReport report;
    RiskWatch watch(surgery, ahead, room);
    const auto clear_part = [&](const TraceWays& part, Need need) {
        report.operations += Clearing(surgery, part, need).run(watch.vertices());
        watch.follow();
    };
    for (int k = 1; k <= count; ++k) {
        TraceWays part = ahead;
        for (auto& [v, way] : part) way *= double(k) / count;
        clear_part(part, Need::Way);
    }
    clear_part(room, Need::Room);
    TraceWays least = ahead;
    for (const TraceShift& shift : shifts)
        if (const auto at = least.find(shift.vertex); at != least.end())
            at->second = shift.least * shift.ahead;
    report.blocked = find_blocked(surgery, least, watch.vertices());
    report.ways = std::move(room);
    report.needed = std::move(ahead);
    return report;
}

}  // namespace arris
