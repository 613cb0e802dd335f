// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/geometry/trace_motion.h"

#include <cmath>
#include <map>

#include "geometry/surgery/surgery_cleanup.h"
#include "geometry/surgery/trace_clearing.h"

namespace arris {
namespace {

constexpr double kClear = 0.3;  // cleared distance over the target length
constexpr int kMostSubsteps = 100000;

class TraceMotion {
  public:
    TraceMotion(ClothSurgery& surgery, const MeshTarget& target, const std::vector<VertexMove>& moves)
        : surgery_(surgery), target_(target)
    {
        for (const VertexMove& move : moves)
            rest_[move.vertex] = {move.material - surgery.material(move.vertex), move.keeps_world};
    }

    TraceMotionReport run()
    {
        TraceMotionReport report;
        const int count = substep_count();
        for (int k = 0; k < count && report.verdict == Verdict::Done; ++k) {
            const double share = 1.0 / (count - k);
            const std::size_t events = surgery_.events().size();
            std::vector<TraceShift> ahead;
            for (const auto& [v, way] : rest_) ahead.push_back({v, share * way.vector});
            report.blocked = clear_ahead(surgery_, target_, ahead).blocked;
            follow(events);
            report.verdict = take_step(share);
            if (report.verdict != Verdict::Done) break;
            const std::size_t cleared = surgery_.events().size();
            clean_up(surgery_, target_);
            follow(cleared);
            ++report.substeps;
            report.fraction = double(report.substeps) / count;
        }
        if (report.verdict == Verdict::Done) report.blocked.clear();
        return report;
    }

  private:
    struct Way {
        Vec2 vector;
        bool keeps_world;
    };

    int substep_count() const
    {
        double most = 1.0;
        for (const auto& [v, way] : rest_)
            most = std::max(most, way.vector.norm() / (kClear * target_.length(surgery_.material(v))));
        return static_cast<int>(std::min(std::ceil(most), double(kMostSubsteps)));
    }

    Verdict take_step(double share)
    {
        std::vector<VertexMove> moves;
        for (auto& [v, way] : rest_)
            moves.push_back({v, surgery_.material(v) + share * way.vector, way.keeps_world});
        const Verdict verdict = surgery_.commit(surgery_.propose_moves(moves));
        if (verdict != Verdict::Done) return verdict;
        for (auto& [v, way] : rest_) way.vector *= 1.0 - share;
        return Verdict::Done;
    }

    // Drops removed vertices and adds new ones on the trace.
    void follow(std::size_t first_event)
    {
        for (std::size_t k = first_event; k < surgery_.events().size(); ++k) {
            const SurgeryEvent& event = surgery_.events()[k];
            if (event.operation == SurgeryOperation::Collapse) rest_.erase(event.edge[0]);
            if (event.operation != SurgeryOperation::SplitEdge || event.role == TraceRole::Free) continue;
            const double s = event.changes[0].weights[1];
            Way way{Vec2::Zero(), true};
            for (const auto& [v, weight] : {std::pair(event.edge[0], 1.0 - s), std::pair(event.edge[1], s)}) {
                const auto at = rest_.find(v);
                if (at == rest_.end()) continue;
                way.vector += weight * at->second.vector;
                way.keeps_world = way.keeps_world && at->second.keeps_world;
            }
            rest_[event.changes[0].vertex] = way;
        }
    }

    ClothSurgery& surgery_;
    const MeshTarget& target_;
    std::map<VertexId, Way> rest_;  // remaining way
};

}  // namespace

TraceMotionReport move_trace(ClothSurgery& surgery, const MeshTarget& target,
                             const std::vector<VertexMove>& moves)
{
    for (const VertexMove& move : moves) {
        if (!surgery.has_vertex(move.vertex)) return {Verdict::Missing, 0, 0.0, {}};
        if (!move.material.allFinite()) return {Verdict::Argument, 0, 0.0, {}};
    }
    return TraceMotion(surgery, target, moves).run();
}

}  // namespace arris
