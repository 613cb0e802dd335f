// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/eol_release.h"

#include <algorithm>

#include "solver/feature_sites.h"

namespace arris {

namespace {

/// Whether the cloth turns at the vertex.
bool is_folded(const State& state, const std::vector<int>& faces)
{
    constexpr double kFlat = 0.9986;  // cosine of 3 degrees: w is lost to less than 5e-4 of what moves there
    std::vector<Vec3> normals;
    Vec3 mean = Vec3::Zero();
    for (const int f : faces) {
        const auto& [a, b, c] = state.mesh.faces[f];
        const std::vector<Vec3>& x = state.mesh.world;
        normals.push_back((x[b] - x[a]).cross(x[c] - x[a]).normalized());
        mean += normals.back();
    }
    mean.normalize();
    return !std::all_of(normals.begin(), normals.end(), [&](const Vec3& n) { return n.dot(mean) > kFlat; });
}

}  // namespace

EolHold find_hold(const Scene& scene, const State& state, const ClothStars& stars, int entry,
                  const EolCoordinates& at, const Vec3& place)
{
    const EolVertex& eol = state.eol[entry];
    if (eol.idle < kIdleSteps) return EolHold::Firm;
    const double gap = (place - at.frame.point).norm();
    if (gap > scene.eol->length(state.mesh.material[at.vertex])) return EolHold::None;
    if (is_folded(state, stars.faces[at.vertex])) return EolHold::Firm;
    return gap <= kOnFeature * scene.material.thickness ? EolHold::Loose : EolHold::None;
}

void hold_between(const Scene& scene, const State& state, const ClothStars& stars,
                  std::vector<EolHold>& holds)
{
    if (std::find(holds.begin(), holds.end(), EolHold::Loose) == holds.end()) return;
    std::vector<std::vector<int>> beside(holds.size());
    for (const auto& [a, b] : find_trace_edges(scene.obstacles, state, stars)) {
        if (holds[a] == EolHold::None || holds[b] == EolHold::None) continue;
        beside[a].push_back(b);
        beside[b].push_back(a);
    }
    // What is left when loose ends are cut off, again and again, lies between.
    std::vector<int> open;
    for (std::size_t entry = 0; entry < holds.size(); ++entry) open.push_back(static_cast<int>(entry));
    while (!open.empty()) {
        const int at = open.back();
        open.pop_back();
        if (holds[at] != EolHold::Loose || beside[at].size() > 1) continue;
        holds[at] = EolHold::None;
        for (const int next : beside[at]) {
            std::erase(beside[next], at);
            open.push_back(next);
        }
    }
    for (EolHold& hold : holds)
        if (hold == EolHold::Loose) hold = EolHold::Firm;
}

}  // namespace arris
