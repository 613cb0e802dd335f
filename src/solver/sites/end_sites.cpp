// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/sites/end_sites.h"

#include <algorithm>
#include <set>

#include "geometry/obstacle/feature_nodes.h"
#include "geometry/obstacle/feature_path.h"

namespace arris {

namespace {

/// The trace past one end of a wire.
class TracePastEnd {
  public:
    /// `end`: index in the obstacle's mesh.
    TracePastEnd(const EdgeCrossings& crossings, int feature, int end)
        : crossings_(crossings), state_(crossings.state()), feature_(feature), end_(end)
    {
    }

    /// Adds the sites on it, if it leads to the cloth's border.
    void add_to(std::vector<FeatureSite>& sites) const
    {
        std::vector<FeatureSite> found;
        bool leads_to_border = false;
        std::set<int> seen;
        std::vector<int> open = find_places(sites, leads_to_border);
        const auto look_at = [&](int a, int b) {
            const Vec3 from = way_across(crossings_.obstacle(), feature_, crossings_.positions()[a]);
            const auto site = crossings_.find_past_end(a, b, feature_, from.stableNormalized());
            if (!site || !is_past(crossings_.place_of(*site))) return;
            const auto is_same = [&](const FeatureSite& other) { return other.edge == site->edge; };
            if (std::any_of(found.begin(), found.end(), is_same)) return;
            found.push_back(*site);
            open.insert(open.end(), site->edge.begin(), site->edge.end());
            leads_to_border = leads_to_border || site->is_on_border;
        };
        while (!open.empty()) {
            const int v = open.back();
            open.pop_back();
            if (!seen.insert(v).second) continue;
            for (const int f : crossings_.stars().faces[v]) {
                const Face& face = state_.mesh.faces[f];
                for (int k = 0; k < 3; ++k) look_at(face[k], face[(k + 1) % 3]);
            }
        }
        if (!leads_to_border) return;
        for (const FeatureSite& site : found)
            if (std::none_of(sites.begin(), sites.end(),
                             [&](const FeatureSite& other) { return other.edge == site.edge; }))
                sites.push_back(site);
    }

  private:
    bool is_past(const Vec3& place) const
    {
        return end_passed(crossings_.obstacle(), feature_, place) == end_;
    }

    /// Vertices of the cloth at sites and EOL vertices on the wire's edge. Notes whether one of these is on
    /// the border past the end.
    std::vector<int> find_places(const std::vector<FeatureSite>& sites, bool& leads_to_border) const
    {
        std::vector<int> vertices;
        for (const FeatureSite& site : sites)
            if (site.edge[0] >= 0) vertices.insert(vertices.end(), site.edge.begin(), site.edge.end());
        for (const EolVertex& eol : state_.eol) {
            if (eol.on.is_corner() || eol.on.obstacle != crossings_.obstacle_index() ||
                eol.on.index != feature_)
                continue;
            const int v = state_.index_of(eol.vertex_id);
            vertices.push_back(v);
            leads_to_border =
                leads_to_border || (crossings_.stars().is_on_border(v) && is_past(crossings_.positions()[v]));
        }
        return vertices;
    }

    const EdgeCrossings& crossings_;
    const State& state_;
    int feature_;
    int end_;
};

}  // namespace

void continue_past_ends(const EdgeCrossings& crossings, int feature, std::vector<FeatureSite>& sites)
{
    const Obstacle& obstacle = crossings.obstacle();
    if (obstacle.features().edges[feature].kind != FeatureKind::Wire) return;
    for (const int end : {0, 1}) {
        const int point = point_at(obstacle, {feature, end});
        if (!is_corner(obstacle.features(), point)) continue;
        TracePastEnd(crossings, feature, point).add_to(sites);
    }
}

void drop_ends_passed(const EdgeCrossings& crossings, std::vector<FeatureSite>& sites)
{
    const Obstacle& obstacle = crossings.obstacle();
    const State& state = crossings.state();
    const auto is_here = [&](const FeatureId& on) {
        return on.obstacle == crossings.obstacle_index() && !on.is_corner();
    };
    std::set<int> passed;
    for (const FeatureSite& site : sites)
        if (is_here(site.on) && site.edge[0] >= 0)
            passed.insert(end_passed(obstacle, site.on.index, crossings.place_of(site)));
    for (const EolVertex& eol : state.eol)
        if (is_here(eol.on))
            passed.insert(
                end_passed(obstacle, eol.on.index, crossings.positions()[state.index_of(eol.vertex_id)]));
    std::erase_if(sites, [&](const FeatureSite& site) {
        return site.on.obstacle == crossings.obstacle_index() && site.on.is_corner() &&
               passed.contains(obstacle.features().corners[site.on.index].point);
    });
}

}  // namespace arris
