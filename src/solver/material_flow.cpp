// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/material_flow.h"

#include <algorithm>
#include <set>
#include <utility>

#include "solver/eol/eol_coordinates.h"
#include "solver/model/eol_limits.h"
#include "solver/model/target_length.h"

namespace arris {

std::vector<Overrun> find_overrun(const std::vector<Vec2>& material, const std::vector<EolCoordinates>& eol,
                                  const MeshCache& mesh, double dt)
{
    std::vector<Overrun> overrun;
    for (const EolCoordinates& at : eol)
        for (const int f : mesh.stars.faces[at.vertex]) {
            const auto& [a, b, c] = mesh.elements.faces[f].points;
            const double left = 0.5 * twice_area(material[a], material[b], material[c]);
            if (left >= (1.0 - kMostFaceTaken) * mesh.elements.faces[f].area) continue;
            const Vec2 way = material[at.vertex] - mesh.material_of_elements[at.vertex];
            overrun.push_back({at.vertex, way / dt});
        }
    return overrun;
}

namespace {

/// Vertices that were taken back, and those of faces that even so have too little material.
struct Shortened {
    std::set<int> vertices = {};
    std::vector<Overrun> overrun;
};

/// Takes vertices that would leave faces too little material back towards their start in the step: in the
/// world, in the material and in velocity.
Shortened shorten(const State& state, const std::vector<EolCoordinates>& eol, const MeshCache& mesh,
                  double dt, MovingCloth& cloth)
{
    constexpr int kHalvings = 4;  // afterwards they stay at the start, where material is always left
    const auto go_back = [](double share, const auto& from, auto& to) { to = from + share * (to - from); };
    Shortened shortened = {.overrun = find_overrun(cloth.material, eol, mesh, dt)};
    for (int round = 0; round <= kHalvings && !shortened.overrun.empty(); ++round) {
        const double share = round < kHalvings ? 0.5 : 0.0;
        std::set<int> vertices;  // each once: `overrun` has a vertex for every face
        for (const Overrun& overrun : shortened.overrun) vertices.insert(overrun.vertex);
        for (const EolCoordinates& at : eol) {
            const int v = at.vertex;
            if (!vertices.contains(v)) continue;
            go_back(share, state.mesh.world[v], cloth.world[v]);
            go_back(share, state.velocity[v], cloth.velocity.world[v]);
            at.for_points(Vec2::Zero(), [&](int p, const Vec2&) {
                go_back(share, state.mesh.material[p], cloth.material[p]);
                go_back(share, state.material_velocity[p], cloth.velocity.material[p]);
            });
        }
        shortened.vertices.merge(vertices);
        shortened.overrun = find_overrun(cloth.material, eol, mesh, dt);
    }
    return shortened;
}

}  // namespace

int find_flow_parts(const Scene& scene, const State& state, double dt)
{
    // A part may take kMostFaceTaken of a cell. Faces ahead of a vertex with a cleared way are at least a
    // cell high, so steps that take more rarely succeed.
    constexpr int kMostParts = 4;  // a bound, as the flow of a single vertex may be far too large
    double most = 0.0;
    for (const EolVertex& eol : state.eol) {
        const int v = state.index_of(eol.vertex_id);
        const double way = dt * state.material_velocity[v].norm();
        most = std::max(most, way / target_length(scene, state, state.mesh.material[v]));
    }
    int parts = 1;
    while (parts < kMostParts && most > parts * kMostFaceTaken) parts *= 2;
    return parts;
}

LinearisedFlow linearise_flow(const State& state, const Prediction& prediction, ClothVelocity expansion,
                              const std::vector<EolCoordinates>& eol, const MeshCache& mesh, double dt)
{
    MovingCloth end = find_end(prediction, expansion);
    const Shortened shortened = shorten(state, eol, mesh, dt, end);
    for (const EolCoordinates& at : eol) {
        const int v = at.vertex;
        if (!shortened.vertices.contains(v)) continue;
        expansion.world[v] = (end.world[v] - prediction.position[v]) / prediction.gamma;
        at.for_points(Vec2::Zero(), [&](int p, const Vec2&) {
            expansion.material[p] = (end.material[p] - prediction.material[p]) / prediction.gamma;
        });
    }
    LinearisedFlow found = {std::move(expansion), std::move(end.material), {}, shortened.overrun};
    if (!found.overrun.empty()) return found;
    MovingCloth past = extrapolate(state, prediction);
    found.overrun = shorten(state, eol, mesh, dt, past).overrun;
    found.extrapolated = {std::move(past.world), std::move(past.velocity.world), std::move(past.material),
                          std::move(past.velocity.material)};
    return found;
}

FlowedMaterial find_flowed_material(const Prediction& prediction, const std::vector<EolCoordinates>& eol,
                                    const Eigen::VectorXd& velocity)
{
    FlowedMaterial flowed = {prediction.material,
                             std::vector<Vec2>(prediction.material_velocity.size(), Vec2::Zero())};
    for (const EolCoordinates& at : eol) {
        at.for_points(at.material_basis * velocity.segment<3>(3 * at.vertex), [&](int p, const Vec2& flow) {
            flowed.velocity[p] = flow;
            flowed.material[p] += prediction.gamma * flow;
        });
    }
    return flowed;
}

}  // namespace arris
