// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/eol/creases.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/cloth/mesh_quality.h"
#include "solver/eol/eol_features.h"

namespace arris {

namespace {

/// Length sqrt(K / T), m, over which this cloth bends on either side of a feature. Infinite without gravity.
double find_bend_length(const Scene& scene, const ClothMesh& cloth)
{
    const double weight = scene.gravity ? scene.gravity->acceleration.norm() : 0.0;
    const double tension = scene.material.density * weight * std::sqrt(material_area(cloth));
    return tension > 0.0 ? std::sqrt(scene.material.bending_stiffness / tension)
                         : std::numeric_limits<double>::infinity();
}

}  // namespace

bool resolves_bends(const Scene& scene, const ClothMesh& cloth)
{
    const double bend = find_bend_length(scene, cloth);
    return scene.eol && std::isfinite(bend) && bend >= scene.eol->mean_length;
}

double find_crease_width(const Scene& scene, const ClothMesh& cloth)
{
    constexpr double kHeight = 0.87;  // height of an equilateral face, in edge lengths
    if (!scene.eol) return 0.0;
    const double width = kHeight * scene.eol->mean_length;
    return 2.0 * find_bend_length(scene, cloth) < width ? width : 0.0;
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
