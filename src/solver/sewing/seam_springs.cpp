// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/sewing/seam_springs.h"

#include <algorithm>

#include "geometry/cloth/mesh_pieces.h"

namespace arris {
namespace {

/// Stiffness of a spring, in the cloth's membrane stiffness: a seam that is strained by eps stays open by
/// eps / kStiff of a cell.
constexpr double kStiff = 50.0;

/// All gaps shrink from rest to rest and are closed at the same time, so that neighbours do not tug at each
/// other.
double length_at(const SeamPair& pair, const OpenSeam& seam, const Closing& closing, double time)
{
    if (closing.order == Closing::kAllClosed) return pair.gap;
    if (seam.order < closing.order || !(time < closing.end)) return 0.0;
    const double left = (closing.end - std::max(time, closing.begin)) / (closing.end - closing.begin);
    return pair.gap * left * left * (3.0 - 2.0 * left);
}

}  // namespace

std::vector<SpringElement> list_springs(const Scene& scene, const State& state)
{
    std::vector<SpringElement> springs;
    if (!scene.sewing) return springs;
    for (const SeamPair& pair : state.seam_pairs)
        springs.push_back({{state.index_of(pair.vertex_ids[0]), state.index_of(pair.vertex_ids[1])}});
    set_spring_lengths(scene, state, state.time, springs);
    return springs;
}

void set_spring_lengths(const Scene& scene, const State& state, double time,
                        std::vector<SpringElement>& springs)
{
    for (std::size_t s = 0; s < springs.size(); ++s) {
        const SeamPair& pair = state.seam_pairs[s];
        const OpenSeam& seam = scene.sewing->seams[static_cast<std::size_t>(pair.seam)];
        double stiffness = 0.0;
        if (seam.order <= state.closing.order)
            for (const int v : springs[s].vertices)
                stiffness += 0.5 * kStiff * scene.materials[piece_of(scene, state.mesh, v)].youngs_modulus;
        springs[s].stiffness = stiffness;
        springs[s].length = length_at(pair, seam, state.closing, time);
    }
}

std::vector<int> number_joined(const State& state)
{
    if (state.seam_pairs.empty()) return {};
    const int n = state.mesh.vertex_count();
    std::vector<Face> joined;
    std::vector<char> is_joined(static_cast<std::size_t>(n), 0);
    for (const SeamPair& pair : state.seam_pairs) {
        const int v = state.index_of(pair.vertex_ids[0]), w = state.index_of(pair.vertex_ids[1]);
        joined.push_back({v, w, w});
        is_joined[static_cast<std::size_t>(v)] = is_joined[static_cast<std::size_t>(w)] = 1;
    }
    std::vector<int> number = label_pieces(n, joined);
    for (int v = 0; v < n; ++v)
        if (!is_joined[static_cast<std::size_t>(v)]) number[static_cast<std::size_t>(v)] = -1;
    return number;
}

}  // namespace arris
