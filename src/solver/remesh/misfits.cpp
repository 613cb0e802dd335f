// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/remesh/misfits.h"

#include <algorithm>
#include <tuple>

#include "geometry/cloth/mesh_limits.h"
#include "solver/model/cell_length.h"
#include "solver/remesh/cell_lengths.h"

namespace arris {

namespace {

constexpr std::size_t kFew = 16;  // edges: fewer wait until they are more
constexpr double kUrgent = 2.0;   // but not for an edge that misses by this factor
constexpr std::size_t kMost = 64;

}  // namespace

std::vector<std::array<VertexId, 2>> find_misfits(const Scene& scene, const State& state,
                                                  const MeshTopology& topology)
{
    struct Misfit {
        double miss;  // factor by which the edge misses its cell's bounds
        bool is_long;
        std::array<VertexId, 2> edge;
    };
    std::vector<Misfit> misfits;
    if (!scene.remesh || state.step % kRemeshPeriod != 0) return {};
    const std::vector<Vec2>& X = state.mesh.material;
    for (const MeshEdge& e : topology.edges) {
        const double length = (X[e.b] - X[e.a]).norm();
        if (length <= kLongEdge * shortest_cell(scene) && length >= kShortEdge * longest_cell(scene))
            continue;
        const double cells = length / cell_length(scene, state, 0.5 * (X[e.a] + X[e.b]));
        const double miss = std::max(cells / kLongEdge, kShortEdge / cells);
        if (miss > 1.0) misfits.push_back({miss, cells > 1.0, {state.ids[e.a], state.ids[e.b]}});
    }
    std::sort(misfits.begin(), misfits.end(), [](const Misfit& a, const Misfit& b) {
        return std::tie(b.miss, a.edge) < std::tie(a.miss, b.edge);
    });
    int room = scene.remesh->most_vertices - state.mesh.vertex_count();  // a split makes a vertex
    std::erase_if(misfits, [&](const Misfit& misfit) { return misfit.is_long && room-- <= 0; });
    const bool is_urgent = !misfits.empty() && misfits.front().miss > kUrgent;
    if (misfits.size() < kFew && !is_urgent) return {};
    misfits.resize(std::min(misfits.size(), kMost));
    std::vector<std::array<VertexId, 2>> edges;
    for (const Misfit& misfit : misfits) edges.push_back(misfit.edge);
    return edges;
}

}  // namespace arris
