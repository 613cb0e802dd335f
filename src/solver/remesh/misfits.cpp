// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/remesh/misfits.h"

#include <algorithm>
#include <tuple>

#include "geometry/cloth/mesh_limits.h"
#include "solver/model/cell_length.h"
#include "solver/remesh/cell_lengths.h"

namespace arris {

namespace {

constexpr double kUrgent = 2.0;   // an edge that misses by this factor does not wait
constexpr std::size_t kFew = 16;  // edges: fewer wait until conforming makes a mesh anyway
constexpr std::size_t kMost = 64;

}  // namespace

std::vector<std::array<VertexId, 2>> find_misfits(const Scene& scene, const State& state,
                                                  const MeshTopology& topology)
{
    using Misfit = std::tuple<double, std::array<VertexId, 2>>;
    std::vector<Misfit> misfits;
    if (!scene.remesh) return {};
    const std::vector<Vec2>& X = state.mesh.material;
    for (const MeshEdge& e : topology.edges) {
        const double length = (X[e.b] - X[e.a]).norm();
        if (length <= kLongEdge * shortest_cell(scene) && length >= kShortEdge * longest_cell(scene))
            continue;
        const double cells = length / cell_length(scene, state, 0.5 * (X[e.a] + X[e.b]));
        const double miss = std::max(cells / kLongEdge, kShortEdge / cells);
        if (miss > 1.0) misfits.push_back({-miss, {state.ids[e.a], state.ids[e.b]}});
    }
    std::sort(misfits.begin(), misfits.end());
    const bool is_urgent = !misfits.empty() && -std::get<0>(misfits.front()) > kUrgent;
    if (!is_urgent && (misfits.size() < kFew || state.step % kRemeshPeriod != 0)) return {};
    misfits.resize(std::min(misfits.size(), kMost));
    std::vector<std::array<VertexId, 2>> edges;
    for (const Misfit& misfit : misfits) edges.push_back(std::get<1>(misfit));
    return edges;
}

}  // namespace arris
