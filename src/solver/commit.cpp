// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/commit.h"

#include <algorithm>
#include <utility>

#include "solver/contact/constraints.h"
#include "solver/eol/eol_features.h"
#include "solver/eol/stop_flow.h"
#include "solver/feature_census.h"
#include "solver/feature_impulses.h"
#include "solver/model/pin_targets.h"
#include "solver/remesh/misfits.h"
#include "solver/remesh/sizing_field.h"
#include "solver/sites/gathering.h"

namespace arris {

namespace {

/// Stores at each EOL vertex its outward direction, its side and the number of steps without pressing.
void count_idle(const std::vector<Contact>& contacts, const std::vector<EolCoordinates>& eol,
                const std::vector<double>& multiplier, std::vector<EolVertex>& vertices)
{
    for (const EolCoordinates& at : eol) {
        EolVertex& vertex = vertices[at.entry];
        vertex.outward = at.frame.outward;
        vertex.side = at.side;
        ++vertex.idle;
    }
    for (std::size_t c = 0; c < contacts.size(); ++c)
        if (contacts[c].eol >= 0 && multiplier[c] > 0.0) vertices[eol[contacts[c].eol].entry].idle = 0;
}

}  // namespace

void commit(const Scene& scene, const PlannedStep& planned, double end, Workspace& work, State& state,
            StepReport& report)
{
    if (report.status != StepStatus::Done) return;
    const std::vector<double> multiplier = contact_multipliers(work.contacts, work.solution);
    const FeatureCensus census = take_census(scene, state, work, multiplier);
    report.feature_rows = census.rows;
    report.rows_by_cause = census.by_cause;
    report.eol_pressing = census.eol;
    store_feature_forces(multiplier, work, state);
    state.active = active_contacts(state, work.carriers, work.contacts, multiplier);
    state.coupled = work.mesh.system.coupled();
    count_idle(work.contacts, work.eol, multiplier, state.eol);
    state.crossings += report.crossings;
    const auto count = [&](const auto& is_one) {
        return static_cast<int>(std::count_if(state.active.begin(), state.active.end(), is_one));
    };
    report.self_contacts =
        count([](const ActiveContact& contact) { return contact.obstacle == kClothItself; });
    report.yielded = count([](const ActiveContact& contact) { return contact.is_squeezed; });
    report.contacts = static_cast<int>(state.active.size()) - report.self_contacts - count(is_fold_plane);
    state.previous_world.swap(state.mesh.world);
    state.previous_velocity.swap(state.velocity);
    state.mesh.world.swap(work.proposal.world);
    state.velocity.swap(work.proposal.velocity);
    state.previous_material.swap(state.mesh.material);
    state.previous_material_velocity.swap(state.material_velocity);
    state.mesh.material.swap(work.proposal.material);
    state.material_velocity.swap(work.proposal.material_velocity);
    state.previous_dt = report.rewound > 0 ? 0.0 : end - state.time;  // a rewound path is no history
    const double begin = std::exchange(state.time, end);
    follow_features(scene.obstacles, state);
    grow_gathering(scene, work.mesh.stars, report.dt, state);
    note_refused_edges(work.mesh.misfits, work.mesh.stars, state);
    if (planned.ends_at(end)) {
        ++state.step;
        follow_wanted_lengths(scene, work.mesh.stars, planned.length(), state);
    }
    work.energies.known_at.world.clear();
    if (report.rewound == 0) {
        work.energies.known = work.energies.proposed;
        work.energies.known_at = {
            state.mesh.world, state.mesh.material, {state.velocity, state.material_velocity}};
    }
    update_anchors(scene, begin, state);
    release_pinned(scene, work.mesh.stars, state);  // may change velocities, unlike `known_at`
    report.eol_vertices = static_cast<int>(state.eol.size());
}

}  // namespace arris
