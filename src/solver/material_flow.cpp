// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/material_flow.h"

#include <algorithm>
#include <set>
#include <utility>

#include "solver/eol/eol_coordinates.h"
#include "solver/model/cell_length.h"
#include "solver/model/eol_limits.h"

namespace arris {

bool has_material_left(const std::vector<Vec2>& material, Workspace& work)
{
    constexpr double kLeast = 1.0 - kMostFaceTaken;
    work.overrun.clear();
    for (const EolCoordinates& eol : work.eol)
        for (const int f : work.mesh.stars.faces[eol.vertex]) {
            const auto& [a, b, c] = work.mesh.faces_of_elements[f];
            const double left = 0.5 * twice_area(material[a], material[b], material[c]);
            if (left >= kLeast * work.mesh.elements.faces[f].area) continue;
            const Vec2 way = material[eol.vertex] - work.mesh.material_of_elements[eol.vertex];
            work.overrun.push_back({eol.vertex, way / (work.linearization.time - work.linearization.begin)});
        }
    return work.overrun.empty();
}

namespace {

/// Takes vertices that would leave faces too little material back towards their start in the step: in the
/// world, in the material and in velocity. Returns these vertices.
std::set<int> shorten(const State& state, Workspace& work, MovingCloth& cloth)
{
    constexpr int kHalvings = 4;  // afterwards they stay at the start, where material is always left
    const auto go_back = [](double share, const auto& from, auto& to) { to = from + share * (to - from); };
    std::set<int> shortened;
    for (int round = 0; round <= kHalvings && !has_material_left(cloth.material, work); ++round) {
        const double share = round < kHalvings ? 0.5 : 0.0;
        std::set<int> vertices;  // each once: `overrun` has a vertex for every face
        for (const Overrun& overrun : work.overrun) vertices.insert(overrun.vertex);
        for (const int v : vertices) {
            go_back(share, state.mesh.world[v], cloth.world[v]);
            go_back(share, state.mesh.material[v], cloth.material[v]);
            go_back(share, state.velocity[v], cloth.velocity.world[v]);
            go_back(share, state.material_velocity[v], cloth.velocity.material[v]);
        }
        shortened.merge(vertices);
    }
    if (!shortened.empty()) has_material_left(cloth.material, work);
    return shortened;
}

}  // namespace

int find_flow_parts(const Scene& scene, const State& state, double dt)
{
    // Cells that a part may take. Faces ahead of a vertex with a cleared way are at least a cell high, so
    // steps that take more rarely succeed.
    constexpr double kMostCells = kMostFaceTaken;
    constexpr int kMostParts = 4;  // a bound, as the flow of a single vertex may be far too large
    double most = 0.0;
    for (const EolVertex& eol : state.eol) {
        const int v = state.index_of(eol.vertex_id);
        const double way = dt * state.material_velocity[v].norm();
        most = std::max(most, way / cell_length(scene, state, state.mesh.material[v]));
    }
    int parts = 1;
    while (parts < kMostParts && most > parts * kMostCells) parts *= 2;
    return parts;
}

bool linearise_flow(const State& state, Workspace& work)
{
    const Prediction& prediction = work.prediction;
    MovingCloth end = find_end(prediction, work.expansion);
    for (const int v : shorten(state, work, end)) {
        work.expansion.world[v] = (end.world[v] - prediction.position[v]) / prediction.gamma;
        work.expansion.material[v] = (end.material[v] - prediction.material[v]) / prediction.gamma;
    }
    if (!work.overrun.empty()) return false;
    MovingCloth past = extrapolate(state, prediction);
    shorten(state, work, past);
    MaterialFlow& flow = *work.linearization.flow;
    flow.position = std::move(end.material);
    flow.v_predicted = prediction.material_velocity;
    flow.v_expansion = work.expansion.material;
    flow.v_last = state.material_velocity;
    flow.extrapolated = {past.world, past.velocity.world, past.material, past.velocity.material};
    return work.overrun.empty();
}

bool propose_flow(Workspace& work)
{
    work.proposal.material = work.prediction.material;
    work.proposal.material_velocity.assign(work.prediction.material.size(), Vec2::Zero());
    for (const EolCoordinates& eol : work.eol) {
        const int v = eol.vertex;
        Vec2& flow = work.proposal.material_velocity[v];
        flow = eol.material_basis * work.solution.velocity.segment<3>(3 * v);
        work.proposal.material[v] += work.prediction.gamma * flow;
    }
    return has_material_left(work.proposal.material, work);
}

}  // namespace arris
