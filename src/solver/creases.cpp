// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/creases.h"

#include <algorithm>

namespace arris {

bool mark_creases(const Scene& scene, const State& state, const ClothStars& stars, ClothElements& elements)
{
    constexpr double kWidth = 0.87;  // target lengths: the height of an equilateral face
    std::vector<std::array<int, 2>> edges;
    if (scene.eol)  // without a target for the mesh there is no width
        for (const auto& [a, b] : find_trace_edges(scene.obstacles, state, stars))
            edges.push_back({state.index_of(state.eol[a].vertex_id), state.index_of(state.eol[b].vertex_id)});

    std::vector<char> is_changed(state.ids.size(), 0);
    bool is_any_changed = false;
    for (HingeElement& hinge : elements.hinges) {
        const auto [a, b] = std::minmax(hinge.vertices[0], hinge.vertices[1]);
        const bool is_crease = std::binary_search(edges.begin(), edges.end(), std::array{a, b});
        if (!is_crease && !hinge.is_crease()) continue;
        const Vec2 middle = 0.5 * (state.mesh.material[a] + state.mesh.material[b]);
        const double width = is_crease ? kWidth * scene.eol->length(middle) : 0.0;
        if (width == hinge.crease_width) continue;
        hinge.crease_width = width;
        is_changed[a] = 1;
        is_any_changed = true;
    }
    if (is_any_changed) update_elements(state.mesh, is_changed, elements);
    return is_any_changed;
}

}  // namespace arris
