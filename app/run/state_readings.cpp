// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/state_readings.h"

#include <algorithm>

#include "geometry/cloth/material_locator.h"
#include "physics/forces/inertia.h"
#include "solver/contact/contacts.h"
#include "solver/eol/cloth_stars.h"
#include "solver/eol/eol_features.h"

namespace arris {

namespace {

/// The cloth's edges that lie on features, ascending.
std::vector<std::array<int, 2>> find_eol_edges(const std::vector<MovingObstacle>& obstacles,
                                               const State& state)
{
    std::vector<std::array<int, 2>> edges;
    if (state.eol.empty()) return edges;
    const ClothStars stars = make_stars(state.mesh);
    for (const auto& [a, b] : find_trace_edges(obstacles, state, stars))
        edges.push_back({state.index_of(state.eol[a].vertex_id), state.index_of(state.eol[b].vertex_id)});
    return edges;
}

}  // namespace

std::vector<std::uint8_t> eol_kinds(const State& state)
{
    std::vector<std::uint8_t> kinds(state.ids.size(), 0);
    for (const EolVertex& eol : state.eol) kinds[state.index_of(eol.vertex_id)] = eol.on.is_corner() ? 2 : 1;
    return kinds;
}

Frame make_frame(const std::vector<MovingObstacle>& obstacles, const State& state,
                 const ClothElements& elements, const Terms& terms)
{
    Frame frame;
    frame.world = state.mesh.world;
    frame.material = state.mesh.material;
    frame.face_points = state.mesh.face_points;
    frame.seam_vertices = state.mesh.seam_vertices;
    frame.vertex_velocity = state.velocity;
    frame.material_velocity = mean_corner_velocities(
        elements,
        compute_corner_velocities(elements, state.mesh.world, state.velocity, state.material_velocity),
        state.velocity, state.material_velocity);
    frame.ids = state.ids;
    frame.eol = eol_kinds(state);
    if (!state.eol.empty()) frame.eol_edges = find_eol_edges(obstacles, state);
    frame.contact.assign(state.ids.size(), 0);
    for (const ActiveContact& contact : state.active)
        for (const std::uint32_t id : contact.vertex_ids)  // a fold plane is not an obstacle's surface
            if (id != ContactVertexIds::kNoVertex && !is_fold_plane(contact))
                frame.contact[state.index_of(id)] = 1;
    frame.faces = state.mesh.faces;
    FaceReadings readings = compute_face_readings(elements, terms, state.mesh.world);
    frame.strain = std::move(readings.strain);
    frame.stretch_energy = std::move(readings.stretch_energy);
    frame.bending_energy = std::move(readings.bending_energy);
    return frame;
}

std::vector<ProbeSample> sample_probes(const std::vector<Probe>& probes, const State& state)
{
    std::vector<ProbeSample> samples;
    for (const Probe& probe : probes) {
        const MaterialLocation at = locate(state.mesh, probe.material);
        ProbeSample sample;
        if (at.face >= 0) {
            const Face& face = state.mesh.faces[at.face];
            const FaceElement element =
                make_face_element(state.mesh.material, face, state.mesh.points_of(at.face));
            const Mat32 F = FaceState(element, state.mesh.world).F;
            for (int k = 0; k < 3; ++k) {
                const int v = face[k];
                sample.position += at.weights[k] * state.mesh.world[v];
                const int point = state.mesh.points_of(at.face)[k];
                sample.velocity += at.weights[k] * (state.velocity[v] - F * state.material_velocity[point]);
            }
        }
        samples.push_back(sample);
    }
    return samples;
}

}  // namespace arris
