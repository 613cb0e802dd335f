// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/remesh/misfits.h"

#include <algorithm>
#include <span>
#include <tuple>

#include "geometry/cloth/mesh_limits.h"
#include "solver/model/target_length.h"
#include "solver/remesh/sizing_field.h"

namespace arris {

namespace {

constexpr std::size_t kFew = 16;  // edges: fewer wait until they are more
constexpr double kUrgent = 2.0;   // but not for an edge that misses by this factor
constexpr std::size_t kMost = 64;
constexpr int kMostDoublings = 5;  // of the wait after a refusal

/// First entry that is not before `edge`.
template <typename Edges>
auto find_place(Edges& edges, const std::array<VertexId, 2>& edge)
{
    return std::lower_bound(
        edges.begin(), edges.end(), edge,
        [](const RefusedEdge& refused, const auto& ids) { return refused.vertex_ids < ids; });
}

bool is_waiting(const State& state, const std::array<VertexId, 2>& edge)
{
    const auto at = find_place(state.refused_edges, edge);
    return at != state.refused_edges.end() && at->vertex_ids == edge && state.step < at->until;
}

bool has_edge(const ClothStars& stars, const State& state, const std::array<VertexId, 2>& edge)
{
    const int a = state.index_of(edge[0]), b = state.index_of(edge[1]);
    if (a < 0 || b < 0) return false;
    const std::span<const int> around = stars.faces[a];
    return std::any_of(around.begin(), around.end(), [&](int f) {
        const Face& face = state.mesh.faces[f];
        return std::find(face.begin(), face.end(), b) != face.end();
    });
}

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
    const ClothMesh& mesh = state.mesh;
    const auto cells_along = [&](const MeshEdge& e, int face) {
        const Vec2 &a = mesh.material[mesh.point_of(e.a, face)], &b = mesh.material[mesh.point_of(e.b, face)];
        const double length = (b - a).norm();
        const bool fits_any =
            length <= kLongEdge * shortest_cell(scene) && length >= kShortEdge * longest_cell(scene);
        return fits_any ? 1.0 : length / target_length(scene, state, 0.5 * (a + b));
    };
    for (const MeshEdge& e : topology.edges) {
        // A seam's edge is as long as its longer side.
        double cells = cells_along(e, e.face_left);
        if (mesh.has_seams() && e.face_right >= 0) cells = std::max(cells, cells_along(e, e.face_right));
        const double miss = std::max(cells / kLongEdge, kShortEdge / cells);
        const std::array<VertexId, 2> edge = {state.ids[e.a], state.ids[e.b]};
        if (miss > 1.0 && !is_waiting(state, edge)) misfits.push_back({miss, cells > 1.0, edge});
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

void note_refused_edges(const std::vector<std::array<VertexId, 2>>& misfits, const ClothStars& stars,
                        State& state)
{
    const auto steps_after = [](int refusals) { return kRemeshPeriod << std::min(refusals, kMostDoublings); };
    // An edge is forgotten with the edge itself, or once it has not been tried for as long as it has waited.
    std::erase_if(state.refused_edges, [&](const RefusedEdge& edge) {
        return state.step >= edge.until + steps_after(edge.refusals) ||
               !has_edge(stars, state, edge.vertex_ids);
    });
    for (const std::array<VertexId, 2>& edge : misfits) {
        if (!has_edge(stars, state, edge)) continue;
        auto at = find_place(state.refused_edges, edge);
        if (at == state.refused_edges.end() || at->vertex_ids != edge)
            at = state.refused_edges.insert(at, RefusedEdge{edge});
        at->refusals = std::min(at->refusals + 1, kMostDoublings);
        at->until = state.step + steps_after(at->refusals);
    }
}

}  // namespace arris
