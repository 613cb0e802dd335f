// SPDX-License-Identifier: GPL-3.0-or-later
// One time step, from `state.time` to `end`. `make_step` makes it in seven stages:
//
//   stage                 result                                       code, in src/solver
//   1. choose_step_mesh   mesh with EOL vertices on pressing features  mesh_change/step_mesh
//   2. move               predicted cloth, pins and obstacles at end   model/time_integration
//   3. find_contacts      contacts that the cloth may meet             step_contacts, contact/contacts
//   4. assemble           A, b; contacts as bounds or rows             contact/constraints, material_flow
//   5. solve_velocity     velocity, with its certificate               velocity_solve/velocity_solve
//   6. propose_and_check  new positions, whole path checked            contact/proposal, energy_balance
//   7. commit             the proposal becomes the new state           commit
//
// Stages 4 to 6 (`solve_and_check`) repeat until the proposal is clean: violations become rows, and forces
// may be linearised again (relinearization.h). Only stage 7 changes the state. `advance` (advance.h) calls
// `step` and decides, with RetryPolicy, what follows a failed step. docs/method.md derives the equations and
// explains their symbols; docs/glossary.md lists the words.
#include "solver/step.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "solver/buckling_seed.h"
#include "solver/commit.h"
#include "solver/contact/constraints.h"
#include "solver/energy_balance.h"
#include "solver/eol/eol_coordinates.h"
#include "solver/eol/eol_features.h"
#include "solver/friction.h"
#include "solver/infeasible.h"
#include "solver/material_flow.h"
#include "solver/mesh_change/step_mesh.h"
#include "solver/model/eol_limits.h"
#include "solver/model/stopwatch.h"
#include "solver/not_finite.h"
#include "solver/overconstrained.h"
#include "solver/relinearization.h"
#include "solver/remesh/cell_lengths.h"
#include "solver/step_contacts.h"
#include "solver/yielding.h"

namespace arris {

namespace {

/// Velocity solves of one step. Returning to the linearization with the least energy rise may add one more.
constexpr int kMostSolves = 12;

/// Work of one attempt at a step in all its velocity solves, in factorisations' worth. Beyond it the attempt
/// fails, and the next one is shorter. The last one may do more, as the run ends where it fails.
constexpr double kMostWork = 60.0, kMostWorkOfLast = 600.0;

/// Passes over the contacts that push layers of cloth out to their stand-off.
constexpr int kPushes = 5;

/// Stage 2: predicts the cloth from its history (q~, v~), and places pins and obstacles at `end`. Forces are
/// first linearised at the velocity of the last step, or at q~ where BDF2 is without history.
void move(const Scene& scene, const Settings& settings, double end, const State& state, Workspace& work)
{
    work.prediction = predict(state, settings.integrator, end - state.time);
    work.expansion = {state.velocity, state.material_velocity};
    if (!work.prediction.has_history && settings.integrator == Integrator::Bdf2) {
        work.expansion.world.assign(state.velocity.size(), Vec3::Zero());
        work.expansion.material.assign(state.velocity.size(), Vec2::Zero());
    }
    work.least = {};
    work.pin_targets = find_pin_targets(scene, state, end);
    work.obstacles =
        move_obstacles(scene, state, work.mesh.stars.topology.edges, work.prediction, work.pin_targets, end);
}

/// Stage 4: gives each vertex coordinates in which pins are known and contacts are bounds or rows. Assembles
/// A and b in these coordinates. Does nothing where only rows were added since the last solve. False where a
/// step would take more material from a face than the mesh allows.
bool assemble(const Scene& scene, double end, const State& state, Workspace& work)
{
    if (work.has_system) return true;
    build_constraints(work.pin_targets, work.eol, work.prediction, state, work.contacts, work.linearization,
                      work.problem);
    append_self_rows(state, work.prediction, work.linearization, 0, work.self_rows, work.problem);
    make_room_for_self_rows(work);
    work.rubs = add_friction_pairs(rubbing_cloth(scene, state, work), work.problem);
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

/// Stage 5: minimises 1/2 u^T A u - b^T u under bounds and rows. Where only rows were added, the solve
/// resumes on the existing factorisation. Friction's budgets move within the solve until they agree.
void solve_velocity(const Scene& scene, const Settings& settings, const State& state, Attempt attempt,
                    Workspace& work, StepReport& report)
{
    work.problem.matrix = &work.mesh.system.matrix();
    work.problem.rhs = &work.mesh.system.rhs();
    work.problem.most_work = (attempt == Attempt::Last ? kMostWorkOfLast : kMostWork) - report.solve_work;
    work.problem.is_repeat = report.solves > 0;
    if (!work.problem.friction.empty()) set_friction_law(scene, state, work);
    work.solution = work.has_system ? work.solver.resume(work.problem, settings)
                                    : work.solver.solve(work.problem, settings);
    work.has_system = true;
    report.solve_work += work.solution.work;
    report.factorisations += work.solution.factorisations;
    report.nlopt_evaluations += work.solution.nlopt_evaluations;
    report.seconds.factorise += work.solution.factorise_seconds;
    report.seconds.solve += work.solution.solve_seconds;
    if (!work.problem.friction.empty()) note_friction(state, work, report);
    ++report.solves;
    report.kkt_residual = work.solution.kkt_residual;  // of the last solve, whose velocity is used
    switch (work.solution.status) {
        case SolveStatus::Certified: {
            const bool is_by_law = report.friction_residual <= kOffLaw || attempt == Attempt::Last;
            report.status = is_by_law ? StepStatus::Done : StepStatus::NotConverged;
            break;
        }
        case SolveStatus::NotConverged:
            report.status = StepStatus::NotConverged;
            break;
        case SolveStatus::NotFinite:
            note_not_finite(CheckedStage::Solve, state, work, report);
            break;
        case SolveStatus::Infeasible:
            report.status = StepStatus::Infeasible;
            break;
    }
}

/// Stage 6, first half: q' = q~ + gamma v'. Cloth nearer to an obstacle than its stand-off moves out by up to
/// `growth` (m), in position only.
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
    // A layer that is pushed away from another one may have to come back from an obstacle.
    const int passes = work.self_rows.empty() ? 0 : kPushes;
    for (int pass = 0; pass < passes; ++pass) {
        restore_self_stand_off(work.self_rows, work.mobility, scene.self_contact->thickness, growth,
                               work.proposal.world);
        restore_stand_off(work.contacts, work.obstacles, scene.material.thickness, growth, work.proposal);
    }
    if (passes == 0)
        restore_stand_off(work.contacts, work.obstacles, scene.material.thickness, growth, work.proposal);
    hold_in_place(work.pin_targets, work.proposal.world);
}

/// Whether an EOL vertex has gone round its wire or tip with the cloth.
bool has_turned(const Workspace& work, const State& state)
{
    return std::any_of(work.eol.begin(), work.eol.end(), [&](const EolCoordinates& eol) {
        const ObstacleStep& step = work.obstacles[state.eol[eol.entry].on.obstacle];
        return eol.carried != step.end(step.motion.begin[eol.vertex]);
    });
}

/// Ends a step without a clean proposal: solves have run out, or no row could remove the violations. The step
/// fails. Only the last attempt moves cloth back on its path instead (`rewind`).
void fail_or_rewind(const Scene& scene, double end, const State& state, Attempt attempt, Workspace& work,
                    StepReport& report)
{
    if (report.status == StepStatus::Infeasible)
        report.infeasible = name_infeasible(state, work);
    else
        report.status = StepStatus::Penetration;
    if (attempt == Attempt::Ordinary) return;
    const std::optional<int> rewound =
        rewind(scene, state, work.mesh.self_surface, work.pin_targets, work.prediction, end - state.time,
               work.obstacles, work.proposal);
    if (!rewound) return;
    report.rewound = *rewound;
    report.status = StepStatus::Done;
}

/// Stage 6: makes the proposal and checks its whole path. Cloth is not pushed out to its stand-off where the
/// push would strain stiff cloth, or where the pushed proposal is not clean. Null where a number of the
/// proposal is not finite.
std::optional<Violations> propose_and_check(const Scene& scene, double dt, double growth, const State& state,
                                            Workspace& work, StepReport& report)
{
    const auto propose_measured = [&](double by) {
        propose(scene, by, work);
        measure_proposal_energy(scene, dt, work);
    };
    propose_measured(growth);
    if (note_not_finite(CheckedStage::Proposal, state, work, report)) return std::nullopt;
    if (growth > 0.0 && does_push_out_strain(scene, dt, work)) propose_measured(growth = 0.0);
    const auto check = [&] {
        return check_proposal(scene, state, work.mesh.self_surface, work.proposal, work.prediction,
                              work.obstacles);
    };
    const Violations violations = check();
    if (violations.is_clean() || growth <= 0.0) return violations;
    propose_measured(0.0);
    return check();
}

/// Stages 4 to 6 once. True where the velocity is to be solved again.
bool solve_and_check(const Scene& scene, const Settings& settings, double end, const State& state,
                     Attempt attempt, Workspace& work, StepReport& report)
{
    settings.stop_if_interrupted();
    Stopwatch watch;

    // 4. A and b in coordinates of the vertices, in which contacts are bounds or rows.
    if (!assemble(scene, end, state, work)) {
        report.status = StepStatus::Overrun;
        return false;
    }
    report.seconds.assemble += watch.lap();

    // 5. The constrained velocity, with its certificate. Contacts that cannot be met together yield, and fold
    // planes yield to other obstacles.
    solve_velocity(scene, settings, state, attempt, work, report);
    watch.lap();
    if (report.status == StepStatus::Infeasible && report.solves < kMostSolves &&
        yield_infeasible(scene, state, work))
        return true;
    if (report.status == StepStatus::Done && report.solves < kMostSolves && yield_folds(scene, work))
        return true;
    if (report.status != StepStatus::Done && report.status != StepStatus::Infeasible) return false;

    // 6. The proposal q' = q~ + gamma v'. Where too much material would flow, forces are linearised nearer.
    if (!propose_flow(work)) {
        const bool may_solve_again = report.status == StepStatus::Done && report.solves < kMostSolves;
        report.status = StepStatus::Overrun;
        if (!may_solve_again) return false;
        propose(scene, 0.0, work);
        return linearise_nearer(work, report);
    }
    // The exact check of the whole path. Only the first solve pushes cloth out to its stand-off.
    const double growth = report.solves == 1 ? kMendingSpeed * (end - state.time) : 0.0;
    const std::optional<Violations> found =
        propose_and_check(scene, end - state.time, growth, state, work, report);
    if (!found) return false;
    const Violations& violations = *found;
    // A clean proposal may still be refused: EOL vertices pressed from both sides, or too much energy.
    const bool is_done = report.status == StepStatus::Done && violations.is_clean();
    if (is_done && !find_overconstrained_by_work(work).empty()) {
        report.status = StepStatus::Infeasible;
        report.seconds.check += watch.lap();
        return false;
    }
    if (is_done && enforce_energy_balance(scene, state, attempt, report.solves < kMostSolves, work, report))
        return true;
    // Violations become rows of the next solve. Otherwise the step fails, or is rewound if its velocity is
    // certified.
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

/// One step in seven stages. `state.active`, the contacts that pressed at the end of the last step, tells
/// which features press and is the first guess of the active set.
StepReport make_step(const Scene& scene, const Settings& settings, double end, State& state, Workspace& work,
                     Attempt attempt)
{
    StepReport report;
    report.dt = end - state.time;
    Stopwatch watch;
    if (note_not_finite(CheckedStage::Start, state, work, report)) {
        work.retry.note(report, attempt, state, state, {});
        return report;
    }

    // 1. The mesh, with EOL vertices on the features that press; new elements where the mesh has changed.
    const StepMesh mesh = choose_step_mesh(scene, end, work.retry.flow(), state, work.mesh, report);
    if (mesh.is_changed) work.energies.known_at.world.clear();
    State& start = mesh.start;
    watch.lap();

    // 2. The integrator's q~ and v~; pins and obstacles at `end`.
    move(scene, settings, end, start, work);
    report.seconds.move += watch.lap();

    // 3. Contacts of vertices, edges and faces. A vertex without room fails the step.
    const bool has_room = collect_contacts(scene, start, work, report);
    if (!scene.obstacles.empty()) report.seconds.contacts += watch.lap();
    if (!has_room) {
        work.retry.note(report, attempt, state, start, {});
        return report;
    }
    // Cloth that is compressed exactly in a plane has no force across it, and could never fold by itself.
    seed_buckling(scene, start, work.mesh, work.contacts, work.prediction);
    measure_start_energy(scene, start, work);
    report.seconds.move += watch.lap();

    // 4 - 6. Solve, propose and check, in bounded rounds: violations become rows. A mesh with EOL vertices
    // takes no last resorts, as RetryPolicy first tries a mesh without any. A step that fails after its
    // forces were linearised again may return to an earlier linearization that raised no energy.
    const Attempt resort = start.eol.empty() ? attempt : Attempt::Ordinary;
    do {
        while (solve_and_check(scene, settings, end, start, resort, work, report)) continue;
    } while (report.status != StepStatus::Done && restore_least_rise(work, report));
    watch.lap();

    // Record why the attempt failed, for the next one.
    work.retry.note(
        report, attempt, state, start,
        {work.overrun, find_overconstrained_vertices(start, work, report), has_turned(work, start)});

    // 7. The proposal becomes the state. A failed step leaves the state as it was.
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
    start_cell_lengths(scene, state);
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
    // At time 0 no earlier step has found which features press. A trial step finds them; its state is
    // discarded.
    if (scene.eol && state.step == 0 && state.active.empty()) {
        State trial = state;
        make_step(scene, settings, end, trial, work, attempt);
        state.active = std::move(trial.active);
    }
    return make_step(scene, settings, end, state, work, attempt);
}

}  // namespace arris
