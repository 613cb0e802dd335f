// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/creases.h"

#include <algorithm>
#include <cmath>

namespace arris {

namespace {

/// Of all creases, m; 0 where there are none: without a target for the mesh, and where the mesh resolves the
/// bend. The tension that the cloth's weight makes, T = rho g L, bends it within sqrt(K / T) of a feature.
double find_crease_width(const Scene& scene, const ClothElements& elements)
{
    constexpr double kHeight = 0.87;  // of an equilateral face, in edge lengths
    if (!scene.eol || !scene.gravity) return 0.0;
    double area = 0.0;
    for (const FaceElement& face : elements.faces) area += face.area;
    const double tension = scene.material.density * scene.gravity->acceleration.norm() * std::sqrt(area);
    const double h = scene.eol->mean_length;
    return scene.material.bending_stiffness < tension * h * h ? kHeight * h : 0.0;
}

}  // namespace

bool mark_creases(const Scene& scene, const State& state, const ClothStars& stars, ClothElements& elements)
{
    const double crease_width = find_crease_width(scene, elements);
    std::vector<std::array<int, 2>> edges;
    if (crease_width > 0.0)
        for (const auto& [a, b] : find_trace_edges(scene.obstacles, state, stars))
            edges.push_back({state.index_of(state.eol[a].vertex_id), state.index_of(state.eol[b].vertex_id)});

    std::vector<char> is_changed(state.ids.size(), 0);
    bool is_any_changed = false;
    for (HingeElement& hinge : elements.hinges) {
        const auto [a, b] = std::minmax(hinge.vertices[0], hinge.vertices[1]);
        const bool is_crease = std::binary_search(edges.begin(), edges.end(), std::array{a, b});
        if (!is_crease && !hinge.is_crease()) continue;
        const double width = is_crease ? crease_width : 0.0;
        if (width == hinge.crease_width) continue;
        hinge.crease_width = width;
        is_changed[a] = 1;
        is_any_changed = true;
    }
    if (is_any_changed) update_elements(state.mesh, is_changed, elements);
    return is_any_changed;
}

}  // namespace arris
