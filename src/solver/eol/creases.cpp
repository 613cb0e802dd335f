// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/eol/creases.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/cloth/mesh_quality.h"
#include "solver/eol/eol_features.h"

namespace arris {

namespace {

/// Length sqrt(K / T), m, over which each piece bends on either side of a feature. Infinite without gravity.
std::vector<double> find_bend_lengths(const Scene& scene, const ClothMesh& cloth)
{
    const double weight = scene.gravity ? scene.gravity->acceleration.norm() : 0.0;
    const std::vector<double> areas = piece_areas(scene.materials, cloth);
    std::vector<double> lengths;
    for (int p = 0; p < scene.materials.count(); ++p) {
        const Material& material = scene.materials[p];
        const double tension = material.density * weight * std::sqrt(areas[p]);
        lengths.push_back(tension > 0.0 ? std::sqrt(material.bending_stiffness / tension)
                                        : std::numeric_limits<double>::infinity());
    }
    return lengths;
}

}  // namespace

bool resolves_bends(const Scene& scene, const ClothMesh& cloth)
{
    if (!scene.eol) return false;
    const std::vector<double> bends = find_bend_lengths(scene, cloth);
    return std::equal(bends.begin(), bends.end(), scene.eol->mean_lengths.begin(),
                      [](double bend, double edge) { return std::isfinite(bend) && bend >= edge; });
}

std::vector<double> find_crease_widths(const Scene& scene, const ClothMesh& cloth)
{
    constexpr double kHeight = 0.87;  // height of an equilateral face, in edge lengths
    std::vector<double> widths(static_cast<std::size_t>(scene.materials.count()), 0.0);
    if (!scene.eol) return widths;
    const std::vector<double> bends = find_bend_lengths(scene, cloth);
    for (std::size_t p = 0; p < widths.size(); ++p) {
        const double width = kHeight * scene.eol->mean_lengths[p];
        if (2.0 * bends[p] < width) widths[p] = width;
    }
    return widths;
}

Creases find_creases(const Scene& scene, const State& state, const ClothStars& stars)
{
    Creases creases{find_crease_widths(scene, state.mesh), {}};
    if (*std::max_element(creases.widths.begin(), creases.widths.end()) > 0.0)
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
        const double width = is_crease ? creases.widths[hinge.pieces[0]] : 0.0;
        if (width == hinge.crease_width) continue;
        hinge.crease_width = width;
        is_changed[a] = 1;
        is_any_changed = true;
    }
    if (is_any_changed) update_elements(mesh, is_changed, elements);
    return is_any_changed;
}

}  // namespace arris
