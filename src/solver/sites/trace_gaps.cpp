// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/sites/trace_gaps.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "geometry/obstacle/feature_frame.h"
#include "geometry/obstacle/feature_path.h"
#include "geometry/obstacle/normal_cone.h"

namespace arris {

namespace {

Vec3 outward_of(const Obstacle& obstacle, int feature)
{
    const Vec3 begin = feature_segment(obstacle, feature)[0];
    return find_edge_frame(obstacle, feature, begin, {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()})->outward;
}

class GapFilling {
  public:
    GapFilling(const EdgeCrossings& crossings, int feature)
        : crossings_(crossings),
          state_(crossings.state()),
          feature_(feature),
          outward_(outward_of(crossings.obstacle(), feature))
    {
    }

    void fill(std::vector<FeatureSite>& sites) const
    {
        TraceGraph trace;
        std::vector<Crossing> open = begin_trace(sites, trace);
        while (!open.empty()) {
            const Crossing at = open.back();
            open.pop_back();
            for (const auto& [next, site] : crossings_beside(at)) {
                const auto [node, is_new] = trace.try_emplace(next, TraceNode{site, false, {}});
                if (is_new) open.push_back(next);
                node->second.beside.insert(at);
                trace.at(at).beside.insert(next);
            }
        }
        cut_loose_ends(trace);
        for (const auto& [at, node] : trace)
            if (!node.is_known) sites.push_back(*node.site);
    }

  private:
    using Crossing = std::array<int, 2>;  ///< a FeatureSite's edge
    struct TraceNode {
        std::optional<FeatureSite> site;  ///< none at an EOL vertex
        bool is_known;                    ///< a site that presses, or an EOL vertex
        std::set<Crossing> beside;
    };
    using TraceGraph = std::map<Crossing, TraceNode>;

    bool is_on_feature(int v) const
    {
        const int entry = state_.eol_entry(state_.ids[v]);
        return entry >= 0 && !state_.eol[entry].on.is_corner() &&
               state_.eol[entry].on.obstacle == crossings_.obstacle_index() &&
               state_.eol[entry].on.index == feature_;
    }

    /// Puts known sites and EOL vertices into `trace`; returns those from which the trace may continue.
    std::vector<Crossing> begin_trace(const std::vector<FeatureSite>& sites, TraceGraph& trace) const
    {
        std::vector<Crossing> open;
        for (const FeatureSite& site : sites)
            if (trace.try_emplace(site.edge, TraceNode{site, true, {}}).second) open.push_back(site.edge);
        for (const EolVertex& eol : state_.eol) {
            const int v = state_.index_of(eol.vertex_id);
            if (!is_on_feature(v)) continue;
            trace[{v, v}] = {std::nullopt, true, {}};
            const std::vector<int> beside = crossings_.neighbours(v);
            const auto joined =
                std::count_if(beside.begin(), beside.end(), [&](int w) { return is_on_feature(w); });
            if (joined < 2) open.push_back({v, v});
        }
        return open;
    }

    /// Crossings of the feature's plane with the edges of the faces around a crossing.
    std::map<Crossing, std::optional<FeatureSite>> crossings_beside(const Crossing& at) const
    {
        std::map<Crossing, std::optional<FeatureSite>> found;
        for (const int f : crossings_.stars().faces[at[0]]) {
            const Face& face = state_.mesh.faces[f];
            if (std::find(face.begin(), face.end(), at[1]) == face.end()) continue;
            for (int k = 0; k < 3; ++k) {
                const int a = face[k], b = face[(k + 1) % 3];
                if (is_on_feature(a))
                    found[{a, a}] = std::nullopt;
                else if (is_on_feature(b))
                    found[{b, b}] = std::nullopt;
                else if (const auto site = crossings_.find(a, b, feature_, outward_))
                    found[site->edge] = site;
            }
        }
        found.erase(at);
        return found;
    }

    /// Removes crossings that do not lie between two others. An end on the cloth's border stays if it is
    /// beside a known place.
    static void cut_loose_ends(TraceGraph& trace)
    {
        const auto is_loose = [&](const TraceNode& node) {
            if (node.is_known || node.beside.size() > 1) return false;
            const bool is_end =
                !node.beside.empty() && node.site->is_on_border && trace.at(*node.beside.begin()).is_known;
            return !is_end;
        };
        for (bool is_changed = true; is_changed;) {
            is_changed = false;
            for (auto at = trace.begin(); at != trace.end();) {
                if (!is_loose(at->second)) {
                    ++at;
                    continue;
                }
                for (const Crossing& next : at->second.beside) trace.at(next).beside.erase(at->first);
                at = trace.erase(at);
                is_changed = true;
            }
        }
    }

    const EdgeCrossings& crossings_;
    const State& state_;
    int feature_;
    Vec3 outward_;
};

}  // namespace

void fill_trace_gaps(const EdgeCrossings& crossings, int feature, std::vector<FeatureSite>& sites)
{
    if (crossings.obstacle().features().edges[feature].kind != FeatureKind::Convex) return;
    GapFilling(crossings, feature).fill(sites);
}

}  // namespace arris
