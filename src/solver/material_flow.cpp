// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/material_flow.h"

#include <algorithm>

namespace arris {

namespace {

/// Whether every face at an EOL vertex keeps its orientation, with enough of the material that it has at the
/// step's start for its strain to mean something. Whether what is linear in the step follows is another
/// question, to which the energy's balance has the answer.
bool has_material_left(const std::vector<Vec2>& material, Workspace& work)
{
    constexpr double kLeast = 0.4;
    work.overrun.clear();
    for (const EolCoordinates& eol : work.eol)
        for (const int f : work.stars.faces[eol.vertex]) {
            const auto& [a, b, c] = work.faces_of_elements[f];
            const double left = 0.5 * twice_area(material[a], material[b], material[c]);
            if (left >= kLeast * work.elements.faces[f].area) continue;
            const Vec2 way = material[eol.vertex] - work.material_of_elements[eol.vertex];
            work.overrun.push_back({eol.vertex, way / (work.at.time - work.at.begin)});
        }
    return work.overrun.empty();
}

}  // namespace

int find_flow_parts(const Scene& scene, const State& state, double dt)
{
    // Of a cell's edges: with the way cleared ahead, heights there are those of a cell or more, and steps
    // that take more are hardly ever made.
    constexpr double kMostCells = 0.6;
    constexpr int kMostParts = 4;  // flow may be wild
    double most = 0.0;
    for (const EolVertex& eol : state.eol) {
        const int v = state.index_of(eol.vertex_id);
        const double way = dt * state.material_velocity[v].norm();
        most = std::max(most, way / scene.eol->length(state.mesh.material[v]));
    }
    int parts = 1;
    while (parts < kMostParts && most > parts * kMostCells) parts *= 2;
    return parts;
}

bool linearise_flow(const State& state, const MovingCloth& end, Workspace& work)
{
    const Prediction& prediction = work.prediction;
    MaterialFlow& flow = *work.at.flow;
    flow.position = end.material;
    flow.v_predicted = prediction.material_velocity;
    flow.v_expansion = work.expansion.material;
    flow.v_last = state.material_velocity;
    const MovingCloth past = extrapolate(state, prediction);
    flow.extrapolated = {past.world, past.velocity.world, past.material, past.velocity.material};
    return has_material_left(flow.position, work) && has_material_left(flow.extrapolated.material, work);
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
