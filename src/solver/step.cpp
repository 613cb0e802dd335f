// SPDX-License-Identifier: GPL-3.0-or-later
// One time step, from `state.time` to `end`. `make_stages` makes it in seven stages:
//
//   stage                 result                                       code, in src/solver
//   1. choose_step_mesh   mesh with EOL vertices on pressing features  mesh_change/step_mesh
//   2. move               predicted cloth, pins and obstacles at end   model/time_integration
//   3. find_contacts      contacts that the cloth may meet             step_contacts, contact/contacts
//   4. assemble           A, b; contacts as bounds or constraints      contact/constraints, material_flow
//   5. solve_velocity     velocity, with its certificate               velocity_solve/velocity_solve
//   6. propose_and_check  new positions, whole path checked            contact/proposal, energy_balance
//   7. commit             the proposal becomes the new state           commit
//
// Stages 4 to 6 repeat in rounds until the proposal is clean (rounds.cpp: the table there says what follows
// what). Only stage 7 changes the state. `advance` (advance.h) calls `make_part` and decides, with
// RetryPolicy, what follows a failed step. docs/method.md derives the equations and explains their symbols;
// docs/glossary.md lists the words.
#include "solver/step.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "solver/buckling_seed.h"
#include "solver/commit.h"
#include "solver/energy_balance.h"
#include "solver/eol/eol_coordinates.h"
#include "solver/mesh_change/step_mesh.h"
#include "solver/model/stopwatch.h"
#include "solver/not_finite.h"
#include "solver/overconstrained.h"
#include "solver/remesh/sizing_field.h"
#include "solver/rounds.h"
#include "solver/sewing/seam_springs.h"
#include "solver/step_contacts.h"

namespace arris {

namespace {

/// Stage 2: predicts the cloth from its history (q~, v~), and places pins and obstacles at `end`. Forces are
/// first linearised at the velocity of the last step, or at q~ where BDF2 is without history.
void move(const Scene& scene, const Settings& settings, double end, const State& state, Workspace& work)
{
    work.prediction = predict(state, settings.integrator, end - state.time);
    work.expansion = {state.velocity, state.material_velocity};
    if (!work.prediction.has_history && settings.integrator == Integrator::Bdf2) {
        work.expansion.world.assign(state.velocity.size(), Vec3::Zero());
        work.expansion.material.assign(state.material_velocity.size(), Vec2::Zero());
    }
    work.least = {};
    work.pin_targets = find_pin_targets(scene, state, end);
    work.carriers =
        move_obstacles(scene, state, work.mesh.stars.topology.edges, work.prediction, work.pin_targets, end);
}

/// Whether an EOL vertex has gone round its wire or tip with the cloth.
bool has_turned(const Workspace& work, const State& state)
{
    return std::any_of(work.eol.begin(), work.eol.end(), [&](const EolCoordinates& eol) {
        const Carrier& carrier = work.carriers[state.eol[eol.entry].on.obstacle];
        return eol.carried != carrier.end(carrier.motion.begin[eol.vertex]);
    });
}

/// One part of a step in seven stages. `state.active`, the contacts that pressed at the end of the last part,
/// tells which features press and is the first guess of the active set.
StepReport make_stages(const Scene& scene, const Settings& settings, const PlannedStep& planned, double end,
                       State& state, Workspace& work, Attempt attempt)
{
    StepReport report;
    report.dt = end - state.time;
    Stopwatch watch;
    if (note_not_finite(CheckedStage::Start, state, work, report)) {
        work.retry.note(report, attempt, state, state, {});
        return report;
    }

    // 1. The mesh, with EOL vertices on the features that press; new elements where the mesh has changed.
    const StepMesh mesh = choose_step_mesh(scene, planned, end, work.retry.flow(), state, work.mesh, report);
    if (mesh.is_changed) work.energies.known_at.world.clear();
    State& start = mesh.start;
    watch.lap();

    // 2. The integrator's q~ and v~; pins and obstacles at `end`; the lengths of seams that close.
    move(scene, settings, end, start, work);
    set_spring_lengths(scene, start, end, work.mesh.elements.springs);
    report.seconds.move += watch.lap();

    // 3. Contacts of vertices, edges and faces. A vertex without room fails the step.
    const bool has_room = find_contacts(scene, start, work, report);
    if (!scene.obstacles.empty()) report.seconds.contacts += watch.lap();
    if (!has_room) {
        work.retry.note(report, attempt, state, start, {});
        return report;
    }
    // Cloth that is compressed exactly in a plane has no force across it, and could never fold by itself.
    seed_buckling(scene, start, work.mesh, work.contacts, work.prediction);
    measure_start_energy(scene, start, work);
    report.seconds.move += watch.lap();

    // 4 - 6. Solve, propose and check, in bounded rounds: violations become constraints. A mesh with EOL
    // vertices takes no last resorts, as RetryPolicy first tries a mesh without any.
    const std::vector<Overrun> overrun = run_rounds(
        scene, settings, end, start, start.eol.empty() ? attempt : Attempt::Ordinary, work, report);
    watch.lap();

    // Record why the attempt failed, for the next one.
    work.retry.note(report, attempt, state, start,
                    {overrun, find_overconstrained_vertices(start, work, report), has_turned(work, start)});

    // 7. The proposal becomes the state. A failed step leaves the state as it was.
    commit(scene, planned, end, work, start, report);
    if (report.status == StepStatus::Done && &start != &state) std::swap(state, start);
    report.seconds.advance += watch.lap();
    return report;
}

}  // namespace

State make_state(const Scene& scene, ClothMesh mesh, const Vec3& velocity)
{
    const std::size_t n = mesh.world.size();
    return make_state(scene, std::move(mesh), std::vector<Vec3>(n, velocity));
}

State make_state(const Scene& scene, ClothMesh mesh, std::vector<Vec3> velocity)
{
    State state;
    state.mesh = std::move(mesh);
    const int n = state.mesh.vertex_count();
    state.ids.resize(n);
    std::iota(state.ids.begin(), state.ids.end(), 0u);
    state.seam_ids.resize(state.mesh.seam_vertices.size());
    std::iota(state.seam_ids.begin(), state.seam_ids.end(), static_cast<std::uint32_t>(n));
    state.next_id = static_cast<std::uint32_t>(state.mesh.material.size());
    state.velocity = std::move(velocity);
    state.previous_world.assign(n, Vec3::Zero());
    state.previous_velocity.assign(n, Vec3::Zero());
    state.previous_material = state.mesh.material;
    for (std::vector<Vec2>* flow : {&state.material_velocity, &state.previous_material_velocity})
        flow->assign(state.mesh.material.size(), Vec2::Zero());
    attach_pins(scene, state);
    start_sizing_field(scene, state);
    return state;
}

void prepare(const Scene& scene, const State& state, Workspace& work)
{
    if (update_mesh_cache(scene, state, work.mesh)) work.energies.known_at.world.clear();
}

void restart(State& state)
{
    state.previous_dt = 0.0;
}

StepReport make_part(const Scene& scene, const Settings& settings, const PlannedStep& planned, double end,
                     State& state, Workspace& work, Attempt attempt)
{
    // At time 0 no earlier part has found which features press. A trial finds them; its state is discarded.
    const bool is_first = state.step == 0 && planned.begins_at(state.time);
    if (scene.eol && is_first && state.active.empty()) {
        State trial = state;
        make_stages(scene, settings, planned, end, trial, work, attempt);
        state.active = std::move(trial.active);
    }
    return make_stages(scene, settings, planned, end, state, work, attempt);
}

StepReport step(const Scene& scene, const Settings& settings, double end, State& state, Workspace& work,
                Attempt attempt)
{
    return make_part(scene, settings, {state.time, end}, end, state, work, attempt);
}

}  // namespace arris
