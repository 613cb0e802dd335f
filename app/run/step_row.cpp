// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/step_row.h"

#include <algorithm>

#include "geometry/cloth/mesh_quality.h"
#include "solver/energy_balance.h"
#include "solver/sewing/closing.h"

namespace arris {

StepRow make_step_row(const RunConfig& config, const State& state, const Workspace& work,
                      const Audit& audited, const StepReport& report)
{
    const Scene& scene = config.scene;
    const auto [kinetic_energy, energies] = find_energy(scene, state, work);
    StepRow row;
    row.time = state.time;
    row.dt = report.dt;
    row.vertices = state.mesh.vertex_count();
    row.faces = state.mesh.face_count();
    row.contacts = report.contacts;
    row.kinetic_energy = kinetic_energy;
    if (scene.gravity) row.gravity_energy = energies.gravity;
    row.stretch_energy = energies.stretch;
    if (!work.mesh.terms.hinges.empty()) row.bending_energy = energies.bending;
    if (!scene.obstacles.empty()) {
        row.feature_rows = report.feature_rows;
        if (scene.eol) {
            row.eol_vertices = report.eol_vertices;
            row.eol_pressing = report.eol_pressing;
            row.rows_by_cause = report.rows_by_cause;
        }
        row.yielded = report.yielded;
    }
    if (scene.self_contact) row.self_contacts = report.self_contacts;
    if (scene.remesh) {
        row.remeshed = report.remeshed;
        row.remesh_energy = report.remesh_energy;
    }
    if (scene.sewing) {
        row.sewing_energy = energies.seam + state.sewn_energy;
        row.open_pairs = 0;
        for (const SeamGap& seam : find_open_seams(scene, state)) *row.open_pairs += seam.pairs;
    }
    const bool has_contact = scene.self_contact || !scene.obstacles.empty();
    if (has_contact) row.rewound = report.rewound;
    if (has_contact && scene.friction) {
        row.friction_sweeps = report.friction_sweeps;
        row.friction_residual = report.friction_residual;
        row.friction_work = report.friction_work;
        row.sticking = report.sticking;
        row.sliding = report.sliding;
    }
    row.energy_rise = report.energy_rise;
    row.material_area = material_area(state.mesh);
    row.max_penetration = audited.found.depth;
    row.crossings = state.crossings;
    row.min_angle = least_material_angle(state.mesh);
    row.kkt_residual = report.kkt_residual;
    row.factorisations = report.factorisations;
    row.nlopt_evaluations = report.nlopt_evaluations;
    row.solves = report.solves;
    row.seconds = report.seconds;
    return row;
}

StepReport join_parts(const StepReport& opening, StepReport rest)
{
    rest.dt += opening.dt;
    rest.energy_rise += opening.energy_rise;
    rest.kkt_residual = std::max(rest.kkt_residual, opening.kkt_residual);
    rest.friction_residual = std::max(rest.friction_residual, opening.friction_residual);
    rest.friction_work += opening.friction_work;
    rest.yielded += opening.yielded;
    rest.rewound += opening.rewound;
    rest.remeshed += opening.remeshed;
    rest.remesh_energy += opening.remesh_energy;
    rest.add_cost(opening);
    return rest;
}

}  // namespace arris
