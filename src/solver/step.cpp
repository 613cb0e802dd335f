// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/step.h"

#include <cassert>
#include <cmath>

#include "solver/constraints.h"
#include "solver/stopwatch.h"

namespace arris {

namespace {

/// Where pins will be at the step's end, and where the integrator starts from.
void move_pins(const Scene& scene, const Settings& settings, double end, const State& state, Workspace& work)
{
    work.prediction = predict(state, settings.integrator, end - state.time);
    work.held = find_held_vertices(scene, state, end);
}

/// A, b in the vertices' coordinates.
void assemble(const Scene& scene, double end, const State& state, Workspace& work)
{
    Linearization& at = work.at;
    const Prediction& prediction = work.prediction;
    at.begin = state.time;
    at.time = end;
    at.gamma = prediction.gamma;
    at.damping = scene.material.damping;
    at.v_predicted = prediction.velocity;
    at.v_last = state.velocity;
    at.v_expansion.assign(state.velocity.size(), Vec3::Zero());
    at.position = prediction.position;
    if (prediction.has_history) {
        at.v_expansion = state.velocity;
        for (std::size_t v = 0; v < at.position.size(); ++v) at.position[v] += at.gamma * state.velocity[v];
    }
    work.system.assemble(state.mesh, work.elements, work.terms, at);
}

/// Minimises 1/2 u^T A u - b^T u over the bounds.
void solve_velocity(const Settings& settings, Workspace& work, StepReport& report)
{
    work.problem.matrix = &work.system.matrix();
    work.problem.rhs = &work.system.rhs();
    work.solution = work.solver.solve(work.problem, settings);
    report.factorisations += work.solution.factorisations;
    report.nlopt_evaluations += work.solution.nlopt_evaluations;
    report.kkt_residual = work.solution.kkt_residual;
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
    }
}

/// q' = q~ + gamma v'; what round-off left beyond a stand-off is put back, velocity untouched.
void propose(Workspace& work)
{
    const std::size_t n = work.prediction.position.size();
    work.next_world.resize(n);
    work.next_velocity.resize(n);
    for (std::size_t v = 0; v < n; ++v) {
        work.next_velocity[v] =
            work.at.drift[v] + work.at.basis[v] * work.solution.velocity.segment<3>(3 * v);
        work.next_world[v] = work.prediction.position[v] + work.prediction.gamma * work.next_velocity[v];
    }
    for (const Contact& contact : work.contacts) {
        const double gap =
            contact.gap + work.prediction.gamma * contact.normal.dot(work.next_velocity[contact.vertex]);
        if (gap < 0.0) work.next_world[contact.vertex] -= gap * contact.normal;
    }
    for (const HeldVertex& vertex : work.held)
        for (int d = 0; d < 3; ++d)
            if (vertex.held[d]) work.next_world[vertex.vertex][d] = vertex.target[d];
}

std::vector<ActiveBound> active_bounds(const State& state, const Workspace& work)
{
    std::vector<ActiveBound> active;
    for (const Contact& contact : work.contacts) {
        const int coordinate = contact_coordinate(work.problem.is_fixed, contact.vertex);
        if (coordinate < 0) continue;
        const double multiplier = work.solution.multipliers[coordinate];
        if (multiplier > 0.0) active.push_back({state.ids[contact.vertex], multiplier});
    }
    return active;
}

/// What pins hold goes where they have it at time 0, and moves as they do.
void take_hold(const Scene& scene, State& state)
{
    const std::vector<Vec3> placed = state.mesh.world;
    for (std::uint32_t p = 0; p < scene.pins.size(); ++p) {
        const Pin& pin = scene.pins[p];
        if (!(pin.release > 0.0)) continue;
        const Placement place = pin.motion.at(0.0);
        for (const int v : vertices_in_box(state.mesh, pin.material)) {
            state.anchors.push_back({p, state.ids[v], placed[v]});
            const Vec3 target = place(placed[v]);
            const Vec3 moving = pin.motion.velocity_after(0.0, target);
            for (int d = 0; d < 3; ++d) {
                if (!pin.held[d]) continue;
                state.mesh.world[v][d] = target[d];
                state.velocity[v][d] = moving[d];
            }
        }
    }
}

/// Swaps the new state in, or leaves the old one where the solve failed.
void commit(double end, Workspace& work, State& state, StepReport& report)
{
    if (report.status != StepStatus::Done) return;
    state.active = active_bounds(state, work);
    report.contacts = static_cast<int>(state.active.size());
    state.previous_world.swap(state.mesh.world);
    state.previous_velocity.swap(state.velocity);
    state.mesh.world.swap(work.next_world);
    state.velocity.swap(work.next_velocity);
    state.previous_dt = end - state.time;
    state.time = end;
    ++state.step;
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
    take_hold(scene, state);
    return state;
}

void restart(State& state)
{
    state.previous_dt = 0.0;
}

void prepare(const Scene& scene, const State& state, Workspace& work)
{
    if (work.terms.faces.empty())
        work.terms = make_terms(scene.material, scene.gravity, scene.wind, scene.pulls);
    if (work.faces_of_elements == state.mesh.faces && work.material_of_elements == state.mesh.material)
        return;
    work.elements = make_elements(state.mesh, make_topology(state.mesh.vertex_count(), state.mesh.faces));
    work.system.make_pattern(work.elements);
    work.faces_of_elements = state.mesh.faces;
    work.material_of_elements = state.mesh.material;
}

StepReport step(const Scene& scene, const Settings& settings, double end, State& state, Workspace& work)
{
    StepReport report;
    report.dt = end - state.time;
    Stopwatch watch;

    // 1. Elements of a mesh that changed; where pins will be; q~ and v~ of the integrator.
    prepare(scene, state, work);
    move_pins(scene, settings, end, state, work);
    report.seconds.move += watch.lap();

    // 2. What the cloth may touch; history that ran into it is flattened.
    work.contacts = find_contacts(scene, state, work.prediction);
    report.seconds.contacts += watch.lap();

    // 3. Each vertex's coordinates, in which pins are known and contacts are bounds; A and b in them.
    build_constraints(work.held, work.contacts, work.prediction, state, work.at, work.problem);
    assemble(scene, end, state, work);
    if (const auto crushed =
            find_crushed_vertex(work.contacts, scene.material.thickness, work.at, work.problem)) {
        report.status = StepStatus::Infeasible;
        report.infeasible_vertex = state.ids[*crushed];
        return report;
    }
    report.seconds.assemble += watch.lap();

    // 4. The constrained velocity, with its certificate.
    solve_velocity(settings, work, report);
    watch.lap();

    // 5. q' = q~ + gamma v'; swapped in, or the state stays as it was.
    propose(work);
    commit(end, work, state, report);
    report.seconds.advance += watch.lap();
    return report;
}

}  // namespace arris
