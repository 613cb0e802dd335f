// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/chart_turns.h"

#include <algorithm>
#include <limits>
#include <map>
#include <vector>

#include "geometry/cgal.h"
#include "geometry/cloth/mesh_pieces.h"

namespace arris {

namespace {

/// Turns of faces, 1 for those that run like most of their chart, else -1.
std::vector<int> turns_in_charts(const ClothMesh& mesh, const std::vector<int>& chart, std::vector<int> turns)
{
    std::map<int, int> sums;
    for (int f = 0; f < mesh.face_count(); ++f) sums[chart[mesh.faces[f][0]]] += turns[f];
    for (int f = 0; f < mesh.face_count(); ++f)
        if (sums[chart[mesh.faces[f][0]]] < 0) turns[f] = -turns[f];
    return turns;
}

void mirror(const std::vector<int>& chart, int label, ClothMesh& mesh)
{
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (std::size_t v = 0; v < chart.size(); ++v) {
        if (chart[v] != label) continue;
        least = std::min(least, mesh.material[v].x());
        most = std::max(most, mesh.material[v].x());
    }
    for (std::size_t v = 0; v < chart.size(); ++v)
        if (chart[v] == label) mesh.material[v].x() = least + most - mesh.material[v].x();
}

}  // namespace

ChartTurns turn_charts(const PlacedFaces& placed, ClothMesh& mesh)
{
    std::vector<int> turns;
    for (int f = 0; f < mesh.face_count(); ++f) {
        const auto [a, b, c] = mesh.corners(f);
        turns.push_back(exact_orientation(a, b, c));
        if (turns[f] == 0)
            return {0, 0, placed.describe(f) + " has no area in material space (its UVs lie on a line)"};
    }
    if (std::count(turns.begin(), turns.end(), -1) == 0) return {};
    const std::vector<int> chart = label_pieces(mesh.vertex_count(), mesh.faces);
    std::map<int, int> turn_of;  // of each chart
    for (int f = 0; f < mesh.face_count(); ++f)
        if (turn_of.emplace(chart[mesh.faces[f][0]], turns[f]).first->second != turns[f])
            return {0, 0, explain_turns(placed, turns_in_charts(mesh, chart, turns))};
    ChartTurns done;
    done.charts = static_cast<int>(turn_of.size());
    for (const auto& [label, turn] : turn_of) done.mirrored += turn < 0 ? 1 : 0;
    // Charts may lie in each other's notches: all of them are mirrored as one.
    if (done.mirrored == done.charts)
        mirror(std::vector<int>(chart.size(), 0), 0, mesh);
    else
        for (const auto& [label, turn] : turn_of)
            if (turn < 0) mirror(chart, label, mesh);
    return done;
}

}  // namespace arris
