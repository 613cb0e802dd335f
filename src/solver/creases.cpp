// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/creases.h"

#include <algorithm>
#include <cmath>

#include "geometry/mesh_quality.h"
#include "solver/eol_features.h"

namespace arris {

bool resolves_bends(const Scene& scene, const ClothMesh& cloth)
{
    if (!scene.eol || !scene.gravity) return false;
    const double tension =
        scene.material.density * scene.gravity->acceleration.norm() * std::sqrt(material_area(cloth));
    const double h = scene.eol->mean_length;
    return tension > 0.0 && scene.material.bending_stiffness >= tension * h * h;
}

double find_crease_width(const Scene& scene, const ClothMesh& cloth)
{
    constexpr double kHeight = 0.87;  // of an equilateral face, in edge lengths
    if (!scene.eol || !scene.gravity || scene.gravity->acceleration.isZero(0.0)) return 0.0;
    return resolves_bends(scene, cloth) ? 0.0 : kHeight * scene.eol->mean_length;
}

Creases find_creases(const Scene& scene, const State& state, const ClothStars& stars)
{
    Creases creases{find_crease_width(scene, state.mesh), {}};
    if (creases.width > 0.0)
        for (const auto& [a, b] : find_trace_edges(scene.obstacles, state, stars))
            creases.edges.push_back(
                {state.index_of(state.eol[a].vertex_id), state.index_of(state.eol[b].vertex_id)});
    return creases;
}

bool mark_creases(const Creases& creases, const ClothMesh& mesh, ClothElements& elements)
{
    std::vector<char> is_changed(mesh.world.size(), 0);
    bool is_any_changed = false;
    for (HingeElement& hinge : elements.hinges) {
        const auto [a, b] = std::minmax(hinge.vertices[0], hinge.vertices[1]);
        const bool is_crease =
            std::binary_search(creases.edges.begin(), creases.edges.end(), std::array{a, b});
        const double width = is_crease ? creases.width : 0.0;
        if (width == hinge.crease_width) continue;
        hinge.crease_width = width;
        is_changed[a] = 1;
        is_any_changed = true;
    }
    if (is_any_changed) update_elements(mesh, is_changed, elements);
    return is_any_changed;
}

}  // namespace arris
