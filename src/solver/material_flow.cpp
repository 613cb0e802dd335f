// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/material_flow.h"

#include <algorithm>
#include <set>
#include <utility>

#include "solver/eol/eol_coordinates.h"
#include "solver/model/cell_length.h"
#include "solver/model/eol_limits.h"

namespace arris {

std::vector<Overrun> find_overrun(const std::vector<Vec2>& material, const std::vector<EolCoordinates>& eol,
                                  const MeshCache& mesh, double dt)
{
    constexpr double kLeast = 1.0 - kMostFaceTaken;
    std::vector<Overrun> overrun;
    for (const EolCoordinates& at : eol)
        for (const int f : mesh.stars.faces[at.vertex]) {
            const auto& [a, b, c] = mesh.faces_of_elements[f];
            const double left = 0.5 * twice_area(material[a], material[b], material[c]);
            if (left >= kLeast * mesh.elements.faces[f].area) continue;
            const Vec2 way = material[at.vertex] - mesh.material_of_elements[at.vertex];
            overrun.push_back({at.vertex, way / dt});
        }
    return overrun;
}

namespace {

std::vector<Overrun> find_overrun(const std::vector<Vec2>& material, const Workspace& work)
{
    return find_overrun(material, work.eol, work.mesh, work.linearization.time - work.linearization.begin);
}

/// Vertices that were taken back, and those of faces that even so have too little material.
struct Shortened {
    std::set<int> vertices = {};
    std::vector<Overrun> overrun;
};

/// Takes vertices that would leave faces too little material back towards their start in the step: in the
/// world, in the material and in velocity.
Shortened shorten(const State& state, const Workspace& work, MovingCloth& cloth)
{
    constexpr int kHalvings = 4;  // afterwards they stay at the start, where material is always left
    const auto go_back = [](double share, const auto& from, auto& to) { to = from + share * (to - from); };
    Shortened shortened = {.overrun = find_overrun(cloth.material, work)};
    for (int round = 0; round <= kHalvings && !shortened.overrun.empty(); ++round) {
        const double share = round < kHalvings ? 0.5 : 0.0;
        std::set<int> vertices;  // each once: `overrun` has a vertex for every face
        for (const Overrun& overrun : shortened.overrun) vertices.insert(overrun.vertex);
        for (const int v : vertices) {
            go_back(share, state.mesh.world[v], cloth.world[v]);
            go_back(share, state.mesh.material[v], cloth.material[v]);
            go_back(share, state.velocity[v], cloth.velocity.world[v]);
            go_back(share, state.material_velocity[v], cloth.velocity.material[v]);
        }
        shortened.vertices.merge(vertices);
        shortened.overrun = find_overrun(cloth.material, work);
    }
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

std::vector<Overrun> linearise_flow(const State& state, Workspace& work)
{
    const Prediction& prediction = work.prediction;
    MovingCloth end = find_end(prediction, work.expansion);
    const Shortened shortened = shorten(state, work, end);
    for (const int v : shortened.vertices) {
        work.expansion.world[v] = (end.world[v] - prediction.position[v]) / prediction.gamma;
        work.expansion.material[v] = (end.material[v] - prediction.material[v]) / prediction.gamma;
    }
    if (!shortened.overrun.empty()) return shortened.overrun;
    MovingCloth past = extrapolate(state, prediction);
    std::vector<Overrun> overrun = shorten(state, work, past).overrun;
    MaterialFlow& flow = *work.linearization.flow;
    flow.position = std::move(end.material);
    flow.v_predicted = prediction.material_velocity;
    flow.v_expansion = work.expansion.material;
    flow.v_last = state.material_velocity;
    flow.extrapolated = {past.world, past.velocity.world, past.material, past.velocity.material};
    return overrun;
}

std::vector<Overrun> propose_flow(Workspace& work)
{
    work.proposal.material = work.prediction.material;
    work.proposal.material_velocity.assign(work.prediction.material.size(), Vec2::Zero());
    for (const EolCoordinates& eol : work.eol) {
        const int v = eol.vertex;
        Vec2& flow = work.proposal.material_velocity[v];
        flow = eol.material_basis * work.solution.velocity.segment<3>(3 * v);
        work.proposal.material[v] += work.prediction.gamma * flow;
    }
    return find_overrun(work.proposal.material, work);
}

}  // namespace arris
