// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/step.h"

#include <algorithm>
#include <cassert>
#include <optional>

#include "solver/commit.h"
#include "solver/contact/constraints.h"
#include "solver/contact/eol_contacts.h"
#include "solver/energy_balance.h"
#include "solver/eol/eol_coordinates.h"
#include "solver/eol/eol_features.h"
#include "solver/material_flow.h"
#include "solver/mesh_change/step_mesh.h"
#include "solver/model/eol_limits.h"
#include "solver/model/stopwatch.h"
#include "solver/overconstrained.h"
#include "solver/relinearization.h"

namespace arris {

namespace {

constexpr int kMostSolves = 12;  // of one step

/// Where the integrator starts from, and where pins and obstacles will be.
void move(const Scene& scene, const Settings& settings, double end, const State& state, Workspace& work)
{
    work.prediction = predict(state, settings.integrator, end - state.time);
    work.expansion = {state.velocity, state.material_velocity};
    if (!work.prediction.has_history) {
        work.expansion.world.assign(state.velocity.size(), Vec3::Zero());
        work.expansion.material.assign(state.velocity.size(), Vec2::Zero());
    }
    work.least = {};
    work.pin_targets = find_pin_targets(scene, state, end);
    work.obstacles =
        move_obstacles(scene, state, work.mesh.stars.topology.edges, work.prediction, work.pin_targets, end);
}

/// What the cloth may touch; history that runs into it is flattened. False where it would be crushed.
bool find_contacts(const Scene& scene, const State& state, Workspace& work, StepReport& report)
{
    work.contacts = find_contacts(scene, state, work.prediction, work.obstacles);
    work.eol.clear();
    if (!state.eol.empty()) {
        const double turning = work.retry.may_turn() ? work.prediction.gamma : 0.0;
        work.eol = add_eol_contacts(scene, state, work.mesh.stars, work.prediction, turning, work.obstacles,
                                    work.contacts);
    }
    measure_start_energy(scene, state, work);
    const std::optional<int> overconstrained =
        share_room(work.obstacles, work.prediction, work.contacts).overconstrained;
    flatten_history(scene, state, work.obstacles, work.eol, 0, work.contacts, work.prediction);
    work.has_system = false;
    work.yielded = 0;
    if (!overconstrained) return true;
    report.status = StepStatus::Infeasible;
    report.infeasible_vertex = state.ids[*overconstrained];
    return false;
}

/// Each vertex's coordinates, in which pins are known and contacts are bounds or rows; A, b in them.
/// False where material would have flowed further than the mesh allows.
bool assemble(const Scene& scene, double end, const State& state, Workspace& work)
{
    if (work.has_system) return true;
    build_constraints(work.pin_targets, work.eol, work.prediction, state, work.contacts, work.linearization,
                      work.problem);
    Linearization& at = work.linearization;
    const Prediction& prediction = work.prediction;
    at.begin = state.time;
    at.time = end;
    at.gamma = prediction.gamma;
    at.damping = scene.material.damping;
    at.v_predicted = prediction.velocity;
    at.v_last = state.velocity;
    if (at.flow && !linearise_flow(state, work)) return false;
    at.v_expansion = work.expansion.world;
    at.position = find_end(prediction, work.expansion).world;
    work.mesh.system.assemble(state.mesh, work.mesh.elements, work.mesh.terms, at);
    return true;
}

/// Minimises 1/2 u^T A u - b^T u over bounds and rows.
void solve_velocity(const Settings& settings, Workspace& work, StepReport& report)
{
    work.problem.matrix = &work.mesh.system.matrix();
    work.problem.rhs = &work.mesh.system.rhs();
    work.solution = work.has_system ? work.solver.resume(work.problem, settings)
                                    : work.solver.solve(work.problem, settings);
    work.has_system = true;
    ++report.solves;
    report.factorisations += work.solution.factorisations;
    report.nlopt_evaluations += work.solution.nlopt_evaluations;
    report.kkt_residual = work.solution.kkt_residual;  // of the solve whose velocity is taken
    report.seconds.factorise += work.solution.factorise_seconds;
    report.seconds.solve += work.solution.solve_seconds;
    switch (work.solution.status) {
        case SolveStatus::Certified:
            report.status = StepStatus::Done;
            break;
        case SolveStatus::NotConverged:
            report.status = StepStatus::NotConverged;
            break;
        case SolveStatus::NotFinite:
            report.status = StepStatus::NotFinite;
            break;
        case SolveStatus::Infeasible:
            report.status = StepStatus::Infeasible;
            break;
    }
}

/// q' = q~ + gamma v'. Where the cloth is nearer to an obstacle than its stand-off, it is moved out by up
/// to `growth` (m).
void propose(const Scene& scene, double growth, Workspace& work)
{
    const std::size_t n = work.prediction.position.size();
    work.proposal.world.resize(n);
    work.proposal.velocity.resize(n);
    for (std::size_t v = 0; v < n; ++v) {
        Vec3& velocity = work.proposal.velocity[v];
        velocity = work.linearization.drift[v] +
                   work.linearization.basis[v] * work.solution.velocity.segment<3>(3 * v);
        work.proposal.world[v] = work.prediction.position[v] + work.prediction.gamma * velocity;
    }
    restore_stand_off(work.contacts, work.obstacles, work.pin_targets, scene.material.thickness, growth,
                      work.proposal);
}

/// A contact that nothing could meet: the vertex to name, one that a pin holds where there is one.
std::int64_t find_infeasible_vertex(const State& state, const Workspace& work)
{
    const auto is_held = [&](int v) {
        return std::any_of(work.pin_targets.begin(), work.pin_targets.end(),
                           [v](const PinTarget& held) { return held.vertex == v; });
    };
    std::int64_t named = -1;
    for (const int row : work.solution.infeasible_rows)
        for (const Contact& contact : work.contacts)
            for (const int v : contact.in_frame.vertices) {
                if (contact.row != row || v < 0) continue;
                if (is_held(v)) return state.ids[v];
                if (named < 0) named = state.ids[v];
            }
    return named;
}

/// Contacts that cannot be met together keep less, in a new system; false where none can. The impulses of
/// a solution that meets them as well as it can are no contact forces: it is not used.
bool yield_infeasible(const Scene& scene, Workspace& work)
{
    bool is_changed = false;
    for (Contact& contact : work.contacts) {
        const std::vector<int>& rows = work.solution.infeasible_rows;
        if (contact.row < 0 || std::find(rows.begin(), rows.end(), contact.row) == rows.end()) continue;
        if (!yield_stand_off(work.obstacles, work.prediction, scene.material.thickness, contact)) continue;
        ++work.yielded;
        is_changed = true;
    }
    work.has_system = work.has_system && !is_changed;
    return is_changed;
}

/// Planes behind folds that press cloth against an obstacle keep nothing, in a new system; false where none
/// do.
bool yield_folds(const Scene& scene, Workspace& work)
{
    bool is_changed = false;
    for (const int fold : find_overconstraining_folds(work))
        is_changed |=
            yield_stand_off(work.obstacles, work.prediction, scene.material.thickness, work.contacts[fold]);
    work.has_system = work.has_system && !is_changed;
    return is_changed;
}

/// Whether an EOL vertex goes round its wire or tip.
bool has_turned(const Workspace& work, const State& state)
{
    return std::any_of(work.eol.begin(), work.eol.end(), [&](const EolCoordinates& eol) {
        const ObstacleStep& step = work.obstacles[state.eol[eol.entry].on.obstacle];
        return eol.carried != step.end(step.motion.begin[eol.vertex]);
    });
}

/// Rounds have run out, or the check names nothing that a row could mend.
void fail_or_rewind(const Scene& scene, double end, const State& state, Attempt attempt, Workspace& work,
                    StepReport& report)
{
    if (report.status == StepStatus::Infeasible)
        report.infeasible_vertex = find_infeasible_vertex(state, work);
    else
        report.status = StepStatus::Penetration;
    if (attempt == Attempt::Ordinary) return;
    const std::optional<int> rewound = rewind(scene, state, work.pin_targets, work.prediction,
                                              end - state.time, work.obstacles, work.proposal);
    if (!rewound) return;
    report.rewound = *rewound;
    report.status = StepStatus::Done;
}

/// The proposal of a certified velocity, checked. Where only moving cloth out to its stand-off would pass
/// something, or strains stiff cloth, it is not moved.
Violations propose_and_check(const Scene& scene, double dt, double growth, Workspace& work)
{
    const auto propose_measured = [&](double by) {
        propose(scene, by, work);
        measure_proposal_energy(scene, dt, work);
    };
    propose_measured(growth);
    if (growth > 0.0 && does_push_out_strain(scene, dt, work)) propose_measured(growth = 0.0);
    const Violations violations = check_proposal(scene, work.proposal, work.prediction, work.obstacles);
    if (violations.is_clean() || growth <= 0.0) return violations;
    propose_measured(0.0);
    return check_proposal(scene, work.proposal, work.prediction, work.obstacles);
}

/// What the check has found becomes rows of the same system, or of a new one where history ran into it.
/// False where it names nothing that a row could mend.
bool add_violations(const Scene& scene, const State& state, const Violations& violations, Workspace& work)
{
    if (violations.contacts.empty()) return false;
    const std::size_t first = work.contacts.size();
    work.contacts.insert(work.contacts.end(), violations.contacts.begin(), violations.contacts.end());
    const bool is_shared = share_room(work.obstacles, work.prediction, work.contacts).is_changed;
    if (flatten_history(scene, state, work.obstacles, work.eol, first, work.contacts, work.prediction) ||
        is_shared)
        work.has_system = false;
    else
        append_rows(work.prediction, work.linearization, first, work.contacts, work.problem);
    return true;
}

/// Steps 4 to 6 once; true where the velocity is to be solved again.
bool solve_and_check(const Scene& scene, const Settings& settings, double end, const State& state,
                     Attempt attempt, Workspace& work, StepReport& report)
{
    Stopwatch watch;

    // 4. A and b in the vertices' coordinates, in which contacts are bounds and rows.
    if (!assemble(scene, end, state, work)) {
        report.status = StepStatus::Overrun;
        return false;
    }
    report.seconds.assemble += watch.lap();

    // 5. The constrained velocity, with its certificate. What cannot be met together yields, and folds to
    // what is there.
    solve_velocity(settings, work, report);
    watch.lap();
    if (report.status == StepStatus::Infeasible && report.solves < kMostSolves &&
        yield_infeasible(scene, work))
        return true;
    if (report.status == StepStatus::Done && report.solves < kMostSolves && yield_folds(scene, work))
        return true;
    if (report.status != StepStatus::Done && report.status != StepStatus::Infeasible) return false;

    // 6. q' = q~ + gamma v', not committed, and the exact check of the whole way.
    if (!propose_flow(work)) {
        const bool may_solve_again = report.status == StepStatus::Done && report.solves < kMostSolves;
        report.status = StepStatus::Overrun;
        if (!may_solve_again) return false;
        propose(scene, 0.0, work);
        return linearise_nearer(work, report);
    }
    const double growth = report.solves == 1 ? kMendingSpeed * (end - state.time) : 0.0;
    const Violations violations = propose_and_check(scene, end - state.time, growth, work);
    const bool is_done = report.status == StepStatus::Done && violations.is_clean();
    if (is_done && !find_overpressed_vertices(work).empty()) {
        report.status = StepStatus::Infeasible;
        report.seconds.check += watch.lap();
        return false;
    }
    if (is_done && enforce_energy_balance(scene, state, attempt, report.solves < kMostSolves, work, report))
        return true;
    const bool is_again = !is_done && report.status == StepStatus::Done && report.solves < kMostSolves &&
                          add_violations(scene, state, violations, work);
    const bool is_certified = report.kkt_residual <= settings.tolerance;
    if (!is_done && !is_again)
        fail_or_rewind(scene, end, state, is_certified ? attempt : Attempt::Ordinary, work, report);
    report.crossings = is_again || report.rewound > 0 ? 0 : violations.crossings;
    report.yielded = work.yielded;
    report.seconds.check += watch.lap();
    return is_again;
}

/// One step, from the contacts in `state.active` on.
StepReport make_step(const Scene& scene, const Settings& settings, double end, State& state, Workspace& work,
                     Attempt attempt)
{
    StepReport report;
    report.dt = end - state.time;
    Stopwatch watch;

    // 1. EOL vertices on the features that press; elements of a mesh that changed.
    const StepMesh mesh = choose_step_mesh(scene, end, work.retry.flow(), state, work.mesh, report);
    if (mesh.is_changed) work.energies.known_at.world.clear();
    State& start = mesh.start;
    watch.lap();

    // 2. q~ and v~ of the integrator; where pins and obstacles will be.
    move(scene, settings, end, start, work);
    report.seconds.move += watch.lap();

    // 3. What the cloth may touch: vertices, edges and faces; nothing can move where it has no room.
    if (!find_contacts(scene, start, work, report)) {
        work.retry.note(report, attempt, state, start, {});
        return report;
    }
    report.seconds.contacts += watch.lap();

    // 4 - 6. Solve, propose, check: what the check finds becomes rows, in bounded rounds. Where there are EOL
    // vertices, to do without them comes before the last resorts.
    const Attempt resort = start.eol.empty() ? attempt : Attempt::Ordinary;
    do {
        while (solve_and_check(scene, settings, end, start, resort, work, report)) continue;
    } while (report.status != StepStatus::Done && restore_least_rise(work, report));
    watch.lap();

    work.retry.note(
        report, attempt, state, start,
        {work.overrun, find_overconstrained_vertices(start, work, report), has_turned(work, start)});

    // 7. Swapped in, or the state stays as it was.
    commit(scene, end, work, start, report);
    if (report.status == StepStatus::Done && &start != &state) std::swap(state, start);
    report.seconds.advance += watch.lap();
    return report;
}

}  // namespace

State make_state(const Scene& scene, ClothMesh mesh, const Vec3& velocity)
{
    State state;
    state.mesh = std::move(mesh);
    const int n = state.mesh.vertex_count();
    state.ids.resize(n);
    for (int v = 0; v < n; ++v) state.ids[v] = static_cast<std::uint32_t>(v);
    state.next_id = static_cast<std::uint32_t>(n);
    state.velocity.assign(n, velocity);
    state.previous_world.assign(n, Vec3::Zero());
    state.previous_velocity.assign(n, Vec3::Zero());
    state.material_velocity.assign(n, Vec2::Zero());
    state.previous_material = state.mesh.material;
    state.previous_material_velocity.assign(n, Vec2::Zero());
    attach_pins(scene, state);
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

StepReport step(const Scene& scene, const Settings& settings, double end, State& state, Workspace& work,
                Attempt attempt)
{
    // At the start no last step tells which features press: a trial step does, which is not kept.
    if (scene.eol && state.step == 0 && state.active.empty()) {
        State trial = state;
        make_step(scene, settings, end, trial, work, attempt);
        state.active = std::move(trial.active);
    }
    return make_step(scene, settings, end, state, work, attempt);
}

}  // namespace arris
